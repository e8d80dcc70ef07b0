#pragma once
/// \file bough.h in C++: handles that close themselves, failures as exceptions. Header only; C++17. See
/// docs/embedding.md.
#include <cstddef>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bough.h"

namespace bough {

/// A call that failed. what() is the whole message.
class Error : public std::runtime_error {
 public:
  Error(bough_status status, const std::string& text) : std::runtime_error(text), status_(status) {}
  /// Status of the call that failed.
  bough_status status() const { return status_; }

 private:
  bough_status status_;
};

struct Port {
  std::string name, dims;
};

/// A loaded system. Constant; copies share it, also between threads.
class Model {
 public:
  /// Throws Error. parameters: other numbers for [parameters].
  static Model load(const std::string& file, const std::map<std::string, double>& parameters = {}) {
    return make(parameters, [&](const char* const* settings, bough_model** model, bough_message* message) {
      return bough_load(file.c_str(), settings, model, message);
    });
  }
  /// Loads a text; paths in it are relative to `folder`.
  static Model load_text(const std::string& toml, const std::string& folder = ".",
                         const std::map<std::string, double>& parameters = {}) {
    return make(parameters, [&](const char* const* settings, bough_model** model, bough_message* message) {
      return bough_load_text(toml.c_str(), folder.c_str(), settings, model, message);
    });
  }

  /// Inputs in order, with their dimensions.
  std::vector<Port> inputs() const { return list(BOUGH_INPUTS); }
  /// Components of all outputs in order, with their dimensions.
  std::vector<Port> outputs() const { return list(BOUGH_OUTPUTS); }
  /// Numbers of [parameters], with their dimensions.
  std::vector<Port> parameters() const { return list(BOUGH_PARAMETERS); }
  /// Index of a port. Throws Error when there is none.
  int find_input(const std::string& name) const { return find(BOUGH_INPUTS, "input", name); }
  /// Index of an output. Throws Error when there is none.
  int find_output(const std::string& name) const { return find(BOUGH_OUTPUTS, "output", name); }
  /// The handle for functions of bough.h; it stays the model's.
  const bough_model* get() const { return model_.get(); }

 private:
  explicit Model(bough_model* model) : model_(model, bough_unload) {}
  template <class Load>
  static Model make(const std::map<std::string, double>& parameters, const Load& load) {
    if (bough_abi_version() != BOUGH_ABI_VERSION)
      throw Error(BOUGH_BAD_ARGUMENT, "libbough.so has another ABI version than bough.hpp: build the host again");
    std::vector<std::string> texts;
    for (const auto& entry : parameters) {
      char number[40];
      std::size_t size = 0;
      format(entry.second, number, size);
      texts.push_back(entry.first + "=" + std::string(number, size));
    }
    std::vector<const char*> settings;
    for (const auto& text : texts) settings.push_back(text.c_str());
    settings.push_back(nullptr);
    bough_model* model = nullptr;
    const auto message = std::make_unique<bough_message>();
    const auto status = load(settings.data(), &model, message.get());
    if (status != BOUGH_OK) throw Error(status, message->text);
    return Model(model);
  }
  /// 17 digits with a point, whatever the locale.
  static void format(double value, char (&to)[40], std::size_t& size) {
    size = static_cast<std::size_t>(std::snprintf(to, sizeof to, "%.17g", value));
    for (char& c : to)
      if (c == ',') c = '.';
  }
  std::vector<Port> list(bough_kind kind) const {
    std::vector<Port> ports;
    for (int i = 0; i < bough_count(get(), kind); ++i)
      ports.push_back({bough_name(get(), kind, i), bough_dims(get(), kind, i)});
    return ports;
  }
  int find(bough_kind kind, const char* what, const std::string& name) const {
    const int index = bough_find(get(), kind, name.c_str());
    if (index < 0) throw Error(BOUGH_BAD_ARGUMENT, std::string("the model has no ") + what + " '" + name + "'");
    return index;
  }

  std::shared_ptr<bough_model> model_;
};

/// Options of a run; zero or empty: those of the system file.
struct Options {
  std::string integrator;
  double step = 0, relative_tolerance = 0, absolute_tolerance = 0, duration = 0;
};

enum class Reached { Time, Terminated };

/// A system in motion; of one thread at a time.
class Simulation {
 public:
  explicit Simulation(const Model& model, const Options& options = {}) {
    bough_options o = bough_default_options();
    if (!options.integrator.empty()) o.integrator = options.integrator.c_str();
    o.step = options.step;
    o.relative_tolerance = options.relative_tolerance;
    o.absolute_tolerance = options.absolute_tolerance;
    o.duration = options.duration;
    bough_simulation* simulation = nullptr;
    const auto message = std::make_unique<bough_message>();
    const auto status = bough_start(model.get(), &o, &simulation, message.get());
    if (status != BOUGH_OK) throw Error(status, message->text);
    simulation_.reset(simulation);
  }

  /// Time reached. [T]
  double time() const { return bough_time(get()); }
  /// Sets one input from the present time on.
  void set_input(int input, double value) { set_inputs(input, &value, 1); }
  /// Sets n inputs from index `first` on.
  void set_inputs(int first, const double* values, int n) { demand(bough_set_inputs(get(), first, n, values)); }
  /// Terminated: by an event or at the end of the run; reason() says which, time() where.
  Reached advance_to(double t) {
    const auto status = bough_advance(get(), t, nullptr);
    if (status == BOUGH_TERMINATED) return Reached::Terminated;
    demand(status);
    return Reached::Time;
  }
  /// Reason of the end of the run, or the message of the last call that failed.
  std::string reason() const { return bough_last_message(get()); }
  /// One output at the present time.
  double output(int index) const {
    double value = 0;
    demand(bough_get_outputs(get(), index, 1, &value));
    return value;
  }
  /// Copies n outputs from index `first` on.
  void outputs(int first, double* values, int n) const { demand(bough_get_outputs(get(), first, n, values)); }
  /// The whole state as bytes, for restore().
  std::vector<std::byte> save() const {
    std::vector<std::byte> state(bough_state_size(get()));
    demand(bough_save(get(), state.data(), state.size()));
    return state;
  }
  /// Continues from the bytes of save(), of this or of an equal simulation.
  void restore(const std::vector<std::byte>& state) { demand(bough_restore(get(), state.data(), state.size())); }
  /// The handle, still owned by this; null after a move.
  bough_simulation* get() const { return simulation_.get(); }

 private:
  struct Stop {
    /// Releases the simulation, as the deleter of the handle.
    void operator()(bough_simulation* simulation) const { bough_stop(simulation); }
  };
  void demand(bough_status status) const {
    if (status != BOUGH_OK) throw Error(status, bough_last_message(get()));
  }
  std::unique_ptr<bough_simulation, Stop> simulation_;
};

}  // namespace bough
