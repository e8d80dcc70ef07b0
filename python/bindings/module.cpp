#include "cli/common/user_code.hpp"
#include "python/bindings/bindings.hpp"

#include "cli/command.hpp"
#include "cli/verbs.hpp"
#include "python/bindings/simulations.hpp"

PYBIND11_MODULE(_bough, m) {
  m.doc() = "Bough in this process; use the package bough, which says what each does.";
  using namespace bough::python;
  bough::cli::guard_user_code();
  bind_messages(m);
  bind_exclusive(m);
  bind_bodies(m);
  bind_linear(m);
  bind_simulations(m);
  bind_systems(m);
  m.def("call", &bough::cli::run_command, py::arg("words"), OneAtATime(),
        "One command line, messages and exit code as from the shell.");
  m.def(
      "call_and_tell",
      [](const std::vector<std::string>& words) {
        const auto outcome = bough::cli::run_and_tell(words);
        return std::make_pair(outcome.exit_code, outcome.failures);
      },
      py::arg("words"), OneAtATime(), "As call: the exit code, and the messages of the failure that ended it.");
  m.def("verbs", &bough::cli::list_verbs);
}
