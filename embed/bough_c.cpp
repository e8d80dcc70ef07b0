// The C interface: handles, status and messages around load_system() and Simulator.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

#include "base/version.hpp"
#include "embed/bough.h"
#include "embed/files.hpp"
#include "embed/handles.hpp"
#include "embed/model.hpp"

using bough::Diagnostic;
using bough::Diagnostics;

namespace {

using bough::embed::Port;

bool is_alive(const bough_model* model) { return model && bough::embed::get_model_handles().has(model); }
bool is_alive(const bough_simulation* simulation) {
  return simulation && bough::embed::get_simulation_handles().has(simulation);
}

template <std::size_t N>
void put(char (&to)[N], const std::string& text) {
  const std::size_t size = std::min(N - 1, text.size());
  std::memcpy(to, text.data(), size);
  to[size] = '\0';
}

std::string join(const std::vector<Diagnostic>& items) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : "\n") + bough::format(item);
  return text;
}

void fill(bough_message* message, const std::vector<Diagnostic>& items) {
  if (!message) return;
  *message = {};
  if (items.empty()) return;
  put(message->text, join(items));
  const auto is_error = [](const Diagnostic& d) { return d.severity == bough::Severity::Error; };
  const auto first = std::find_if(items.begin(), items.end(), is_error);
  const Diagnostic& d = first == items.end() ? items.front() : *first;
  put(message->id, d.id);
  put(message->file, d.where.file);
  message->line = d.where.line;
  put(message->what, d.what);
  put(message->advice, d.advice);
}

Diagnostic make_error(const char* id, std::string what, std::string advice) {
  return {bough::Severity::Error, id, {}, std::move(what), std::move(advice)};
}

/// Runs `action`; converts its exceptions to a status and messages.
template <class Action>
bough_status call(const Action& action, std::vector<Diagnostic>& told) noexcept {
  try {
    try {
      return action();
    } catch (const bough::InputError& error) {
      told = error.items();
      return BOUGH_BAD_INPUT;
    } catch (const bough::Failure& error) {
      told = error.items();
      return BOUGH_FAILED;
    } catch (const std::bad_alloc&) {
      told = {make_error("memory", "there is no memory left", "")};
      return BOUGH_OUT_OF_MEMORY;
    } catch (const std::exception& error) {
      told = {make_error("internal", error.what(), "report it with the model")};
      return BOUGH_INTERNAL_ERROR;
    } catch (...) {
      told = {make_error("internal", "an exception of an unknown type", "report it with the model")};
      return BOUGH_INTERNAL_ERROR;
    }
  } catch (...) {
    return BOUGH_OUT_OF_MEMORY;
  }
}

using bough::embed::to_text;

bough_status refuse(const std::string& what, bough_message* message) {
  fill(message, {make_error("embed.bad-argument", what, "see bough.h")});
  return BOUGH_BAD_ARGUMENT;
}

bough_status refuse(bough_simulation& simulation, const std::string& what) {
  simulation.message = bough::format(make_error("embed.bad-argument", what, "see bough.h"));
  return BOUGH_BAD_ARGUMENT;
}

/// The message for a range of inputs or outputs that does not exist.
std::string describe_range(const char* what, int first, int n, std::ptrdiff_t count) {
  if (n < 0) return "n is " + std::to_string(n) + ": give the number of " + what;
  return std::string("there are no ") + what + " " + std::to_string(first) + " to " +
         std::to_string(static_cast<long long>(first) + n - 1) + ": the model has " + std::to_string(count);
}

bough_status load(const char* file, const char* toml, const char* const* settings, bough_model** model,
                  bough_message* message) {
  if (message) *message = {};
  if (model) *model = nullptr;
  if (!file || !model) return refuse(file ? "model is null" : "the file is null", message);
  if (!*file) return refuse("the file name is empty", message);
  Diagnostics diagnostics;
  std::vector<Diagnostic> told;
  const auto status = call(
      [&] {
        bough::embed::LoadOptions options;
        for (const char* const* s = settings; s && *s; ++s) options.set.emplace_back(*s);
        if (toml) options.text = toml;
        auto made = std::make_unique<bough_model>();
        made->model = std::make_shared<const bough::embed::Model>(
            bough::embed::load_system(file, bough::embed::get_file_readers(), std::move(options), diagnostics));
        bough::embed::get_model_handles().add(made.get());
        *model = made.release();
        return BOUGH_OK;
      },
      told);
  fill(message, status == BOUGH_OK ? diagnostics.items() : told);
  return status;
}

/// The port, or none.
const Port* find_port(const bough_model* model, bough_kind kind, int index) {
  if (!is_alive(model)) return nullptr;
  const auto* ports = model->model->list(kind);
  return ports && index >= 0 && index < std::ssize(*ports) ? &(*ports)[static_cast<std::size_t>(index)] : nullptr;
}

/// Runs a computation of a simulation; where it fails the simulation is over.
template <class Action>
bough_status compute(bough_simulation& s, const Action& action) noexcept {
  if (s.has_failed) return BOUGH_FAILED;
  std::vector<Diagnostic> told;
  const auto status = call(
      [&] {
        action();
        return BOUGH_OK;
      },
      told);
  if (status == BOUGH_OK) return status;
  s.has_failed = true;
  try {
    s.message = join(told);
  } catch (...) {
    return BOUGH_OUT_OF_MEMORY;
  }
  return status;
}

}  // namespace

namespace bough::embed {

Handles& get_model_handles() {
  static Handles handles;
  return handles;
}
Handles& get_simulation_handles() {
  static Handles handles;
  return handles;
}

std::unique_ptr<bough_simulation> make_simulation(std::shared_ptr<const Model> model, records::SystemSpec spec) {
  auto made = std::make_unique<bough_simulation>();
  made->model = std::move(model);
  made->own = std::make_unique<Simulation>(made->model->loaded(), std::move(spec));
  get_simulation_handles().add(made.get());
  return made;
}

}  // namespace bough::embed

extern "C" {

int bough_abi_version(void) { return BOUGH_ABI_VERSION; }
const char* bough_library_version(void) {
  static const std::string version(bough::get_version());
  return version.c_str();
}
bough_options bough_default_options(void) { return {sizeof(bough_options), nullptr, 0, 0, 0, 0}; }

bough_status bough_load(const char* file, const char* const* settings, bough_model** model, bough_message* message) {
  return load(file, nullptr, settings, model, message);
}

bough_status bough_load_text(const char* toml, const char* folder, const char* const* settings, bough_model** model,
                             bough_message* message) {
  if (!toml) {
    if (model) *model = nullptr;
    return refuse("the text is null", message);
  }
  try {
    const std::string file = folder && *folder ? std::string(folder) + "/system.toml" : "system.toml";
    return load(file.c_str(), toml, settings, model, message);
  } catch (...) {
    return BOUGH_OUT_OF_MEMORY;
  }
}

void bough_unload(bough_model* model) {
  if (model && bough::embed::get_model_handles().remove(model)) delete model;
}

int bough_count(const bough_model* model, bough_kind kind) {
  const auto* ports = is_alive(model) ? model->model->list(kind) : nullptr;
  return ports ? static_cast<int>(ports->size()) : -1;
}

int bough_find(const bough_model* model, bough_kind kind, const char* name) {
  if (!is_alive(model) || !name) return -1;
  try {
    return model->model->find(kind, name);
  } catch (...) {
    return -1;
  }
}

const char* bough_name(const bough_model* model, bough_kind kind, int index) {
  const Port* port = find_port(model, kind, index);
  return port ? port->name.c_str() : nullptr;
}
const char* bough_dims(const bough_model* model, bough_kind kind, int index) {
  const Port* port = find_port(model, kind, index);
  return port ? port->dims.c_str() : nullptr;
}
double bough_start_value(const bough_model* model, bough_kind kind, int index) {
  const Port* port = find_port(model, kind, index);
  return port ? port->start : std::numeric_limits<double>::quiet_NaN();
}

bough_status bough_start(const bough_model* model, const bough_options* options, bough_simulation** simulation,
                         bough_message* message) {
  if (message) *message = {};
  if (simulation) *simulation = nullptr;
  if (!simulation) return refuse("simulation is null", message);
  if (!is_alive(model)) return refuse("the model is null or was unloaded", message);
  if (options && options->size != sizeof(bough_options))
    return refuse("options.size is not sizeof(bough_options): begin with bough_default_options()", message);
  bough::embed::SimulationOptions own;
  if (options) {
    own.step = options->step;
    own.relative_tolerance = options->relative_tolerance;
    own.absolute_tolerance = options->absolute_tolerance;
    own.duration = options->duration;
    if (const auto fault = bough::embed::describe_fault(own); !fault.empty()) return refuse(fault, message);
  }
  std::vector<Diagnostic> told;
  const auto status = call(
      [&] {
        if (options && options->integrator) own.integrator = options->integrator;
        const auto& spec = model->model->loaded().spec;
        *simulation = bough::embed::make_simulation(model->model, bough::embed::change_spec(spec, own)).release();
        return BOUGH_OK;
      },
      told);
  fill(message, status == BOUGH_OK ? (*simulation)->own->diagnostics().items() : told);
  return status;
}

void bough_stop(bough_simulation* simulation) {
  if (simulation && bough::embed::get_simulation_handles().remove(simulation)) delete simulation;
}

double bough_time(const bough_simulation* simulation) {
  return is_alive(simulation) ? simulation->simulator().time() : std::numeric_limits<double>::quiet_NaN();
}

bough_status bough_set_inputs(bough_simulation* simulation, int first, int n, const double* values) {
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  auto& s = *simulation;
  if (s.has_failed) return BOUGH_FAILED;
  if (n == 0) return BOUGH_OK;
  if (!values || first < 0 || n < 0 || n > s.simulator().num_inputs() - first)
    return refuse(s, values ? describe_range("inputs", first, n, s.simulator().num_inputs()) : "values is null");
  for (int i = 0; i < n; ++i)
    if (!std::isfinite(values[i])) return refuse(s, "input " + std::to_string(first + i) + " is not finite");
  s.simulator().set_inputs(first, {values, static_cast<std::size_t>(n)});
  return BOUGH_OK;
}

bough_status bough_advance(bough_simulation* simulation, double t, double* reached) {
  if (reached) *reached = std::numeric_limits<double>::quiet_NaN();
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  auto& s = *simulation;
  const auto& simulator = s.simulator();
  if (reached) *reached = simulator.time();
  if (s.has_failed) return BOUGH_FAILED;
  if (!std::isfinite(t)) return refuse(s, "the time to advance to is not finite");
  if (s.own->is_past(t)) return refuse(s, s.own->describe_past(t) + ": go back by bough_restore");
  std::vector<Diagnostic> told;
  auto status = call([&] { return s.own->advance_to(t) ? BOUGH_OK : BOUGH_TERMINATED; }, told);
  if (reached) *reached = simulator.time();
  try {
    if (status == BOUGH_TERMINATED) s.message = s.own->describe_end();
    if (!told.empty()) s.message = join(told);
  } catch (...) {
    status = BOUGH_OUT_OF_MEMORY;
  }
  if (status > BOUGH_BAD_ARGUMENT) s.has_failed = true;
  return status;
}

bough_status bough_get_outputs(bough_simulation* simulation, int first, int n, double* values) {
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  auto& s = *simulation;
  if (n == 0) return BOUGH_OK;
  const auto& ports = *s.model->list(BOUGH_OUTPUTS);
  if (!values || first < 0 || n < 0 || n > std::ssize(ports) - first)
    return refuse(s, values ? describe_range("outputs", first, n, std::ssize(ports)) : "values is null");
  return compute(s, [&] {
    const auto rows =
        std::span(s.model->output_rows()).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(n));
    const auto& all = s.simulator().calc_outputs(rows);
    for (int i = 0; i < n; ++i) values[i] = all[rows[static_cast<std::size_t>(i)]];
  });
}

bough_status bough_get_continuous(bough_simulation* simulation, double* x) {
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  if (!x) return refuse(*simulation, "x is null");
  if (simulation->has_failed) return BOUGH_FAILED;
  const auto& state = simulation->simulator().state();
  std::copy_n(state.data(), state.size(), x);
  return BOUGH_OK;
}

bough_status bough_set_continuous(bough_simulation* simulation, double t, const double* x) {
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  auto& s = *simulation;
  const Eigen::Map<const Eigen::VectorXd> state(x, x ? s.simulator().num_states() : 0);
  if (!x || !std::isfinite(t) || !state.allFinite())
    return refuse(s, !x ? "x is null" : !std::isfinite(t) ? "t is not finite" : "a state is not finite");
  auto& simulator = s.simulator();
  if (t > simulator.next_event_time() + simulator.resolution())
    return refuse(s, s.own->describe_event_before(t) + ": set that time and call bough_update_discrete");
  return compute(s, [&] { simulator.set_continuous(t, state); });
}

bough_status bough_derivatives(bough_simulation* simulation, double* x_dot) {
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  auto& s = *simulation;
  if (!x_dot) return refuse(s, "x_dot is null");
  return compute(
      s, [&] { s.simulator().calc_derivatives(Eigen::Map<Eigen::VectorXd>(x_dot, s.simulator().num_states())); });
}

bough_status bough_event_functions(bough_simulation* simulation, double* g) {
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  auto& s = *simulation;
  if (!g) return refuse(s, "g is null");
  return compute(s, [&] {
    s.simulator().calc_event_functions(Eigen::Map<Eigen::VectorXd>(g, s.simulator().num_event_functions()));
  });
}

bough_status bough_completed_step(bough_simulation* simulation, int* enter_event_mode) {
  if (enter_event_mode) *enter_event_mode = 0;
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  auto& s = *simulation;
  if (!enter_event_mode) return refuse(s, "enter_event_mode is null");
  return compute(s, [&] { *enter_event_mode = s.simulator().needs_projection() ? 1 : 0; });
}

bough_status bough_update_discrete(bough_simulation* simulation, bough_event_info* info) {
  if (info) *info = {};
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  auto& s = *simulation;
  if (!info) return refuse(s, "info is null");
  return compute(s, [&] {
    info->states_changed = s.simulator().update_discrete() ? 1 : 0;
    info->terminated = s.simulator().outcome() ? 1 : 0;
    info->next_event_time = s.simulator().next_event_time();
    if (info->terminated) s.message = s.own->describe_end();
  });
}

size_t bough_state_size(const bough_simulation* simulation) {
  return is_alive(simulation) ? simulation->own->state_size() : 0;
}

bough_status bough_save(const bough_simulation* simulation, void* buffer, size_t size) {
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  auto& s = *const_cast<bough_simulation*>(simulation);
  if (!buffer || size < s.own->state_size())
    return refuse(s,
                  buffer ? "the state takes " + std::to_string(s.own->state_size()) + " bytes" : "the buffer is null");
  if (s.has_failed) return BOUGH_FAILED;
  std::vector<Diagnostic> told;
  const auto status = call(
      [&] {
        s.own->save({static_cast<std::byte*>(buffer), size});
        return BOUGH_OK;
      },
      told);
  if (!told.empty()) s.message = join(told);
  return status;
}

bough_status bough_restore(bough_simulation* simulation, const void* buffer, size_t size) {
  if (!is_alive(simulation)) return BOUGH_BAD_ARGUMENT;
  auto& s = *simulation;
  if (!buffer) return refuse(s, "the buffer is null");
  std::vector<Diagnostic> told;
  const auto status = call(
      [&] {
        s.own->restore({static_cast<const std::byte*>(buffer), size});
        s.has_failed = false;
        return BOUGH_OK;
      },
      told);
  if (!told.empty()) s.message = join(told);
  return status;
}

const char* bough_last_message(const bough_simulation* simulation) {
  return is_alive(simulation) ? simulation->message.c_str() : "the simulation is null or was stopped";
}

}  // extern "C"
