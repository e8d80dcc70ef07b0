// Failures as exceptions with their messages, each with file and line.
#include <cstdlib>

#include "analysis/common/failures.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/controllers.hpp"

namespace bough::python {

namespace {

py::handle g_input_error, g_computation_error, g_warning;

/// With the exit code that the command line has for the failure.
void raise(const Failure& failure) {
  if (restore_interrupt()) return;
  const int exit_code = analysis::choose_exit_code(failure);
  const py::handle type = exit_code == 1 ? g_input_error : g_computation_error;
  const py::object error = type(failure.what());
  error.attr("messages") = py::cast(failure.items());
  error.attr("exit_code") = exit_code;
  PyErr_SetObject(type.ptr(), error.ptr());
}

const char* get_word(Severity severity) {
  return severity == Severity::Error ? "error" : severity == Severity::Warning ? "warning" : "note";
}

py::object make_type(py::module_& m, const char* name, py::handle base, const char* doc) {
  auto type = py::reinterpret_steal<py::object>(
      PyErr_NewExceptionWithDoc((std::string("bough.") + name).c_str(), doc, base.ptr(), nullptr));
  m.attr(name) = type;
  return type;
}

}  // namespace

std::vector<Diagnostic> tell(const Diagnostics& diagnostics) {
  for (const auto& d : diagnostics.items()) {
    if (d.severity == Severity::Warning && PyErr_WarnEx(g_warning.ptr(), format(d).c_str(), 2) != 0)
      throw py::error_already_set();
  }
  return diagnostics.items();
}

void bind_messages(py::module_& m) {
  py::class_<Diagnostic>(m, "Message", "What went wrong, where, and what to do about it.")
      .def_property_readonly("severity", [](const Diagnostic& d) { return get_word(d.severity); })
      .def_readonly("id", &Diagnostic::id)
      .def_property_readonly("file", [](const Diagnostic& d) { return d.where.file; })
      .def_property_readonly("line", [](const Diagnostic& d) { return d.where.line; })
      .def_property_readonly("column", [](const Diagnostic& d) { return std::abs(d.where.column); })
      .def_readonly("what", &Diagnostic::what)
      .def_readonly("advice", &Diagnostic::advice)
      .def("__str__", [](const Diagnostic& d) { return format(d); })
      .def("__repr__", [](const Diagnostic& d) { return "<" + format(d) + ">"; });

  const auto failure = make_type(m, "Failure", PyExc_RuntimeError, "What Bough raises; .messages has every one.");
  // They live as long as the interpreter.
  g_input_error = make_type(m, "InputError", failure, "The input is wrong.").release();
  g_computation_error =
      make_type(m, "ComputationError", failure, "The computation failed: singular, diverged, not converged.").release();
  g_warning = make_type(m, "Warning", PyExc_UserWarning, "A warning of Bough.").release();
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Failure& failure) {
      raise(failure);
    }
  });
}

}  // namespace bough::python
