#pragma once
/// \file Controllers written in Python, lent to the solver through the C interface of controllers.
#include <memory>
#include <string>
#include <vector>

#include "formats/records/system_spec.hpp"
#include "python/bindings/bindings.hpp"
#include "solver/control/hosted.hpp"

namespace bough::python {

/// Sets the Python error that a controller raised in this thread and that is no Exception (KeyboardInterrupt,
/// SystemExit); returns false if there is none. It ended the call as a failure, in the place of which it comes out.
/// \pre this thread holds the interpreter's lock.
bool restore_interrupt();

/// Lends the functions of Python objects as long as it lives. An object is called as f(t, u) and gives the outputs, or
/// has methods outputs(t, u, z, d), derivatives(t, u, z, d), update(t, u, z, d), start(), close() and numbers
/// num_outputs, num_states, num_memory, has_feedthrough, of which only outputs (or the call) must be there.
class Controllers {
 public:
  explicit Controllers(const py::dict& by_name);
  /// Puts each in the place of the controller of its name, which keeps its inputs and sample time. Throws InputError
  /// "control.unknown-controller".
  void put_into(records::SystemSpec& spec) const;

 private:
  std::vector<std::pair<std::string, std::string>> files_;  ///< name, file it stands under
  std::vector<std::unique_ptr<solver::HostedController>> hosted_;
};

}  // namespace bough::python
