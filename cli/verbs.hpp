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

void add_check(CLI::App& app, Action& action);
void add_modes(CLI::App& app, Action& action);
void add_static(CLI::App& app, Action& action);
void add_matrices(CLI::App& app, Action& action);
void add_split(CLI::App& app, Action& action);
void add_reduce(CLI::App& app, Action& action);
void add_integrals(CLI::App& app, Action& action);
void add_flx(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_export(CLI::App& app, Action& action);
void add_plot(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);
void add_init(CLI::App& app, Action& action);
void add_batch(CLI::App& app, Action& action);
void add_equilibrium(CLI::App& app, Action& action);
void add_linearize(CLI::App& app, Action& action);
void add_response(CLI::App& app, Action& action);
void add_select(CLI::App& app, Action& action);

/// Runs one command line in this process, messages and exit code as from the shell. Words without the program's name.
int run_command(const std::vector<std::string>& words);
/// Every verb's name.
std::vector<std::string> list_verbs();

}  // namespace bough::cli
