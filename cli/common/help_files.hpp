#pragma once
/// \\file The help for other programs, generated from the declared options of the commands.
#include <string>

namespace CLI {
class App;
}

namespace bough::cli {

/// The manual page bough(1), in the man macros of roff.
std::string make_man_page(const CLI::App& app);

/// The page bough-COMMAND(1) of one command; empty if there is no such command.
std::string make_verb_man_page(const CLI::App& app, const std::string& verb);

/// The completion script for bash: commands, the options of each command, the values of options with a fixed list of
/// words; else file names.
std::string make_bash_completion(const CLI::App& app);

/// Completion scripts for zsh and fish, with a line about each command and option.
std::string make_zsh_completion(const CLI::App& app);
std::string make_fish_completion(const CLI::App& app);

}  // namespace bough::cli
