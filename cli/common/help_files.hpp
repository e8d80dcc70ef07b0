#pragma once
/// \\file The help for other programs, generated from the declared options of the commands.
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace bough::cli {

/// Headings of `bough --help`, each with its commands in their order.
std::vector<std::pair<std::string, std::vector<const CLI::App*>>> list_command_groups(const CLI::App& app);

/// The manual page bough(1), in the man macros of roff.
std::string make_man_page(const CLI::App& app);

/// The page bough-COMMAND(1) of one command; empty if there is no such command.
std::string make_verb_man_page(const CLI::App& app, const std::string& verb);

/// The completion script for bash: commands in the order of their groups, the options of each command, the values of
/// options with a fixed list of words; else file names.
std::string make_bash_completion(const CLI::App& app);

/// Completion scripts for zsh and fish, with the group of each command and a line about each command and option.
std::string make_zsh_completion(const CLI::App& app);
std::string make_fish_completion(const CLI::App& app);

}  // namespace bough::cli
