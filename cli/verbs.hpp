#pragma once
/// \file The list of verbs. Each adds its subcommand and sets `action` when the command line names it.
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace bough::cli {

using Action = std::function<int()>;

/// The commands in the order of `bough --help`, manual pages and completions: a new one is a name here and its
/// add_NAME in a source of cli.
// clang-format off
#define BOUGH_COMMANDS(X) \
  X(check) \
  X(modes) \
  X(static) \
  X(frequency) \
  X(transient) \
  X(matrices) \
  X(split) \
  X(reduce) \
  X(integrals) \
  X(flx) \
  X(compare) \
  X(run) \
  X(equilibrium) \
  X(linearize) \
  X(response) \
  X(select) \
  X(export) \
  X(plot) \
  X(report) \
  X(info) \
  X(init) \
  X(batch) \
  X(edit) \
  X(convert) \
  X(studio)
// clang-format on

#define BOUGH_DECLARE_COMMAND(name) void add_##name(CLI::App& app, Action& action);
BOUGH_COMMANDS(BOUGH_DECLARE_COMMAND)
#undef BOUGH_DECLARE_COMMAND

/// Runs one command line in this process, messages and exit code as from the shell. Words without the program's name.
int run_command(const std::vector<std::string>& words);
/// Every verb's name.
std::vector<std::string> list_verbs();

}  // namespace bough::cli
