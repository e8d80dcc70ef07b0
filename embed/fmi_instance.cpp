#include "embed/fmi_instance.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/version.hpp"
#include "embed/byte_stream.hpp"
#include "embed/files.hpp"
#include "embed/fmi_variables.hpp"
#include "embed/state_bytes.hpp"
#include "solver/signals/input_block.hpp"
#include "solver/state/difference.hpp"

namespace bough::fmi {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kMagic = 0x31534d46554f4221u;

std::string to_text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::vector<double> get_starts(const embed::Model& model, int kind) {
  std::vector<double> values;
  for (const auto& port : *model.list(kind)) values.push_back(port.start);
  return values;
}

[[noreturn]] void fail_state(const char* what) {
  throw InputError("fmu.state", {}, what, "deserialize the bytes that an instance of the same FMU serialized");
}

template <class T>
void write_list(embed::ByteWriter& bytes, const std::vector<T>& values) {
  bytes.write(std::uint64_t{values.size()});
  bytes.write(values.data(), values.size() * sizeof(T));
}

template <class T>
void read_list(embed::ByteReader& reader, std::vector<T>& values) {
  values.resize(reader.read_count(reader.num_left() / sizeof(T)));
  reader.read(values.data(), values.size() * sizeof(T));
}

}  // namespace

embed::Handles& get_instances() {
  static embed::Handles handles;
  return handles;
}
embed::Handles& get_states() {
  static embed::Handles handles;
  return handles;
}

std::string get_path_of_uri(const std::string& uri) {
  if (!uri.starts_with("file:")) return uri;
  std::string rest = uri.substr(5), path;
  if (rest.starts_with("//")) rest = rest.substr(std::min(rest.find('/', 2), rest.size()));
  for (std::size_t i = 0; i < rest.size(); ++i) {
    int code = 0;
    if (rest[i] == '%' && i + 2 < rest.size() &&
        std::from_chars(rest.data() + i + 1, rest.data() + i + 3, code, 16).ptr == rest.data() + i + 3) {
      path += static_cast<char>(code);
      i += 2;
    } else {
      path += rest[i];
    }
  }
  return path;
}

Instance::Instance(InstanceOptions options)
    : options_(std::move(options)),
      start_(kNone),
      stop_(kNone),
      simulation_(nullptr, bough_stop),
      probe_(nullptr, bough_stop) {
  while (options_.resources.size() > 1 && options_.resources.back() == '/') options_.resources.pop_back();
  if (options_.resources.empty())
    throw InputError("fmu.resources", {}, "the folder of the resources is not given",
                     "import the FMU with its resources unpacked");
  token_ = calc_token(options_.resources);
  if (token_ != options_.token)
    throw InputError("fmu.token", {},
                     "the instantiation token (guid) is \"" + options_.token + "\", expected \"" + token_ + "\" for " +
                         options_.resources,
                     "give the token of the modelDescription.xml of this FMU; after a change of its resources, export "
                     "it again");
  load();
  default_parameters_ = parameters_ = built_parameters_;
  default_inputs_ = inputs_ = built_inputs_;
}

Instance::~Instance() = default;

void Instance::log(Status status, const char* category, const std::string& text) const {
  if (options_.log) options_.log(status, category, text);
}

Status Instance::fail(const std::string& text) {
  log(Status::Error, "logStatusError", text);
  return Status::Error;
}

Status Instance::discard(const std::string& text) {
  log(Status::Discard, "logStatusDiscard", text);
  return Status::Discard;
}

Status Instance::check(bough_status status, const bough_simulation* simulation) {
  return status == BOUGH_OK ? Status::Ok : fail(bough_last_message(simulation));
}

/// Loads the system with parameters_ and the start values inputs_, which are empty at first.
void Instance::load() {
  embed::LoadOptions options;
  if (model_) {
    options.flex = model_->loaded().flex;
    const auto& names = *model_->list(BOUGH_PARAMETERS);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (parameters_[i] != default_parameters_[i])
        options.set.push_back(names[i].name + "=" + to_text(parameters_[i]));
    options.change_spec = [this](records::SystemSpec& spec) {
      for (std::size_t i = 0; i < inputs_.size() && i < spec.inputs.size(); ++i) spec.inputs[i].start = inputs_[i];
    };
  }
  Diagnostics diagnostics;
  auto model = std::make_shared<const embed::Model>(embed::load_system(
      options_.resources + "/" + kSystemFile, embed::get_file_readers(), std::move(options), diagnostics));
  if (options_.logs_all)
    for (const auto& item : diagnostics.items()) log(Status::Ok, "logStatusWarning", format(item));
  for (const int kind : {BOUGH_OUTPUTS, BOUGH_STATES, BOUGH_EVENTS}) {
    if (model_ && model_->list(kind)->size() != model->list(kind)->size())
      throw InputError("fmu.structure", {},
                       "with these parameters the system has " + std::to_string(model->list(kind)->size()) + " " +
                           (kind == BOUGH_OUTPUTS  ? "outputs"
                            : kind == BOUGH_STATES ? "states"
                                                   : "event indicators") +
                           ", its modelDescription.xml " + std::to_string(model_->list(kind)->size()),
                       "export an FMU with these parameters: bough export --set NAME=VALUE");
  }
  model_ = std::move(model);
  built_parameters_ = get_starts(*model_, BOUGH_PARAMETERS);
  built_inputs_ = get_starts(*model_, BOUGH_INPUTS);
}

Instance::Simulation Instance::make(const records::SimulationRecord& times) {
  auto spec = model_->loaded().spec;
  spec.simulation = times;
  return {embed::make_simulation(model_, std::move(spec)).release(), bough_stop};
}

void Instance::start() {
  if (parameters_ != built_parameters_ || inputs_ != built_inputs_) load();
  auto times = model_->loaded().spec.simulation;
  if (times.output_step == 0) times.output_step = times.duration / 1000;
  if (std::isfinite(start_)) times.start = start_;
  if (tolerance_ > 0) times.relative_tolerance = tolerance_;
  if (std::isfinite(stop_) && stop_ > times.start + times.duration) times.duration = stop_ - times.start;
  probe_.reset();
  simulation_ = make(times);
  t_ = bough_time(simulation_.get());
  x_.resize(num_states());
  bough_get_continuous(simulation_.get(), x_.data());
  is_moved_ = true;
  if (options_.logs_all)
    for (const auto& item : simulation_->own->diagnostics().items()) log(Status::Ok, "logStatusWarning", format(item));
}

void Instance::ensure_started() {
  if (!simulation_) start();
}

Status Instance::set_up(double tolerance, double start, double stop) {
  if (!std::isfinite(start) || !std::isfinite(tolerance) || tolerance < 0 || (std::isfinite(stop) && !(stop > start)))
    return fail("start time " + to_text(start) + ", stop time " + to_text(stop) + " or tolerance " +
                to_text(tolerance) + " is not valid; give finite times, the stop after the start");
  tolerance_ = tolerance;
  start_ = start;
  stop_ = stop;
  simulation_.reset();
  return Status::Ok;
}

Status Instance::finish_initialization() {
  ensure_started();
  return Status::Ok;
}

Status Instance::terminate() {
  phase_ = kTerminated;
  return Status::Ok;
}

Status Instance::reset() {
  simulation_.reset();
  probe_.reset();
  parameters_ = default_parameters_;
  inputs_ = default_inputs_;
  tolerance_ = 0;
  start_ = stop_ = kNone;
  end_message_.clear();
  phase_ = kInstantiated;
  return Status::Ok;
}

double Instance::time() { return simulation_ ? bough_time(simulation_.get()) : std::isfinite(start_) ? start_ : 0; }

std::size_t Instance::num_states() const { return model_->list(BOUGH_STATES)->size(); }
std::size_t Instance::num_event_functions() const { return model_->list(BOUGH_EVENTS)->size(); }

Status Instance::get_values(std::span<const std::uint32_t> references, double* values) {
  if (!references.empty() && !values) return fail("the array of values is null");
  std::vector<double> x, x_dot, g;
  for (std::size_t i = 0; i < references.size(); ++i) {
    const auto kind = static_cast<VariableKind>(references[i] >> 24);
    const std::size_t index = references[i] & kMaxIndex;
    const auto take = [&](const std::vector<double>& from) {
      if (index >= from.size()) return fail("there is no variable of value reference " + std::to_string(references[i]));
      values[i] = from[index];
      return Status::Ok;
    };
    const auto take_from = [&](std::vector<double>& all, std::size_t size, auto get) {
      auto status = Status::Ok;
      if (all.empty()) {
        all.resize(size);
        status = (this->*get)(all.data(), size);
      }
      return status == Status::Ok ? take(all) : status;
    };
    auto status = Status::Ok;
    if (kind == VariableKind::Input || kind == VariableKind::Parameter) {
      status = take(kind == VariableKind::Input ? inputs_ : parameters_);
      if (status != Status::Ok) return status;
      continue;
    }
    ensure_started();
    switch (kind) {
      case VariableKind::Time:
        status = take({options_.is_model_exchange ? t_ : bough_time(simulation_.get())});
        break;
      case VariableKind::Output:
        if (index >= model_->list(BOUGH_OUTPUTS)->size()) return take({});
        if (status = sync(); status != Status::Ok) return status;
        status = check(bough_get_outputs(simulation_.get(), static_cast<int>(index), 1, values + i), simulation_.get());
        break;
      case VariableKind::State:
        status = take_from(x, num_states(), &Instance::get_states);
        break;
      case VariableKind::Derivative:
        status = take_from(x_dot, num_states(), &Instance::get_derivatives);
        break;
      case VariableKind::EventIndicator:
        status = take_from(g, num_event_functions(), &Instance::get_event_functions);
        break;
      default:
        status = take({});
    }
    if (status != Status::Ok) return status;
  }
  return Status::Ok;
}

Status Instance::set_values(std::span<const std::uint32_t> references, const double* values) {
  if (!references.empty() && !values) return fail("the array of values is null");
  const bool is_before = (phase_ & (kInstantiated | kInitialization)) != 0;
  for (std::size_t i = 0; i < references.size(); ++i) {
    const auto kind = static_cast<VariableKind>(references[i] >> 24);
    const std::size_t index = references[i] & kMaxIndex;
    const std::string name = "the variable of value reference " + std::to_string(references[i]);
    if (kind != VariableKind::Input && kind != VariableKind::Parameter)
      return fail(name + " cannot be set: only inputs and parameters can");
    auto& to = kind == VariableKind::Input ? inputs_ : parameters_;
    if (index >= to.size()) return fail("there is no variable of value reference " + std::to_string(references[i]));
    if (kind == VariableKind::Parameter && !is_before)
      return fail(name + " is a fixed parameter: set it before the end of the initialization");
    if (!std::isfinite(values[i]))
      return fail(name + " is set to " + to_text(values[i]) + ", expected a finite number");
  }
  for (std::size_t i = 0; i < references.size(); ++i) {
    const std::size_t index = references[i] & kMaxIndex;
    const bool is_input = static_cast<VariableKind>(references[i] >> 24) == VariableKind::Input;
    auto& to = is_input ? inputs_ : parameters_;
    if (to[index] == values[i]) continue;
    to[index] = values[i];
    if (is_before) {
      simulation_.reset();
    } else if (const auto status = bough_set_inputs(simulation_.get(), static_cast<int>(index), 1, &values[i]);
               status != BOUGH_OK) {
      return check(status, simulation_.get());
    }
  }
  return Status::Ok;
}

void Instance::extend(double t) {
  const auto& simulator = simulation_->simulator();
  auto times = simulation_->own->spec().simulation;
  times.duration = std::max(2 * times.duration, 1.5 * (t - times.start));
  auto longer = make(times);
  longer->simulator().restore(simulator.save());
  simulation_ = std::move(longer);
  is_moved_ = true;
}

Status Instance::do_step(double t, double h, StepResult& result) {
  ensure_started();
  result.time = bough_time(simulation_.get());
  if (!std::isfinite(t) || !(h > 0) || !std::isfinite(t + h))
    return fail("the communication point " + to_text(t) + " or the step " + to_text(h) +
                " is not valid; give a finite time and a step > 0");
  if (std::abs(t - result.time) > std::max(1e-6 * h, simulation_->simulator().resolution()))
    return fail("the communication point is " + to_text(t) + ", but the instance is at " + to_text(result.time) +
                "; continue from there, or set an FMU state");
  // FMI 2.0.4 section 2.1.6, FMI 3.0.1 section 2.3.3: an instance does not compute past a stop time that is defined.
  if (std::isfinite(stop_) && t + h > stop_ + std::max(1e-6 * h, simulation_->simulator().resolution()))
    return fail("the step to " + to_text(t + h) + " goes past the stop time " + to_text(stop_) +
                "; end there, or set up the instance with a later stop time or none");
  const auto& times = simulation_->own->spec().simulation;
  const auto* outcome = simulation_->simulator().outcome() ? &*simulation_->simulator().outcome() : nullptr;
  const bool may_extend =
      !simulation_->has_failed && (!outcome || (outcome->reason.empty() && outcome->energy_is_kept));
  if (may_extend && t + h > times.start + times.duration + simulation_->simulator().resolution()) extend(t + h);
  const auto status = bough_advance(simulation_.get(), t + h, &result.time);
  // The end of the duration is none of the FMU: the next step makes it longer.
  outcome = simulation_->simulator().outcome() ? &*simulation_->simulator().outcome() : nullptr;
  if (status == BOUGH_TERMINATED && outcome && outcome->reason.empty() && outcome->energy_is_kept &&
      result.time >= t + h - simulation_->simulator().resolution())
    return Status::Ok;
  if (status == BOUGH_TERMINATED) {
    result.is_terminated = true;
    end_message_ = bough_last_message(simulation_.get());
    return Status::Ok;
  }
  return check(status, simulation_.get());
}

Status Instance::set_time(double t) {
  if (!std::isfinite(t)) return discard("the time is not finite");
  ensure_started();
  if (t != t_) is_moved_ = true;
  t_ = t;
  return Status::Ok;
}

Status Instance::set_states(const double* x, std::size_t n) {
  ensure_started();
  if (n != num_states() || (n > 0 && !x))
    return fail(std::to_string(n) + " states are given, expected " + std::to_string(num_states()));
  for (std::size_t i = 0; i < n; ++i)
    if (!std::isfinite(x[i])) return discard("the state " + (*model_->list(BOUGH_STATES))[i].name + " is not finite");
  std::copy_n(x, n, x_.begin());
  is_moved_ = true;
  return Status::Ok;
}

Status Instance::get_states(double* x, std::size_t n) {
  ensure_started();
  if (n != num_states() || (n > 0 && !x))
    return fail(std::to_string(n) + " states are asked for, expected " + std::to_string(num_states()));
  if (!options_.is_model_exchange) return check(bough_get_continuous(simulation_.get(), x), simulation_.get());
  std::copy_n(x_.begin(), n, x);
  return Status::Ok;
}

Status Instance::sync() {
  if (!options_.is_model_exchange || !is_moved_) return Status::Ok;
  const auto& times = simulation_->own->spec().simulation;
  if (t_ > times.start + times.duration + simulation_->simulator().resolution()) extend(t_);
  const auto status = check(bough_set_continuous(simulation_.get(), t_, x_.data()), simulation_.get());
  if (status == Status::Ok) is_moved_ = false;
  return status;
}

/// A copy of the simulation at its time, where the derivatives can be evaluated without a trace in the run.
bough_simulation* Instance::prepare_probe() {
  if (options_.is_model_exchange) return simulation_.get();
  if (!probe_ || probe_->own->fingerprint() != simulation_->own->fingerprint())
    probe_ = make(simulation_->own->spec().simulation);
  probe_->simulator().restore(simulation_->simulator().save());
  probe_->has_failed = false;
  std::vector<double> x(num_states());
  bough_get_continuous(simulation_.get(), x.data());
  bough_set_continuous(probe_.get(), bough_time(simulation_.get()), x.data());
  return probe_.get();
}

Status Instance::get_derivatives(double* x_dot, std::size_t n) {
  ensure_started();
  if (n != num_states() || (n > 0 && !x_dot))
    return fail(std::to_string(n) + " derivatives are asked for, expected " + std::to_string(num_states()));
  if (const auto status = sync(); status != Status::Ok) return status;
  auto* simulation = prepare_probe();
  return check(bough_derivatives(simulation, x_dot), simulation);
}

Status Instance::get_directional_derivative(std::span<const std::uint32_t> unknowns,
                                            std::span<const std::uint32_t> knowns, const double* seed,
                                            double* sensitivity) {
  if ((!knowns.empty() && !seed) || (!unknowns.empty() && !sensitivity))
    return fail("the array of seeds or of sensitivities is null");
  const bool is_before = phase_ == kInitialization;
  ensure_started();
  Eigen::VectorXd dx = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(num_states()));
  std::vector<double> du(inputs_.size()), dp(parameters_.size());
  for (std::size_t i = 0; i < knowns.size(); ++i) {
    const auto kind = static_cast<VariableKind>(knowns[i] >> 24);
    const std::size_t index = knowns[i] & kMaxIndex;
    const bool is_state = kind == VariableKind::State && !is_before && index < num_states(),
               is_input = kind == VariableKind::Input && index < du.size(),
               is_parameter = kind == VariableKind::Parameter && is_before && index < dp.size();
    if (!is_state && !is_input && !is_parameter)
      return fail("no derivative with respect to the variable of value reference " + std::to_string(knowns[i]) +
                  " is provided now; expected " + (is_before ? "inputs and parameters" : "inputs and states"));
    if (!std::isfinite(seed[i])) return fail("the seed " + to_text(seed[i]) + " is not finite");
    (is_state ? dx[static_cast<Eigen::Index>(index)] : is_input ? du[index] : dp[index]) += seed[i];
  }
  for (const auto reference : unknowns) {
    const auto kind = static_cast<VariableKind>(reference >> 24);
    const std::size_t index = reference & kMaxIndex;
    const bool is_row = index < num_states() &&
                        (kind == VariableKind::Derivative || (kind == VariableKind::State && is_before)),
               is_output = kind == VariableKind::Output && index < model_->list(BOUGH_OUTPUTS)->size();
    if (!is_row && !is_output)
      return fail("no derivative of the variable of value reference " + std::to_string(reference) +
                  " is provided now; expected outputs and derivatives of states");
  }
  if (is_before) return differentiate_initialization(unknowns, du, dp, sensitivity);
  if (const auto status = sync(); status != Status::Ok) return status;
  auto& simulator = prepare_probe()->simulator();
  // In Co-Simulation an input that is linear reaches its value at the end of the next step.
  for (int i = 0; i < simulator.num_inputs() && !options_.is_model_exchange; ++i)
    if (simulator.input(i).is_linear()) du[static_cast<std::size_t>(i)] = 0;
  const Eigen::VectorXd all = simulator.differentiate(dx, du);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const std::size_t index = unknowns[i] & kMaxIndex;
    const bool is_output = static_cast<VariableKind>(unknowns[i] >> 24) == VariableKind::Output;
    sensitivity[i] =
        all[is_output ? dx.size() + (*model_->list(BOUGH_OUTPUTS))[index].row : static_cast<Eigen::Index>(index)];
  }
  return Status::Ok;
}

Status Instance::differentiate_initialization(std::span<const std::uint32_t> unknowns,
                                              const std::vector<double>& inputs, const std::vector<double>& parameters,
                                              double* sensitivity) {
  constexpr double kStep = 1e-2;  // of the value
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (inputs[i] != 0) step = std::min(step, kStep * std::max(1.0, std::abs(inputs_[i])) / std::abs(inputs[i]));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double size = parameters_[i] == 0 ? 1 : std::abs(parameters_[i]);
    if (parameters[i] != 0) step = std::min(step, kStep * size / std::abs(parameters[i]));
  }
  if (!std::isfinite(step)) {
    std::fill_n(sensitivity, unknowns.size(), 0.0);
    return Status::Ok;
  }
  struct Restore {
    Instance& instance;
    std::vector<double> inputs = instance.inputs_, parameters = instance.parameters_;
    std::function<void(Status, const char*, const std::string&)> log = std::move(instance.options_.log);
    ~Restore() {
      instance.inputs_ = inputs;
      instance.parameters_ = parameters;
      instance.options_.log = std::move(log);
      instance.simulation_.reset();
    }
  } here{*this};
  options_.log = nullptr;
  const auto f = [&](double h) {
    for (std::size_t i = 0; i < inputs.size(); ++i) inputs_[i] = here.inputs[i] + h * inputs[i];
    for (std::size_t i = 0; i < parameters.size(); ++i) parameters_[i] = here.parameters[i] + h * parameters[i];
    Eigen::VectorXd values(static_cast<Eigen::Index>(unknowns.size()));
    std::string what = "the values of the initialization are not defined";
    try {
      start();
      if (get_values(unknowns, values.data()) == Status::Ok) return values;
    } catch (const InputError& error) {
      what = error.what();
    }
    throw ComputationError("fmu.derivative", {}, what, "differentiate at other values of inputs and parameters");
  };
  const Eigen::VectorXd found = solver::differentiate(f, step).calc_clean();
  std::copy(found.begin(), found.end(), sensitivity);
  return Status::Ok;
}

Status Instance::get_event_functions(double* g, std::size_t n) {
  ensure_started();
  if (n != num_event_functions() || (n > 0 && !g))
    return fail(std::to_string(n) + " event indicators are asked for, expected " +
                std::to_string(num_event_functions()));
  if (n == 0) return Status::Ok;
  if (const auto status = sync(); status != Status::Ok) return status;
  auto* simulation = prepare_probe();
  return check(bough_event_functions(simulation, g), simulation);
}

Status Instance::complete_step(bool& enter_event_mode) {
  if (const auto status = sync(); status != Status::Ok) return status;
  int enter = 0;
  const auto status = check(bough_completed_step(simulation_.get(), &enter), simulation_.get());
  enter_event_mode = enter != 0;
  return status;
}

Status Instance::update_discrete(bough_event_info& info) {
  info = {};
  info.next_event_time = std::numeric_limits<double>::infinity();
  if (!options_.is_model_exchange) return Status::Ok;  // bough_advance handles the events itself
  const auto& times = simulation_->own->spec().simulation;
  if (!std::isfinite(stop_) && t_ > times.start + times.duration - simulation_->simulator().resolution()) extend(t_);
  if (const auto status = sync(); status != Status::Ok) return status;
  const auto status = check(bough_update_discrete(simulation_.get(), &info), simulation_.get());
  if (status != Status::Ok) return status;
  if (info.terminated) end_message_ = bough_last_message(simulation_.get());
  bough_get_continuous(simulation_.get(), x_.data());
  return Status::Ok;
}

std::unique_ptr<SavedState> Instance::get_state() {
  auto saved = std::make_unique<SavedState>();
  *saved = {phase_, parameters_, inputs_, built_parameters_, built_inputs_, tolerance_, start_, stop_, 0, 0, {}};
  if (!simulation_) return saved;
  if (sync() != Status::Ok) return nullptr;
  saved->duration = simulation_->own->spec().simulation.duration;
  saved->output_step = simulation_->own->spec().simulation.output_step;
  saved->bytes.resize(bough_state_size(simulation_.get()));
  if (check(bough_save(simulation_.get(), saved->bytes.data(), saved->bytes.size()), simulation_.get()) != Status::Ok)
    return nullptr;
  return saved;
}

Status Instance::set_state(const SavedState& saved) {
  if (saved.parameters.size() != parameters_.size() || saved.inputs.size() != inputs_.size() ||
      saved.built_parameters.size() != parameters_.size() || saved.built_inputs.size() != inputs_.size())
    return fail("the FMU state is of another FMU");
  Simulation simulation(nullptr, bough_stop);
  if (!saved.bytes.empty()) {
    if (saved.built_parameters != built_parameters_) {
      parameters_ = saved.built_parameters;
      inputs_ = saved.built_inputs;
      load();
    }
    auto times = model_->loaded().spec.simulation;
    if (std::isfinite(saved.start)) times.start = saved.start;
    if (saved.tolerance > 0) times.relative_tolerance = saved.tolerance;
    times.duration = saved.duration;
    times.output_step = saved.output_step;
    const auto* now = simulation_ ? &simulation_->own->spec().simulation : nullptr;
    const bool fits = now && simulation_->model == model_ && now->start == times.start &&
                      now->duration == times.duration && now->output_step == times.output_step &&
                      now->relative_tolerance == times.relative_tolerance;
    simulation = fits ? std::move(simulation_) : make(times);
    const auto status =
        check(bough_restore(simulation.get(), saved.bytes.data(), saved.bytes.size()), simulation.get());
    if (status != Status::Ok) {
      simulation_ = std::move(simulation);
      return status;
    }
    t_ = bough_time(simulation.get());
    x_.resize(num_states());
    bough_get_continuous(simulation.get(), x_.data());
  }
  simulation_ = std::move(simulation);
  probe_.reset();
  parameters_ = saved.parameters;
  inputs_ = saved.inputs;
  tolerance_ = saved.tolerance;
  start_ = saved.start;
  stop_ = saved.stop;
  phase_ = saved.phase;
  is_moved_ = true;
  return Status::Ok;
}

std::vector<std::byte> Instance::serialize(const SavedState& s) const {
  embed::ByteWriter bytes;
  bytes.write(kMagic);
  bytes.write(token_.data(), token_.size());
  bytes.write(std::uint64_t{s.phase});
  for (const double value : {s.tolerance, s.start, s.stop, s.duration, s.output_step}) bytes.write(value);
  for (const auto* values : {&s.parameters, &s.inputs, &s.built_parameters, &s.built_inputs})
    write_list(bytes, *values);
  write_list(bytes, s.bytes);
  bytes.write(embed::calc_hash(bytes.all));
  return std::move(bytes.all);
}

std::unique_ptr<SavedState> Instance::deserialize(std::span<const std::byte> bytes) const {
  embed::ByteReader reader(bytes, fail_state);
  if (reader.read<std::uint64_t>() != kMagic) fail_state("these bytes are no serialized FMU state");
  std::string token(token_.size(), '\0');
  reader.read(token.data(), token.size());
  if (token != token_) fail_state("the serialized state is of another FMU");
  auto s = std::make_unique<SavedState>();
  const auto phase = reader.read<std::uint64_t>();
  for (double* value : {&s->tolerance, &s->start, &s->stop, &s->duration, &s->output_step})
    *value = reader.read<double>();
  for (auto* values : {&s->parameters, &s->inputs, &s->built_parameters, &s->built_inputs}) read_list(reader, *values);
  read_list(reader, s->bytes);
  const std::size_t end = reader.at();
  if (reader.read<std::uint64_t>() != embed::calc_hash(bytes.first(end)) || phase > kTerminated || phase == 0 ||
      (phase & (phase - 1)) != 0)
    fail_state("the state is damaged");
  s->phase = static_cast<Phase>(phase);
  return s;
}

const char* get_name(Phase phase) {
  switch (phase) {
    case kInstantiated:
      return "Instantiated";
    case kInitialization:
      return "Initialization Mode";
    case kEventMode:
      return "Event Mode";
    case kContinuousTime:
      return "Continuous-Time Mode";
    case kStepMode:
      return "Step Mode";
    case kTerminated:
      return "Terminated";
    default:
      return "unknown";
  }
}

}  // namespace bough::fmi
