// FMI 3.0, Co-Simulation and Model Exchange: the functions of the standard on fmi_instance.hpp.
#include "embed/fmi3_types.h"

#include <cmath>
#include <limits>

#include "embed/fmi_instance.hpp"

namespace {

using bough::fmi::Instance;
using bough::fmi::InstanceOptions;
using bough::fmi::SavedState;
using bough::fmi::Status;
constexpr unsigned kAllPhases = bough::fmi::kAnyPhase;

/// Instance of FMI 3: a bough::fmi::Instance and what only that version has.
struct Instance3 : Instance {
  explicit Instance3(InstanceOptions given) : Instance(std::move(given)) {}
  bool may_return_early = false;
};

template <class Action>
fmi3Status run3(fmi3Instance instance, unsigned allowed, const char* function, const Action& action) noexcept {
  return static_cast<fmi3Status>(
      bough::fmi::call(instance, allowed, function, [&](Instance& i) { return action(static_cast<Instance3&>(i)); }));
}

fmi3Status reject3(fmi3Instance instance, const char* function, const char* why) noexcept {
  return run3(instance, kAllPhases, function, [&](Instance3& i) { return i.fail(std::string(function) + ": " + why); });
}

/// Variables of other types than Float64 do not exist.
fmi3Status reject_type3(fmi3Instance instance, const char* function, std::size_t n) noexcept {
  return run3(instance, kAllPhases, function, [&](Instance3& i) {
    return n == 0 ? Status::Ok : i.fail(std::string(function) + ": the FMU has variables of type Float64 only");
  });
}

fmi3Status reject_clock(fmi3Instance instance, const char* function, std::size_t n) noexcept {
  return run3(instance, kAllPhases, function, [&](Instance3& i) {
    return n == 0 ? Status::Ok : i.fail(std::string(function) + ": the FMU has no clocks");
  });
}

SavedState* find_saved(fmi3FMUState state) {
  return state && bough::fmi::get_states().has(state) ? static_cast<SavedState*>(state) : nullptr;
}

fmi3FMUState keep_saved(std::unique_ptr<SavedState> saved) {
  bough::fmi::get_states().add(saved.get());
  return saved.release();
}

fmi3Instance instantiate(InstanceOptions options, fmi3String token, fmi3String resources,
                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger, bool may_return_early) {
  const auto send = [environment, logger](Status status, const char* category, const std::string& text) {
    if (logger) logger(environment, static_cast<fmi3Status>(status), category, text.c_str());
  };
  try {
    try {
      options.token = token ? token : "";
      options.resources = bough::fmi::get_path_of_uri(resources ? resources : "");
      options.log = send;
      auto made = std::make_unique<Instance3>(std::move(options));
      made->may_return_early = may_return_early;
      bough::fmi::get_instances().add(static_cast<Instance*>(made.get()));
      return static_cast<Instance*>(made.release());
    } catch (const std::exception& error) {
      send(Status::Error, "logStatusError", error.what());
    }
  } catch (...) {  // no memory for a message
  }
  return nullptr;
}

}  // namespace

extern "C" {

const char* fmi3GetVersion(void) { return "3.0"; }

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean on, size_t, const fmi3String[]) {
  return run3(instance, kAllPhases, "fmi3SetDebugLogging", [&](Instance3& i) {
    i.set_logging(on);
    return Status::Ok;
  });
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String, fmi3String token, fmi3String resources, fmi3Boolean,
                                          fmi3Boolean logs, fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback logger) {
  InstanceOptions options;
  options.is_model_exchange = true;
  options.logs_all = logs;
  return instantiate(std::move(options), token, resources, environment, logger, false);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String, fmi3String token, fmi3String resources, fmi3Boolean,
                                         fmi3Boolean logs, fmi3Boolean event_mode, fmi3Boolean early_return,
                                         const fmi3ValueReference[], size_t num_intermediate,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                         fmi3IntermediateUpdateCallback) {
  if (num_intermediate > 0) {
    if (logger)
      logger(environment, fmi3Error, "logStatusError",
             "fmi3InstantiateCoSimulation: the FMU has no intermediate update: give no intermediate variables");
    return nullptr;
  }
  InstanceOptions options;
  options.has_event_mode = event_mode;
  options.logs_all = logs;
  return instantiate(std::move(options), token, resources, environment, logger, early_return);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                               fmi3ClockUpdateCallback, fmi3LockPreemptionCallback,
                                               fmi3UnlockPreemptionCallback) {
  if (logger)
    logger(environment, fmi3Error, "logStatusError",
           "fmi3InstantiateScheduledExecution: the FMU has Co-Simulation and Model Exchange only");
  return nullptr;
}

void fmi3FreeInstance(fmi3Instance instance) {
  if (bough::fmi::get_instances().remove(instance)) delete static_cast<Instance3*>(static_cast<Instance*>(instance));
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop) {
  return run3(instance, bough::fmi::kInstantiated, "fmi3EnterInitializationMode", [&](Instance3& i) {
    if (has_stop && !std::isfinite(stop)) return i.fail("fmi3EnterInitializationMode: the stop time is not finite");
    const auto status =
        i.set_up(has_tolerance ? tolerance : 0, start, has_stop ? stop : std::numeric_limits<double>::quiet_NaN());
    if (status == Status::Ok) i.set_phase(bough::fmi::kInitialization);
    return status;
  });
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
  return run3(instance, bough::fmi::kInitialization, "fmi3ExitInitializationMode", [](Instance3& i) {
    const auto status = i.finish_initialization();
    const bool has_events = i.options().is_model_exchange || i.options().has_event_mode;
    if (status == Status::Ok) i.set_phase(has_events ? bough::fmi::kEventMode : bough::fmi::kStepMode);
    return status;
  });
}

fmi3Status fmi3EnterEventMode(fmi3Instance instance) {
  return run3(instance, bough::fmi::kContinuousTime | bough::fmi::kStepMode, "fmi3EnterEventMode", [](Instance3& i) {
    if (!i.options().is_model_exchange && !i.options().has_event_mode)
      return i.fail("fmi3EnterEventMode: the instance was made with eventModeUsed = false");
    i.set_phase(bough::fmi::kEventMode);
    return Status::Ok;
  });
}

fmi3Status fmi3Terminate(fmi3Instance instance) {
  return run3(instance, kAllPhases & ~(bough::fmi::kInstantiated | bough::fmi::kTerminated), "fmi3Terminate",
              [](Instance3& i) { return i.terminate(); });
}

fmi3Status fmi3Reset(fmi3Instance instance) {
  return run3(instance, kAllPhases, "fmi3Reset", [](Instance3& i) { return i.reset(); });
}

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference references[], size_t n, fmi3Float64 values[],
                          size_t num_values) {
  return run3(instance, kAllPhases, "fmi3GetFloat64", [&](Instance3& i) {
    if (num_values != n || (n > 0 && !references))
      return i.fail("fmi3GetFloat64: expected as many values as value references, since all variables are scalars");
    return i.get_values({references, n}, values);
  });
}
fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference references[], size_t n,
                          const fmi3Float64 values[], size_t num_values) {
  return run3(instance, kAllPhases & ~unsigned{bough::fmi::kTerminated}, "fmi3SetFloat64", [&](Instance3& i) {
    if (num_values != n || (n > 0 && !references))
      return i.fail("fmi3SetFloat64: expected as many values as value references, since all variables are scalars");
    return i.set_values({references, n}, values);
  });
}
fmi3Status fmi3GetFloat32(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3Float32[], size_t) {
  return reject_type3(i, "fmi3GetFloat32", n);
}
fmi3Status fmi3SetFloat32(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3Float32[], size_t) {
  return reject_type3(i, "fmi3SetFloat32", n);
}
fmi3Status fmi3GetInt8(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3Int8[], size_t) {
  return reject_type3(i, "fmi3GetInt8", n);
}
fmi3Status fmi3SetInt8(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3Int8[], size_t) {
  return reject_type3(i, "fmi3SetInt8", n);
}
fmi3Status fmi3GetUInt8(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3UInt8[], size_t) {
  return reject_type3(i, "fmi3GetUInt8", n);
}
fmi3Status fmi3SetUInt8(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3UInt8[], size_t) {
  return reject_type3(i, "fmi3SetUInt8", n);
}
fmi3Status fmi3GetInt16(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3Int16[], size_t) {
  return reject_type3(i, "fmi3GetInt16", n);
}
fmi3Status fmi3SetInt16(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3Int16[], size_t) {
  return reject_type3(i, "fmi3SetInt16", n);
}
fmi3Status fmi3GetUInt16(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3UInt16[], size_t) {
  return reject_type3(i, "fmi3GetUInt16", n);
}
fmi3Status fmi3SetUInt16(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3UInt16[], size_t) {
  return reject_type3(i, "fmi3SetUInt16", n);
}
fmi3Status fmi3GetInt32(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3Int32[], size_t) {
  return reject_type3(i, "fmi3GetInt32", n);
}
fmi3Status fmi3SetInt32(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3Int32[], size_t) {
  return reject_type3(i, "fmi3SetInt32", n);
}
fmi3Status fmi3GetUInt32(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3UInt32[], size_t) {
  return reject_type3(i, "fmi3GetUInt32", n);
}
fmi3Status fmi3SetUInt32(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3UInt32[], size_t) {
  return reject_type3(i, "fmi3SetUInt32", n);
}
fmi3Status fmi3GetInt64(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3Int64[], size_t) {
  return reject_type3(i, "fmi3GetInt64", n);
}
fmi3Status fmi3SetInt64(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3Int64[], size_t) {
  return reject_type3(i, "fmi3SetInt64", n);
}
fmi3Status fmi3GetUInt64(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3UInt64[], size_t) {
  return reject_type3(i, "fmi3GetUInt64", n);
}
fmi3Status fmi3SetUInt64(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3UInt64[], size_t) {
  return reject_type3(i, "fmi3SetUInt64", n);
}
fmi3Status fmi3GetBoolean(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3Boolean[], size_t) {
  return reject_type3(i, "fmi3GetBoolean", n);
}
fmi3Status fmi3SetBoolean(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3Boolean[], size_t) {
  return reject_type3(i, "fmi3SetBoolean", n);
}
fmi3Status fmi3GetString(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3String[], size_t) {
  return reject_type3(i, "fmi3GetString", n);
}
fmi3Status fmi3SetString(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3String[], size_t) {
  return reject_type3(i, "fmi3SetString", n);
}
fmi3Status fmi3GetBinary(fmi3Instance i, const fmi3ValueReference[], size_t n, size_t[], fmi3Binary[], size_t) {
  return reject_type3(i, "fmi3GetBinary", n);
}
fmi3Status fmi3SetBinary(fmi3Instance i, const fmi3ValueReference[], size_t n, const size_t[], const fmi3Binary[],
                         size_t) {
  return reject_type3(i, "fmi3SetBinary", n);
}
fmi3Status fmi3GetClock(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3Clock[]) {
  return reject_clock(i, "fmi3GetClock", n);
}
fmi3Status fmi3SetClock(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3Clock[]) {
  return reject_clock(i, "fmi3SetClock", n);
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance i, fmi3ValueReference, size_t*) {
  return reject3(i, "fmi3GetNumberOfVariableDependencies", "the FMU provides no dependencies per element");
}
fmi3Status fmi3GetVariableDependencies(fmi3Instance i, fmi3ValueReference, size_t[], fmi3ValueReference[], size_t[],
                                       fmi3DependencyKind[], size_t) {
  return reject3(i, "fmi3GetVariableDependencies", "the FMU provides no dependencies per element");
}

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState* state) {
  return run3(instance, kAllPhases, "fmi3GetFMUState", [&](Instance3& i) {
    if (!state) return i.fail("fmi3GetFMUState: the pointer is null");
    auto saved = i.get_state();
    if (!saved) return Status::Error;
    if (auto* old = find_saved(*state)) {
      *old = std::move(*saved);
      return Status::Ok;
    }
    *state = keep_saved(std::move(saved));
    return Status::Ok;
  });
}
fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state) {
  return run3(instance, kAllPhases, "fmi3SetFMUState", [&](Instance3& i) {
    const auto* saved = find_saved(state);
    if (!saved) return i.fail("fmi3SetFMUState: this is no FMU state, or it was freed");
    return i.set_state(*saved);
  });
}
fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState* state) {
  return run3(instance, kAllPhases, "fmi3FreeFMUState", [&](Instance3&) {
    if (!state) return Status::Ok;
    if (bough::fmi::get_states().remove(*state)) delete static_cast<SavedState*>(*state);
    *state = nullptr;
    return Status::Ok;
  });
}
fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t* size) {
  return run3(instance, kAllPhases, "fmi3SerializedFMUStateSize", [&](Instance3& i) {
    const auto* saved = find_saved(state);
    if (!saved || !size) return i.fail("fmi3SerializedFMUStateSize: this is no FMU state, or the pointer is null");
    *size = i.serialize(*saved).size();
    return Status::Ok;
  });
}
fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
  return run3(instance, kAllPhases, "fmi3SerializeFMUState", [&](Instance3& i) {
    const auto* saved = find_saved(state);
    if (!saved || !bytes) return i.fail("fmi3SerializeFMUState: this is no FMU state, or the pointer is null");
    const auto all = i.serialize(*saved);
    if (size < all.size())
      return i.fail("fmi3SerializeFMUState: the state takes " + std::to_string(all.size()) + " bytes");
    std::copy(all.begin(), all.end(), reinterpret_cast<std::byte*>(bytes));
    return Status::Ok;
  });
}
fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte bytes[], size_t size, fmi3FMUState* state) {
  return run3(instance, kAllPhases, "fmi3DeserializeFMUState", [&](Instance3& i) {
    if (!bytes || !state) return i.fail("fmi3DeserializeFMUState: a pointer is null");
    *state = keep_saved(i.deserialize({reinterpret_cast<const std::byte*>(bytes), size}));
    return Status::Ok;
  });
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t num_unknowns,
                                        const fmi3ValueReference knowns[], size_t num_knowns, const fmi3Float64 seed[],
                                        size_t num_seed, fmi3Float64 sensitivity[], size_t num_sensitivity) {
  return run3(instance, Instance::kDifferentiable, "fmi3GetDirectionalDerivative", [&](Instance3& i) {
    if ((num_unknowns > 0 && !unknowns) || (num_knowns > 0 && !knowns) || num_seed != num_knowns ||
        num_sensitivity != num_unknowns)
      return i.fail(
          "fmi3GetDirectionalDerivative: expected as many seeds as knowns and as many sensitivities as unknowns, "
          "since all variables are scalars");
    return i.get_directional_derivative({unknowns, num_unknowns}, {knowns, num_knowns}, seed, sensitivity);
  });
}
fmi3Status fmi3GetAdjointDerivative(fmi3Instance i, const fmi3ValueReference[], size_t, const fmi3ValueReference[],
                                    size_t, const fmi3Float64[], size_t, fmi3Float64[], size_t) {
  return reject3(i, "fmi3GetAdjointDerivative", "the FMU provides no adjoint derivatives");
}
fmi3Status fmi3EnterConfigurationMode(fmi3Instance i) {
  return reject3(i, "fmi3EnterConfigurationMode", "the FMU has no structural parameters");
}
fmi3Status fmi3ExitConfigurationMode(fmi3Instance i) {
  return reject3(i, "fmi3ExitConfigurationMode", "the FMU has no structural parameters");
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3Float64[],
                                  fmi3IntervalQualifier[]) {
  return reject_clock(i, "fmi3GetIntervalDecimal", n);
}
fmi3Status fmi3GetIntervalFraction(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3UInt64[], fmi3UInt64[],
                                   fmi3IntervalQualifier[]) {
  return reject_clock(i, "fmi3GetIntervalFraction", n);
}
fmi3Status fmi3GetShiftDecimal(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3Float64[]) {
  return reject_clock(i, "fmi3GetShiftDecimal", n);
}
fmi3Status fmi3GetShiftFraction(fmi3Instance i, const fmi3ValueReference[], size_t n, fmi3UInt64[], fmi3UInt64[]) {
  return reject_clock(i, "fmi3GetShiftFraction", n);
}
fmi3Status fmi3SetIntervalDecimal(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3Float64[]) {
  return reject_clock(i, "fmi3SetIntervalDecimal", n);
}
fmi3Status fmi3SetIntervalFraction(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3UInt64[],
                                   const fmi3UInt64[]) {
  return reject_clock(i, "fmi3SetIntervalFraction", n);
}
fmi3Status fmi3SetShiftDecimal(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3Float64[]) {
  return reject_clock(i, "fmi3SetShiftDecimal", n);
}
fmi3Status fmi3SetShiftFraction(fmi3Instance i, const fmi3ValueReference[], size_t n, const fmi3UInt64[],
                                const fmi3UInt64[]) {
  return reject_clock(i, "fmi3SetShiftFraction", n);
}
fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance i) {
  return reject3(i, "fmi3EvaluateDiscreteStates", "the FMU does not provide it: call fmi3UpdateDiscreteStates");
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean* need_update, fmi3Boolean* terminate,
                                    fmi3Boolean* nominals_changed, fmi3Boolean* values_changed, fmi3Boolean* has_next,
                                    fmi3Float64* next) {
  return run3(instance, bough::fmi::kEventMode, "fmi3UpdateDiscreteStates", [&](Instance3& i) {
    if (!need_update || !terminate || !nominals_changed || !values_changed || !has_next || !next)
      return i.fail("fmi3UpdateDiscreteStates: a pointer is null");
    bough_event_info info{};
    const auto status = i.update_discrete(info);
    *need_update = *nominals_changed = false;
    *terminate = info.terminated != 0;
    *values_changed = info.states_changed != 0;
    *has_next = std::isfinite(info.next_event_time) && !info.terminated;
    *next = *has_next ? info.next_event_time : 0;
    return status;
  });
}

// Model Exchange

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance) {
  return run3(instance, bough::fmi::kEventMode, "fmi3EnterContinuousTimeMode", [](Instance3& i) {
    if (!i.options().is_model_exchange) return i.fail("fmi3EnterContinuousTimeMode is not allowed in Co-Simulation");
    i.set_phase(bough::fmi::kContinuousTime);
    return Status::Ok;
  });
}
fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean, fmi3Boolean* enter_event_mode,
                                       fmi3Boolean* terminate) {
  return run3(instance, bough::fmi::kContinuousTime, "fmi3CompletedIntegratorStep", [&](Instance3& i) {
    if (!enter_event_mode || !terminate) return i.fail("fmi3CompletedIntegratorStep: a pointer is null");
    *terminate = false;
    return i.complete_step(*enter_event_mode);
  });
}
fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 t) {
  return run3(instance, bough::fmi::kContinuousTime | bough::fmi::kEventMode, "fmi3SetTime",
              [&](Instance3& i) { return i.set_time(t); });
}
fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 x[], size_t n) {
  return run3(instance, bough::fmi::kContinuousTime, "fmi3SetContinuousStates",
              [&](Instance3& i) { return i.set_states(x, n); });
}
constexpr unsigned kStateGetters =
    bough::fmi::kInitialization | bough::fmi::kEventMode | bough::fmi::kContinuousTime | bough::fmi::kTerminated;
fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 x_dot[], size_t n) {
  return run3(instance, kStateGetters, "fmi3GetContinuousStateDerivatives",
              [&](Instance3& i) { return i.get_derivatives(x_dot, n); });
}
fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 g[], size_t n) {
  return run3(instance, kStateGetters, "fmi3GetEventIndicators",
              [&](Instance3& i) { return i.get_event_functions(g, n); });
}
fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 x[], size_t n) {
  return run3(instance, kStateGetters, "fmi3GetContinuousStates", [&](Instance3& i) { return i.get_states(x, n); });
}
fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[], size_t n) {
  return run3(instance, kAllPhases, "fmi3GetNominalsOfContinuousStates", [&](Instance3& i) {
    if (n != i.num_states() || (n > 0 && !nominals))
      return i.fail("fmi3GetNominalsOfContinuousStates: expected " + std::to_string(i.num_states()) + " values");
    std::fill_n(nominals, n, 1.0);
    return Status::Ok;
  });
}
fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t* n) {
  return run3(instance, kAllPhases, "fmi3GetNumberOfEventIndicators", [&](Instance3& i) {
    if (!n) return i.fail("fmi3GetNumberOfEventIndicators: the pointer is null");
    *n = i.num_event_functions();
    return Status::Ok;
  });
}
fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t* n) {
  return run3(instance, kAllPhases, "fmi3GetNumberOfContinuousStates", [&](Instance3& i) {
    if (!n) return i.fail("fmi3GetNumberOfContinuousStates: the pointer is null");
    *n = i.num_states();
    return Status::Ok;
  });
}

// Co-Simulation

fmi3Status fmi3EnterStepMode(fmi3Instance instance) {
  return run3(instance, bough::fmi::kEventMode, "fmi3EnterStepMode", [](Instance3& i) {
    if (i.options().is_model_exchange) return i.fail("fmi3EnterStepMode is not allowed in Model Exchange");
    i.set_phase(bough::fmi::kStepMode);
    return Status::Ok;
  });
}
fmi3Status fmi3GetOutputDerivatives(fmi3Instance i, const fmi3ValueReference[], size_t, const fmi3Int32[],
                                    fmi3Float64[], size_t) {
  return reject3(i, "fmi3GetOutputDerivatives", "the FMU has no derivatives of outputs");
}
fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 t, fmi3Float64 h, fmi3Boolean,
                      fmi3Boolean* needs_event_handling, fmi3Boolean* terminate, fmi3Boolean* early_return,
                      fmi3Float64* last_time) {
  return run3(instance, bough::fmi::kStepMode, "fmi3DoStep", [&](Instance3& i) {
    if (!needs_event_handling || !terminate || !early_return || !last_time)
      return i.fail("fmi3DoStep: a pointer is null");
    *needs_event_handling = *terminate = *early_return = false;
    bough::fmi::StepResult result;
    const auto status = i.do_step(t, h, result);
    *last_time = result.time;
    if (status != Status::Ok) return status;
    *terminate = result.is_terminated;
    *early_return = result.is_terminated && i.may_return_early;
    if (result.is_terminated && i.options().log) i.options().log(Status::Ok, "logEvents", i.end_message());
    return Status::Ok;
  });
}
fmi3Status fmi3ActivateModelPartition(fmi3Instance i, fmi3ValueReference, fmi3Float64) {
  return reject3(i, "fmi3ActivateModelPartition", "the FMU has no Scheduled Execution");
}

}  // extern "C"
