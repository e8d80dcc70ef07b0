#pragma once
/// \file One command line in this process, for a caller that wants to know what went wrong and not only read it.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::cli {

struct CommandOutcome {
  int exit_code = 0;
  std::vector<Diagnostic> failures;  ///< what was printed of the failure that ended it; empty where it ended otherwise
};
/// Runs the command as run_command (cli/verbs.hpp) does, with the same output.
CommandOutcome run_and_tell(const std::vector<std::string>& words);

}  // namespace bough::cli
