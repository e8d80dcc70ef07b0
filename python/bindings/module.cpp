#include "python/bindings/bindings.hpp"

#include "cli/verbs.hpp"

PYBIND11_MODULE(_bough, m) {
  m.doc() = "Bough in this process; use the package bough, which says what each does.";
  using namespace bough::python;
  bind_messages(m);
  bind_bodies(m);
  bind_linear(m);
  bind_systems(m);
  m.def("call", &bough::cli::run_command, py::arg("words"), py::call_guard<py::gil_scoped_release>(),
        "One command line, messages and exit code as from the shell.");
  m.def("verbs", &bough::cli::list_verbs);
}
