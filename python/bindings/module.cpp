#include "cli/common/user_code.hpp"
#include "python/bindings/bindings.hpp"

#include "base/version.hpp"
#include "cli/verbs.hpp"
#include "python/bindings/simulations.hpp"

PYBIND11_MODULE(_bough, m) {
  m.doc() = "Bough in this process; use the package bough, which says what each does.";
  using namespace bough::python;
  m.attr("__version__") = bough::get_version();
  bough::cli::guard_user_code();
  bind_messages(m);
  bind_exclusive(m);
  bind_bodies(m);
  bind_analyses(m);
  bind_decks(m);
  bind_commands(m);
  bind_linear(m);
  bind_simulations(m);
  bind_systems(m);
  m.def("call", &bough::cli::run_command, py::arg("words"), OneAtATime(),
        "One command line, messages and exit code as from the shell.");
  m.def("verbs", &bough::cli::list_verbs);
}
