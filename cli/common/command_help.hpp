#pragma once
/// \file Texts of --help, the manual pages and the command-line reference.
#include <string>

namespace bough::cli {

struct CommandHelp {
  std::string summary;  ///< one line
  std::string footer;   ///< after the options: examples and remarks
};

/// Texts of a command. \pre The command is in BOUGH_COMMANDS (cli/verbs.hpp).
const CommandHelp& get_command_help(const std::string& command);

}  // namespace bough::cli
