#include "python/bindings/simulations.hpp"

#include <cmath>
#include <numeric>
#include <span>

#include "embed/bough.h"

namespace bough::python {

Simulation::Simulation(const embed::LoadedSystem& loaded, const embed::SimulationOptions& options,
                       std::optional<records::Checkpoint> start) {
  solver::SimulateOptions run;
  run.resume = std::move(start);
  run.stop = &stop_;
  run.progress = [this](const solver::Progress&) {
    const py::gil_scoped_acquire acquired;
    if (PyErr_CheckSignals() == 0) return;
    PyErr_Clear();
    is_interrupted_ = true;
    stop_ = true;
  };
  if (const auto fault = embed::describe_fault(options); !fault.empty()) throw py::value_error(fault);
  {
    const py::gil_scoped_release released;
    own_ = std::make_unique<embed::Simulation>(loaded, embed::change_spec(loaded.spec, options), std::move(run));
    ports_ = std::make_unique<embed::Ports>(loaded.spec, own_->simulator());
  }
  messages = tell(own_->diagnostics());
}

template <class Action>
auto Simulation::run(const Action& action) {
  if (is_busy_)
    throw std::runtime_error("the simulation is in use by another call, of another thread or of a controller");
  struct Busy {
    explicit Busy(bool& flag) : flag_(flag) { flag_ = true; }
    ~Busy() { flag_ = false; }
    bool& flag_;
  } const busy(is_busy_);
  return action();
}

std::vector<std::string> Simulation::list_names(int kind) const {
  std::vector<std::string> names;
  for (const auto& port : *ports_->list(kind)) names.push_back(port.name);
  return names;
}

int Simulation::find(int kind, const Name& name) const {
  const auto& ports = *ports_->list(kind);
  const std::string what = kind == BOUGH_INPUTS ? "input" : "output";
  if (const int* index = std::get_if<int>(&name)) {
    if (*index >= 0 && *index < std::ssize(ports)) return *index;
    throw py::index_error("no " + what + " " + std::to_string(*index) + ": the system has " +
                          std::to_string(ports.size()));
  }
  const auto& text = std::get<std::string>(name);
  const int found = ports_->find(kind, text);
  if (found >= 0) return found;
  const auto nearest = find_nearest(text, list_names(kind));
  throw py::key_error("no " + what + " " + text + (nearest.empty() ? "" : "; did you mean " + nearest));
}

void Simulation::set(const Name& name, double value) {
  const int index = find(BOUGH_INPUTS, name);
  if (!std::isfinite(value)) throw py::value_error("the value of an input is not finite");
  run([&] { own_->simulator().set_inputs(index, {&value, 1}); });
}

bool Simulation::advance_to(double t) {
  if (!std::isfinite(t)) throw py::value_error("the time to advance to is not finite");
  return run([&] {
    if (failure_) std::rethrow_exception(failure_);
    if (own_->is_past(t)) throw py::value_error(own_->describe_past(t) + ": go back by restore()");
    bool goes_on = false;
    try {
      const py::gil_scoped_release released;
      goes_on = own_->advance_to(t);
    } catch (const Failure&) {
      failure_ = std::current_exception();
      throw;
    }
    stop_ = false;
    if (is_interrupted_) {
      is_interrupted_ = false;
      PyErr_SetNone(PyExc_KeyboardInterrupt);
      throw py::error_already_set();
    }
    return goes_on;
  });
}

Eigen::VectorXd Simulation::calc_outputs(const std::vector<int>& indices) {
  if (failure_) std::rethrow_exception(failure_);
  const py::gil_scoped_release released;
  std::vector<int> rows;
  for (const int index : indices) rows.push_back(ports_->output_rows()[static_cast<std::size_t>(index)]);
  const auto& all = own_->simulator().calc_outputs(rows);
  return all(rows);
}

py::array Simulation::outputs(const std::optional<std::vector<std::string>>& names) {
  std::vector<int> indices;
  if (names) {
    for (const auto& name : *names) {
      const auto found = ports_->find_outputs(name);
      if (found.empty()) find(BOUGH_OUTPUTS, name);  // throws
      indices.insert(indices.end(), found.begin(), found.end());
    }
  } else {
    indices.resize(ports_->list(BOUGH_OUTPUTS)->size());
    std::iota(indices.begin(), indices.end(), 0);
  }
  return run([&] { return give(calc_outputs(indices)); });
}

double Simulation::output(const Name& name) {
  const int index = find(BOUGH_OUTPUTS, name);
  return run([&] { return calc_outputs({index})[0]; });
}

std::string Simulation::get_reason() const {
  return own_->simulator().outcome() ? own_->describe_end() : std::string();
}

py::bytes Simulation::save() {
  return run([&] {
    if (failure_) std::rethrow_exception(failure_);
    std::string bytes(own_->state_size(), '\0');
    own_->save(std::as_writable_bytes(std::span(bytes)));
    return py::bytes(bytes);
  });
}

void Simulation::restore(const std::string& bytes) {
  run([&] {
    own_->restore(std::as_bytes(std::span(bytes)));
    failure_ = nullptr;
  });
}

void bind_simulations(py::module_& m) {
  py::class_<Simulation>(m, "Simulation", "A system that is advanced from Python.")
      .def("set", &Simulation::set, py::arg("name"), py::arg("value"))
      .def("advance_to", &Simulation::advance_to, py::arg("t"))
      .def("outputs", &Simulation::outputs, py::arg("names"))
      .def("output", &Simulation::output, py::arg("name"))
      .def_property_readonly("inputs", [](const Simulation& s) { return s.list_names(BOUGH_INPUTS); })
      .def_property_readonly("output_names", [](const Simulation& s) { return s.list_names(BOUGH_OUTPUTS); })
      .def_property_readonly("time", &Simulation::time)
      .def_property_readonly("reason", &Simulation::get_reason)
      .def_readonly("messages", &Simulation::messages)
      .def("save", &Simulation::save)
      .def("restore", &Simulation::restore, py::arg("state"));
}

}  // namespace bough::python
