#include "python/bindings/controllers.hpp"

#include <atomic>
#include <stdexcept>

namespace bough::python {

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Interrupt, no Exception, that a controller raised in this thread; a reference.
thread_local PyObject* g_interrupt = nullptr;

void keep_interrupt(const py::error_already_set& error) {
  Py_XDECREF(g_interrupt);
  g_interrupt = error.value().inc_ref().ptr();
  if (error.trace()) PyException_SetTraceback(g_interrupt, error.trace().ptr());
}

/// Calls Python; its exceptions are converted to exceptions that need no interpreter, a keyboard interrupt is kept too.
template <class Act>
int call(const Act& act) {
  const py::gil_scoped_acquire acquired;
  std::string why;
  try {
    act();
    return 0;
  } catch (const py::error_already_set& error) {
    why = error.what();
    if (!error.matches(PyExc_Exception)) keep_interrupt(error);
  } catch (const std::exception& error) {
    why = error.what();
  }
  throw std::runtime_error(why);
}

/// The object with its sizes; owned by the instance pointer of the interface.
struct Law {
  py::object object, outputs;
  int inputs = 0, num_outputs = 1, states = 0, memory = 0;

  Array read(const double* values, int n) const { return Array(n, values); }
  py::tuple make_arguments(double t, const double* u, const double* z, const double* d) const {
    return py::make_tuple(t, read(u, inputs), read(z, states), read(d, memory));
  }
  static void copy(const py::object& from, int n, double* to, const char* what) {
    if (from.is_none())
      throw std::runtime_error(std::string(what) + " gave None, expected " + std::to_string(n) +
                               (n == 1 ? " number" : " numbers") + "; is a return missing?");
    const Array values(from);
    if (values.size() != n)
      throw std::runtime_error(std::string(what) + " gave " + std::to_string(values.size()) + " numbers, expected " +
                               std::to_string(n));
    std::copy_n(values.data(), n, to);
  }
};

int get_size(const py::object& object, const char* name, int otherwise) {
  return py::hasattr(object, name) ? object.attr(name).cast<int>() : otherwise;
}

void open(const py::object& object, bough_controller* c) {
  auto law = std::make_unique<Law>();
  law->object = object;
  law->inputs = c->inputs;
  c->outputs = law->num_outputs = get_size(object, "num_outputs", 1);
  c->states = law->states = get_size(object, "num_states", 0);
  c->memory = law->memory = get_size(object, "num_memory", 0);
  c->has_feedthrough = get_size(object, "has_feedthrough", 1);
  const bool has_method = py::hasattr(object, "outputs");
  if (!has_method && PyCallable_Check(object.ptr()) == 0)
    throw std::runtime_error("it can neither be called nor has it a method outputs(t, u, z, d)");
  for (const auto& [name, size] : {std::pair{"derivatives", law->states}, std::pair{"update", law->memory}}) {
    if (size > 0 && !py::hasattr(object, name))
      throw std::runtime_error(std::string("it has no method ") + name + "(t, u, z, d)");
  }
  law->outputs = has_method ? object.attr("outputs") : py::object();
  c->instance = law.release();
}

solver::ControllerFunctions make_functions(const py::object& object) {
  const auto kept = std::make_shared<py::object>(object);
  solver::ControllerFunctions f;
  f.language = "Python";
  f.version = [] { return BOUGH_CONTROLLER_VERSION; };
  f.open = [kept](bough_controller* c) { return call([&] { open(*kept, c); }); };
  f.outputs = [](void* self, double t, const double* u, const double* z, const double* d, double* y) {
    const auto& law = *static_cast<Law*>(self);
    return call([&] {
      const py::object given =
          law.outputs ? law.outputs(*law.make_arguments(t, u, z, d)) : law.object(t, law.read(u, law.inputs));
      Law::copy(given, law.num_outputs, y, "it");
    });
  };
  f.derivatives = [](void* self, double t, const double* u, const double* z, const double* d, double* z_dot) {
    const auto& law = *static_cast<Law*>(self);
    return call([&] {
      Law::copy(law.object.attr("derivatives")(*law.make_arguments(t, u, z, d)), law.states, z_dot, "derivatives");
    });
  };
  f.update = [](void* self, double t, const double* u, const double* z, const double* d, double* next) {
    const auto& law = *static_cast<Law*>(self);
    return call([&] {
      if (law.memory > 0)
        Law::copy(law.object.attr("update")(*law.make_arguments(t, u, z, d)), law.memory, next, "update");
    });
  };
  f.start = [](void* self, double* z, double* d) {
    const auto& law = *static_cast<Law*>(self);
    return call([&] {
      if (!py::hasattr(law.object, "start")) return;
      const py::tuple given = law.object.attr("start")();
      if (given.size() != 2) throw std::runtime_error("start gives the states and the memory");
      Law::copy(given[0], law.states, z, "start");
      Law::copy(given[1], law.memory, d, "start");
    });
  };
  f.close = [](void* self) {
    const py::gil_scoped_acquire acquired;
    const std::unique_ptr<Law> law(static_cast<Law*>(self));
    if (law && py::hasattr(law->object, "close")) {
      try {
        law->object.attr("close")();
      } catch (py::error_already_set& error) {
        error.discard_as_unraisable("close of a controller");
      }
    }
  };
  return f;
}

}  // namespace

bool restore_interrupt() {
  if (g_interrupt == nullptr) return false;
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(g_interrupt)), g_interrupt);
  Py_CLEAR(g_interrupt);
  return true;
}

Controllers::Controllers(const py::dict& by_name) {
  static std::atomic<long> count{0};
  for (const auto& [key, value] : by_name) {
    const auto name = py::cast<std::string>(key);
    const auto file = "python:" + std::to_string(++count) + ":" + name;
    files_.emplace_back(name, file);
    hosted_.push_back(
        std::make_unique<solver::HostedController>(file, make_functions(py::reinterpret_borrow<py::object>(value))));
  }
}

void Controllers::put_into(records::SystemSpec& spec) const {
  for (const auto& [name, file] : files_) {
    records::ControllerRecord* found = nullptr;
    for (auto& controller : spec.controllers) {
      if (controller.name == name) found = &controller;
    }
    if (found == nullptr)
      throw InputError("control.unknown-controller", {spec.file}, "there is no controller \"" + name + "\"",
                       "add [[controller]] with this name, its inputs and type = \"library\"");
    records::Settings kept;
    for (const char* key : {"sample_time", "delay", "outputs", "parameters"}) {
      if (const auto number = found->settings.numbers.find(key); number != found->settings.numbers.end())
        kept.numbers.insert(*number);
    }
    kept.words["file"] = {file};
    found->type = "library";
    found->settings = kept;
    found->reference.clear();
    found->rate.clear();
  }
}

}  // namespace bough::python
