// FMI 2.0, Co-Simulation and Model Exchange: the functions of the standard on fmi_instance.hpp.
#include "embed/fmi2_types.h"

#include <cmath>
#include <limits>

#include "embed/fmi_instance.hpp"

namespace {

using bough::fmi::Instance;
using bough::fmi::InstanceOptions;
using bough::fmi::Status;
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr unsigned kAny = bough::fmi::kAnyPhase;

/// Component of FMI 2: an Instance and what only that version has.
struct Component : Instance {
  Component(InstanceOptions options, std::string component_name, const fmi2CallbackFunctions* functions)
      : Instance(std::move(options)), name(std::move(component_name)), callbacks(functions) {}
  std::string name;
  const fmi2CallbackFunctions* callbacks;
  bool is_terminated = false;
};

/// The message of the logger is a format: percent signs are doubled.
std::string escape_format(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '%' ? std::string("%%") : std::string(1, c);
  return escaped;
}

void send(const fmi2CallbackFunctions* functions, const char* name, Status status, const char* category,
          const std::string& text) {
  if (functions && functions->logger)
    functions->logger(functions->componentEnvironment, name, static_cast<fmi2Status>(status), category,
                      escape_format(text).c_str());
}

template <class Action>
fmi2Status run(fmi2Component component, unsigned allowed, const char* function, const Action& action) noexcept {
  return static_cast<fmi2Status>(bough::fmi::call(
      component, allowed, function, [&](Instance& instance) { return action(static_cast<Component&>(instance)); }));
}

fmi2Status reject(fmi2Component component, const char* function, const char* why) noexcept {
  return run(component, kAny, function, [&](Component& c) { return c.fail(std::string(function) + ": " + why); });
}

/// *value becomes that of `get`, a function of the component, if the kind of status is the right one.
template <class Value, class Get>
fmi2Status get_status(fmi2Component component, const char* function, Value* value, bool is_kind, const Get& get) {
  return run(component, kAny, function, [&](Component& c) {
    if (!value || !is_kind) return c.discard(std::string(function) + ": no status of this kind");
    *value = get(c);
    return Status::Ok;
  });
}

/// Variables of other types than Real do not exist.
fmi2Status reject_type(fmi2Component component, const char* function, std::size_t n) noexcept {
  return run(component, kAny, function, [&](Component& c) {
    return n == 0 ? Status::Ok : c.fail(std::string(function) + ": the FMU has variables of type Real only");
  });
}

/// The path of a saved state, if it is live.
bough::fmi::SavedState* find_state(fmi2FMUstate state) {
  return state && bough::fmi::get_states().has(state) ? static_cast<bough::fmi::SavedState*>(state) : nullptr;
}

void free_state(fmi2FMUstate state) {
  if (bough::fmi::get_states().remove(state)) delete static_cast<bough::fmi::SavedState*>(state);
}

fmi2FMUstate keep_state(std::unique_ptr<bough::fmi::SavedState> saved) {
  bough::fmi::get_states().add(saved.get());
  return saved.release();
}

}  // namespace

extern "C" {

const char* fmi2GetTypesPlatform(void) { return "default"; }
const char* fmi2GetVersion(void) { return "2.0"; }

fmi2Status fmi2SetDebugLogging(fmi2Component component, fmi2Boolean on, size_t, const fmi2String[]) {
  return run(component, kAny, "fmi2SetDebugLogging", [&](Component& c) {
    c.set_logging(on != 0);
    return Status::Ok;
  });
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* functions, fmi2Boolean, fmi2Boolean logs) {
  try {
    const std::string of = name ? name : "";
    try {
      InstanceOptions options;
      options.token = guid ? guid : "";
      options.resources = bough::fmi::get_path_of_uri(resources ? resources : "");
      options.is_model_exchange = type == fmi2ModelExchange;
      options.logs_all = logs != 0;
      options.log = [of, functions](Status status, const char* category, const std::string& text) {
        send(functions, of.c_str(), status, category, text);
      };
      auto made = std::make_unique<Component>(std::move(options), of, functions);
      bough::fmi::get_instances().add(static_cast<Instance*>(made.get()));
      return static_cast<Instance*>(made.release());
    } catch (const std::exception& error) {
      send(functions, of.c_str(), Status::Error, "logStatusError", error.what());
    }
  } catch (...) {  // no memory for a message
  }
  return nullptr;
}

void fmi2FreeInstance(fmi2Component component) {
  if (bough::fmi::get_instances().remove(component)) delete static_cast<Component*>(static_cast<Instance*>(component));
}

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean has_stop, fmi2Real stop) {
  return run(component, bough::fmi::kInstantiated, "fmi2SetupExperiment", [&](Component& c) {
    if (has_stop && !std::isfinite(stop)) return c.fail("fmi2SetupExperiment: the stop time is not finite");
    return c.set_up(has_tolerance ? tolerance : 0, start, has_stop ? stop : kUndefined);
  });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component component) {
  return run(component, bough::fmi::kInstantiated, "fmi2EnterInitializationMode", [](Component& c) {
    c.set_phase(bough::fmi::kInitialization);
    return Status::Ok;
  });
}

fmi2Status fmi2ExitInitializationMode(fmi2Component component) {
  return run(component, bough::fmi::kInitialization, "fmi2ExitInitializationMode", [](Component& c) {
    const auto status = c.finish_initialization();
    if (status == Status::Ok)
      c.set_phase(c.options().is_model_exchange ? bough::fmi::kEventMode : bough::fmi::kStepMode);
    return status;
  });
}

fmi2Status fmi2Terminate(fmi2Component component) {
  return run(component, kAny & ~(bough::fmi::kInstantiated | bough::fmi::kTerminated), "fmi2Terminate",
             [](Component& c) { return c.terminate(); });
}

fmi2Status fmi2Reset(fmi2Component component) {
  return run(component, kAny, "fmi2Reset", [](Component& c) {
    c.is_terminated = false;
    return c.reset();
  });
}

fmi2Status fmi2GetReal(fmi2Component component, const fmi2ValueReference references[], size_t n, fmi2Real values[]) {
  return run(component, kAny, "fmi2GetReal", [&](Component& c) {
    if (n > 0 && !references) return c.fail("fmi2GetReal: the array of value references is null");
    return c.get_values({references, n}, values);
  });
}
fmi2Status fmi2SetReal(fmi2Component component, const fmi2ValueReference references[], size_t n,
                       const fmi2Real values[]) {
  return run(component, kAny & ~unsigned{bough::fmi::kTerminated}, "fmi2SetReal", [&](Component& c) {
    if (n > 0 && !references) return c.fail("fmi2SetReal: the array of value references is null");
    return c.set_values({references, n}, values);
  });
}
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference[], size_t n, fmi2Integer[]) {
  return reject_type(c, "fmi2GetInteger", n);
}
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference[], size_t n, fmi2Boolean[]) {
  return reject_type(c, "fmi2GetBoolean", n);
}
fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference[], size_t n, fmi2String[]) {
  return reject_type(c, "fmi2GetString", n);
}
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2Integer[]) {
  return reject_type(c, "fmi2SetInteger", n);
}
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2Boolean[]) {
  return reject_type(c, "fmi2SetBoolean", n);
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2String[]) {
  return reject_type(c, "fmi2SetString", n);
}

fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate* state) {
  return run(component, kAny, "fmi2GetFMUstate", [&](Component& c) {
    if (!state) return c.fail("fmi2GetFMUstate: the pointer is null");
    auto saved = c.get_state();
    if (!saved) return Status::Error;
    if (auto* old = find_state(*state)) {
      *old = std::move(*saved);
      return Status::Ok;
    }
    *state = keep_state(std::move(saved));
    return Status::Ok;
  });
}
fmi2Status fmi2SetFMUstate(fmi2Component component, fmi2FMUstate state) {
  return run(component, kAny, "fmi2SetFMUstate", [&](Component& c) {
    const auto* saved = find_state(state);
    if (!saved) return c.fail("fmi2SetFMUstate: this is no FMU state, or it was freed");
    c.is_terminated = false;
    return c.set_state(*saved);
  });
}
fmi2Status fmi2FreeFMUstate(fmi2Component component, fmi2FMUstate* state) {
  return run(component, kAny, "fmi2FreeFMUstate", [&](Component&) {
    if (!state) return Status::Ok;
    free_state(*state);
    *state = nullptr;
    return Status::Ok;
  });
}
fmi2Status fmi2SerializedFMUstateSize(fmi2Component component, fmi2FMUstate state, size_t* size) {
  return run(component, kAny, "fmi2SerializedFMUstateSize", [&](Component& c) {
    const auto* saved = find_state(state);
    if (!saved || !size) return c.fail("fmi2SerializedFMUstateSize: this is no FMU state, or the pointer is null");
    *size = c.serialize(*saved).size();
    return Status::Ok;
  });
}
fmi2Status fmi2SerializeFMUstate(fmi2Component component, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  return run(component, kAny, "fmi2SerializeFMUstate", [&](Component& c) {
    const auto* saved = find_state(state);
    if (!saved || !bytes) return c.fail("fmi2SerializeFMUstate: this is no FMU state, or the pointer is null");
    const auto all = c.serialize(*saved);
    if (size < all.size())
      return c.fail("fmi2SerializeFMUstate: the state takes " + std::to_string(all.size()) + " bytes");
    std::copy(all.begin(), all.end(), reinterpret_cast<std::byte*>(bytes));
    return Status::Ok;
  });
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component component, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  return run(component, kAny, "fmi2DeSerializeFMUstate", [&](Component& c) {
    if (!bytes || !state) return c.fail("fmi2DeSerializeFMUstate: a pointer is null");
    *state = keep_state(c.deserialize({reinterpret_cast<const std::byte*>(bytes), size}));
    return Status::Ok;
  });
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component component, const fmi2ValueReference unknowns[],
                                        size_t num_unknowns, const fmi2ValueReference knowns[], size_t num_knowns,
                                        const fmi2Real seed[], fmi2Real sensitivity[]) {
  return run(component, Instance::kDifferentiable, "fmi2GetDirectionalDerivative", [&](Component& c) {
    if ((num_unknowns > 0 && !unknowns) || (num_knowns > 0 && !knowns))
      return c.fail("fmi2GetDirectionalDerivative: an array of value references is null");
    return c.get_directional_derivative({unknowns, num_unknowns}, {knowns, num_knowns}, seed, sensitivity);
  });
}

// Model Exchange

fmi2Status fmi2EnterEventMode(fmi2Component component) {
  return run(component, bough::fmi::kContinuousTime, "fmi2EnterEventMode", [](Component& c) {
    c.set_phase(bough::fmi::kEventMode);
    return Status::Ok;
  });
}
fmi2Status fmi2NewDiscreteStates(fmi2Component component, fmi2EventInfo* info) {
  return run(component, bough::fmi::kEventMode, "fmi2NewDiscreteStates", [&](Component& c) {
    if (!info) return c.fail("fmi2NewDiscreteStates: the pointer is null");
    bough_event_info found{};
    const auto status = c.update_discrete(found);
    const bool has_next = std::isfinite(found.next_event_time) && !found.terminated;
    *info = {0, found.terminated, 0, found.states_changed, has_next ? 1 : 0, has_next ? found.next_event_time : 0};
    if (found.terminated) send(c.callbacks, c.name.c_str(), Status::Ok, "logEvents", c.end_message());
    return status;
  });
}
fmi2Status fmi2EnterContinuousTimeMode(fmi2Component component) {
  return run(component, bough::fmi::kEventMode, "fmi2EnterContinuousTimeMode", [](Component& c) {
    if (!c.options().is_model_exchange) return c.fail("fmi2EnterContinuousTimeMode is not allowed in Co-Simulation");
    c.set_phase(bough::fmi::kContinuousTime);
    return Status::Ok;
  });
}
fmi2Status fmi2CompletedIntegratorStep(fmi2Component component, fmi2Boolean, fmi2Boolean* enter_event_mode,
                                       fmi2Boolean* terminate) {
  return run(component, bough::fmi::kContinuousTime, "fmi2CompletedIntegratorStep", [&](Component& c) {
    if (!enter_event_mode || !terminate) return c.fail("fmi2CompletedIntegratorStep: a pointer is null");
    bool enter = false;
    const auto status = c.complete_step(enter);
    *enter_event_mode = enter ? 1 : 0;
    *terminate = 0;
    return status;
  });
}
fmi2Status fmi2SetTime(fmi2Component component, fmi2Real t) {
  return run(component, bough::fmi::kContinuousTime | bough::fmi::kEventMode, "fmi2SetTime",
             [&](Component& c) { return c.set_time(t); });
}
fmi2Status fmi2SetContinuousStates(fmi2Component component, const fmi2Real x[], size_t n) {
  return run(component, bough::fmi::kContinuousTime, "fmi2SetContinuousStates",
             [&](Component& c) { return c.set_states(x, n); });
}
constexpr unsigned kStateReaders =
    bough::fmi::kInitialization | bough::fmi::kEventMode | bough::fmi::kContinuousTime | bough::fmi::kTerminated;
fmi2Status fmi2GetDerivatives(fmi2Component component, fmi2Real x_dot[], size_t n) {
  return run(component, kStateReaders, "fmi2GetDerivatives", [&](Component& c) { return c.get_derivatives(x_dot, n); });
}
fmi2Status fmi2GetEventIndicators(fmi2Component component, fmi2Real g[], size_t n) {
  return run(component, kStateReaders, "fmi2GetEventIndicators",
             [&](Component& c) { return c.get_event_functions(g, n); });
}
fmi2Status fmi2GetContinuousStates(fmi2Component component, fmi2Real x[], size_t n) {
  return run(component, kStateReaders, "fmi2GetContinuousStates", [&](Component& c) { return c.get_states(x, n); });
}
fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component component, fmi2Real nominals[], size_t n) {
  return run(component, kAny, "fmi2GetNominalsOfContinuousStates", [&](Component& c) {
    if (n != c.num_states() || (n > 0 && !nominals))
      return c.fail("fmi2GetNominalsOfContinuousStates: expected " + std::to_string(c.num_states()) + " values");
    std::fill_n(nominals, n, 1.0);
    return Status::Ok;
  });
}

// Co-Simulation

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference[], size_t, const fmi2Integer[],
                                       const fmi2Real[]) {
  return reject(c, "fmi2SetRealInputDerivatives", "the FMU does not interpolate inputs by derivatives");
}
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference[], size_t, const fmi2Integer[],
                                        fmi2Real[]) {
  return reject(c, "fmi2GetRealOutputDerivatives", "the FMU has no derivatives of outputs");
}
fmi2Status fmi2DoStep(fmi2Component component, fmi2Real t, fmi2Real h, fmi2Boolean) {
  return run(component, bough::fmi::kStepMode, "fmi2DoStep", [&](Component& c) {
    bough::fmi::StepResult result;
    const auto status = c.do_step(t, h, result);
    if (status != Status::Ok) return status;
    c.is_terminated = result.is_terminated;
    return result.is_terminated ? c.discard(c.end_message()) : Status::Ok;
  });
}
fmi2Status fmi2CancelStep(fmi2Component c) {
  return reject(c, "fmi2CancelStep", "no step is pending: the FMU does not run asynchronously");
}
fmi2Status fmi2GetStatus(fmi2Component component, const fmi2StatusKind kind, fmi2Status* value) {
  return get_status(component, "fmi2GetStatus", value, kind == fmi2DoStepStatus,
                    [](Component& c) { return c.is_terminated ? fmi2Discard : fmi2OK; });
}
fmi2Status fmi2GetRealStatus(fmi2Component component, const fmi2StatusKind kind, fmi2Real* value) {
  return get_status(component, "fmi2GetRealStatus", value, kind == fmi2LastSuccessfulTime,
                    [](Component& c) { return c.time(); });
}
fmi2Status fmi2GetIntegerStatus(fmi2Component component, const fmi2StatusKind, fmi2Integer*) {
  return run(component, kAny, "fmi2GetIntegerStatus",
             [](Component& c) { return c.discard("fmi2GetIntegerStatus: no status of this kind"); });
}
fmi2Status fmi2GetBooleanStatus(fmi2Component component, const fmi2StatusKind kind, fmi2Boolean* value) {
  return get_status(component, "fmi2GetBooleanStatus", value, kind == fmi2Terminated,
                    [](Component& c) { return c.is_terminated ? 1 : 0; });
}
fmi2Status fmi2GetStringStatus(fmi2Component component, const fmi2StatusKind kind, fmi2String* value) {
  return get_status(component, "fmi2GetStringStatus", value, kind == fmi2PendingStatus, [](Component&) { return ""; });
}

}  // extern "C"
