// Systems and their runs.
#include <algorithm>
#include <atomic>
#include <filesystem>

#include <pybind11/stl/filesystem.h>

#include "analysis/common/inputs.hpp"
#include "analysis/common/start_state.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/linearize/uncertain.hpp"
#include "cli/common/options.hpp"
#include "formats/hdf5/files.hpp"
#include "python/bindings/controllers.hpp"
#include "python/bindings/requests.hpp"
#include "python/bindings/simulations.hpp"
#include "solver/control/user_code.hpp"
#include "solver/simulate/memory_sink.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::python {

namespace {

/// Results in memory, with the same paths as in the file.
struct Results {
  std::vector<std::string> paths;
  std::map<std::string, std::string> descriptions;
  std::map<std::string, Eigen::MatrixXd> channels;
  std::vector<records::EventRecord> events;
  bool completed = false;
  std::string reason;
  double energy_error = 0;
  std::vector<Diagnostic> messages;

  std::string find(const std::string& name) const {
    for (const auto& path :
         {name, "/" + name, "/sensors/" + name, "/signals/" + name, "/controllers/" + name, "/actuators/" + name}) {
      if (channels.count(path)) return path;
    }
    const auto nearest = find_nearest(name, paths);
    throw py::key_error("no channel " + name + (nearest.empty() ? "" : "; did you mean " + nearest));
  }
};

/// Results file of which other threads are kept out while it is used, not while the run computes.
class ExclusiveSink final : public records::ResultSink {
 public:
  explicit ExclusiveSink(const std::string& path) {
    act([&] { file_ = hdf5::make_results_writer(path); });
  }
  ~ExclusiveSink() override {
    act([&] { file_.reset(); });
  }
  void begin(const records::ResultsHeader& header) override {
    act([&] { file_->begin(header); });
  }
  void write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) override {
    act([&] { file_->write_sample(sample); });
  }
  void write_event(const records::EventRecord& event) override {
    act([&] { file_->write_event(event); });
  }
  void write_checkpoint(const records::Checkpoint& checkpoint) override {
    act([&] { file_->write_checkpoint(checkpoint); });
  }
  void write_energy_error(double worst) override {
    act([&] { file_->write_energy_error(worst); });
  }
  void end(bool completed, const std::string& reason) override {
    act([&] { file_->end(completed, reason); });
  }

 private:
  template <class Act>
  static void act(const Act& what) {
    const Exclusive held(false);  // Ctrl-C is looked for at each sample anyway
    what();
  }
  std::unique_ptr<records::ResultSink> file_;
};

/// One sink into memory, perhaps one into a file.
class Tee final : public records::ResultSink {
 public:
  Tee(records::ResultSink& memory, records::ResultSink* file, std::vector<std::pair<std::string, std::string>> source)
      : memory_(memory), file_(file), source_(std::move(source)) {}
  void begin(const records::ResultsHeader& header) override {
    auto own = header;
    own.source = source_;
    each([&](auto& sink) { sink.begin(own); });
  }
  void write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) override {
    each([&](auto& sink) { sink.write_sample(sample); });
  }
  void write_event(const records::EventRecord& event) override {
    each([&](auto& sink) { sink.write_event(event); });
  }
  void write_checkpoint(const records::Checkpoint& checkpoint) override {
    if (file_ != nullptr) file_->write_checkpoint(checkpoint);
  }
  void write_energy_error(double worst) override {
    each([&](auto& sink) { sink.write_energy_error(worst); });
  }
  void end(bool completed, const std::string& reason) override {
    each([&](auto& sink) { sink.end(completed, reason); });
  }

 private:
  template <class Act>
  void each(const Act& act) {
    act(memory_);
    if (file_ != nullptr) act(*file_);
  }
  records::ResultSink& memory_;
  records::ResultSink* file_;
  std::vector<std::pair<std::string, std::string>> source_;
};

Results collect(const solver::MemorySink& memory) {
  Results results;
  for (const auto& channel : memory.header().channels) {
    results.paths.push_back(channel.path);
    results.descriptions[channel.path] = channel.description;
    results.channels[channel.path] = memory.get(channel.path);
  }
  results.events = memory.events();
  results.completed = memory.completed();
  results.reason = memory.reason();
  results.energy_error = memory.energy_error();
  return results;
}

Results read_results(const std::string& path) {
  Results results;
  auto file = hdf5::read_results(path);
  for (auto& [name, values] : file.channels) {
    const auto full = name.empty() || name.front() != '/' ? "/" + name : name;
    results.paths.push_back(full);
    results.channels[full] = std::move(values);
    if (const auto found = file.descriptions.find(name); found != file.descriptions.end())
      results.descriptions[full] = found->second;
  }
  if (!results.channels.count("/time")) {
    results.paths.insert(results.paths.begin(), "/time");
    results.channels["/time"] = file.time;
  }
  results.events = file.events;
  results.completed = file.completed;
  results.reason = file.reason;
  results.energy_error = file.energy_error;
  return results;
}

class PySystem {
 public:
  PySystem(std::string file, const py::dict& controllers, const std::map<std::string, records::FlexBody>& bodies,
           std::vector<std::string> set, std::string start_from, std::optional<std::string> text)
      : file_(std::move(file)), controllers_(controllers) {
    Diagnostics diagnostics;
    analysis::LoadOptions options;
    options.start_from = std::move(start_from);
    options.set = std::move(set);
    options.text = std::move(text);
    options.flex = bodies;
    std::vector<std::string> given;
    for (const auto& [name, body] : bodies) given.push_back(name);
    options.change_spec = [this, given = std::move(given)](records::SystemSpec& spec) {
      check_bodies(spec, file_, given);
      controllers_.put_into(spec);
    };
    is_file_ = !options.text;
    {
      const py::gil_scoped_release released;
      const Exclusive held;
      options_ = options;
      options_.flex.clear();
      loaded_.emplace(analysis::load_system(file_, diagnostics, std::move(options)));
      start_ = analysis::find_start_control(loaded_->start_from, loaded_->system, loaded_->spec.simulation.start,
                                            diagnostics);
      if (start_) solver::demand_resumable(loaded_->system.signals);
      others_ = calc_other_sources();
    }
    messages = tell(diagnostics);
  }

  std::vector<Diagnostic> messages;

  std::vector<std::string> get_bodies() const {
    std::vector<std::string> names;
    for (int b = 0; b < loaded_->system.num_bodies(); ++b) names.push_back(loaded_->system.body_name(b));
    return names;
  }

  Results run(const std::string& output, const py::object& progress) {
    Diagnostics diagnostics;
    Results results;
    bool is_interrupted = false;
    std::unique_ptr<py::error_already_set> raised;
    {
      const py::gil_scoped_release released;
      std::unique_ptr<records::ResultSink> file;
      if (!output.empty()) {
        const Exclusive held;
        const FileRoles roles;
        for (const auto& input : list_files()) note_input(input);
        announce_output(output);
        file = std::make_unique<ExclusiveSink>(output);
      }
      solver::MemorySink memory;
      Tee sink(memory, file.get(), calc_sources());
      std::atomic<bool> stop{false};
      solver::SimulateOptions options;
      options.resume = start_;
      options.stop = &stop;
      options.progress = [&](const solver::Progress& p) {
        const py::gil_scoped_acquire acquired;
        if (PyErr_CheckSignals() != 0) {
          PyErr_Clear();
          is_interrupted = true;
          stop = true;
        } else if (!progress.is_none()) {
          try {
            const py::object answer = progress(p.time, p.end);
            if (py::isinstance<py::bool_>(answer) && !answer.cast<bool>()) stop = true;
          } catch (py::error_already_set& error) {
            // A call that fails ends the run; its exception is raised after the run.
            raised = std::make_unique<py::error_already_set>(std::move(error));
            stop = true;
          }
        }
      };
      solver::simulate(loaded_->system, loaded_->spec, sink, options, diagnostics);
      results = collect(memory);
    }
    if (raised) throw py::error_already_set(*raised);
    if (is_interrupted) {
      PyErr_SetNone(PyExc_KeyboardInterrupt);
      throw py::error_already_set();
    }
    results.messages = tell(diagnostics);
    return results;
  }

  /// The caller keeps this system alive as long as the simulation.
  std::unique_ptr<Simulation> start(const std::string& integrator, double step, double relative_tolerance,
                                    double absolute_tolerance, double duration) const {
    return std::make_unique<Simulation>(
        *loaded_, embed::SimulationOptions{integrator, step, relative_tolerance, absolute_tolerance, duration}, start_);
  }

  py::tuple linearize(std::optional<double> at, bool equilibrium, bool open, std::vector<std::string> inputs,
                      std::vector<std::string> outputs, std::vector<std::string> uncertain) {
    Diagnostics diagnostics;
    records::LinearModel model;
    {
      const py::gil_scoped_release released;
      analysis::LinearizeRequest request;
      request.file = file_;
      request.at = at;
      request.equilibrium = equilibrium;
      request.open = open;
      request.inputs = std::move(inputs);
      request.outputs = std::move(outputs);
      request.uncertain = std::move(uncertain);
      if (request.uncertain.empty()) {
        model = analysis::linearize(request, *loaded_, diagnostics);
      } else {
        const Exclusive held;  // it builds the system again, for each value
        if (calc_other_sources() != others_)
          throw InputError("cli.changed-input", {file_},
                           "a table, a matrix, a library or the initial state of the system has changed since it was "
                           "read",
                           "make the System again");
        auto load = options_;
        load.text = loaded_->spec.text;
        load.flex = loaded_->flex;
        model = analysis::linearize_uncertain(request, load, diagnostics);
      }
      model.source = calc_sources();
    }
    return py::make_tuple(std::move(model), tell(diagnostics));
  }

 private:
  /// Names and hashes of the files; controllers from Python have none.
  std::vector<std::pair<std::string, std::string>> calc_sources() const { return analysis::calc_sources(list_files()); }
  std::vector<std::string> list_files() const {
    auto files = analysis::collect_sources(file_, *loaded_);
    if (!is_file_) files.erase(files.begin());
    std::erase_if(files, [](const std::string& name) { return name.starts_with("python:"); });
    return files;
  }

  /// Throws InputError "cli.bad-option" for a body that stands for no file of the system.
  static void check_bodies(const records::SystemSpec& spec, const std::string& file,
                           const std::vector<std::string>& given) {
    const auto place = [&](const std::string& name) {
      std::error_code none;
      return std::filesystem::absolute(analysis::resolve_beside(file, name), none).lexically_normal();
    };
    std::vector<std::string> names;
    std::string list;
    for (const auto& body : spec.bodies)
      if (!body.file.empty() && std::find(names.begin(), names.end(), body.file) == names.end()) {
        list += (names.empty() ? "" : ", ") + body.file;
        names.push_back(body.file);
      }
    for (const auto& name : given) {
      if (std::any_of(names.begin(), names.end(), [&](const auto& own) { return place(own) == place(name); })) continue;
      throw InputError("cli.bad-option", {file}, "bodies: no [[body]] has file = \"" + name + "\"",
                       names.empty() ? "leave bodies out: no body of the system has a file" : "the files are " + list);
    }
  }

  /// Names and hashes of files that linearize(uncertain=) reads again: all but the system file and the bodies.
  std::vector<std::pair<std::string, std::string>> calc_other_sources() const {
    auto files = list_files();
    std::erase_if(files, [&](const std::string& name) {
      const auto& bodies = loaded_->flex_path;
      return name == file_ ||
             std::any_of(bodies.begin(), bodies.end(), [&](const auto& b) { return b.second == name; });
    });
    return analysis::calc_sources(files);
  }

  std::string file_;
  bool is_file_ = true;
  Controllers controllers_;
  analysis::LoadOptions options_;  ///< of loaded_
  std::vector<std::pair<std::string, std::string>> others_;
  std::optional<analysis::LoadedSystem> loaded_;
  std::optional<records::Checkpoint> start_;  ///< controllers and actuators of start_from, out of an equilibrium
};

}  // namespace

void bind_systems(py::module_& m) {
  py::class_<records::EventRecord>(m, "Event", "A line of /events: what happened, and when.")
      .def_readonly("time", &records::EventRecord::time)
      .def_readonly("what", &records::EventRecord::what)
      .def("__repr__", [](const records::EventRecord& e) { return std::to_string(e.time) + ": " + e.what; });

  py::class_<Results>(
      m, "Results",
      "Samples of a run: results[\"/sensors/tip\"] or results[\"tip\"]: nt of one component, nt x components of "
      "several.")
      .def("__getitem__",
           [](py::object self, const std::string& name) {
             const auto& results = self.cast<const Results&>();
             const auto& channel = results.channels.at(results.find(name));
             py::object values = view(channel, self);
             return channel.cols() == 1 ? values.attr("reshape")(-1) : values;
           })
      .def("__contains__",
           [](const Results& r, const std::string& name) {
             try {
               r.find(name);
               return true;
             } catch (const py::key_error&) {
               return false;
             }
           })
      .def("__iter__", [](py::object self) { return py::iter(py::cast(self.cast<const Results&>().paths)); })
      .def("__len__", [](const Results& r) { return r.paths.size(); })
      .def("keys", [](const Results& r) { return r.paths; })
      .def("describe", [](const Results& r, const std::string& name) { return r.descriptions.at(r.find(name)); })
      .def_property_readonly("time",
                             [](py::object self) {
                               const auto& time = self.cast<const Results&>().channels.at("/time");
                               return view(time, self).attr("reshape")(-1);
                             })
      .def_readonly("events", &Results::events)
      .def_readonly("completed", &Results::completed)
      .def_readonly("reason", &Results::reason)
      .def_readonly("energy_error", &Results::energy_error, "the worst of the run, relative")
      .def_readonly("messages", &Results::messages)
      .def("__repr__", [](const Results& r) {
        return "<Results: " + std::to_string(r.paths.size()) + " channels, " +
               std::to_string(r.channels.at("/time").rows()) + " samples>";
      });
  m.def(
      "read_results", [](const std::filesystem::path& path) { return read_results(path); }, py::arg("path"),
      OneAtATime());

  py::class_<PySystem>(m, "System")
      .def(py::init<std::string, const py::dict&, const std::map<std::string, records::FlexBody>&,
                    std::vector<std::string>, std::string, std::optional<std::string>>(),
           py::arg("file"), py::arg("controllers"), py::arg("bodies"), py::arg("set"), py::arg("start_from"),
           py::arg("text"))
      .def_property_readonly("bodies", &PySystem::get_bodies)
      .def_readonly("messages", &PySystem::messages)
      .def("run", &PySystem::run, py::arg("output"), py::arg("progress"))
      .def("start", &PySystem::start, py::arg("integrator"), py::arg("step"), py::arg("relative_tolerance"),
           py::arg("absolute_tolerance"), py::arg("duration"), py::keep_alive<0, 1>())
      .def("linearize", &PySystem::linearize, py::arg("at"), py::arg("equilibrium"), py::arg("open"), py::arg("inputs"),
           py::arg("outputs"), py::arg("uncertain"));
}

}  // namespace bough::python
