#include "python/bindings/exclusive.hpp"

#include <chrono>
#include <mutex>
#include <optional>

#include "python/bindings/bindings.hpp"

namespace bough::python {

namespace {

std::recursive_timed_mutex& get_lock() {
  static std::recursive_timed_mutex lock;
  return lock;
}

/// For `with`.
class ExclusiveBlock {
 public:
  void enter() {
    const py::gil_scoped_release released;
    held_.emplace();
  }
  void exit() { held_.reset(); }

 private:
  std::optional<Exclusive> held_;
};

}  // namespace

Exclusive::Exclusive(bool is_interruptible) {
  while (!get_lock().try_lock_for(std::chrono::milliseconds(100))) {
    if (!is_interruptible) continue;
    const py::gil_scoped_acquire acquired;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

Exclusive::~Exclusive() { get_lock().unlock(); }

void bind_exclusive(py::module_& m) {
  py::class_<ExclusiveBlock>(m, "Exclusive", "with Exclusive(): no other thread is within MPI, PETSc or HDF5.")
      .def(py::init<>())
      .def("__enter__",
           [](py::object self) {
             self.cast<ExclusiveBlock&>().enter();
             return self;
           })
      .def("__exit__", [](ExclusiveBlock& self, const py::args&) { self.exit(); });
}

}  // namespace bough::python
