#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/common/help_files.hpp"
#include "cli/common/usage_text.hpp"

namespace bough::cli {

namespace {

/// The words after the command's name are searched at each key press; for an empty list bash completes file names.
constexpr auto kScript = R"(# Completion of bough for bash, written by bough --bash-completion.
_bough() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD - 1]}}" verb="" options="" values="" i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "${{COMP_WORDS[i]}}" in
      -*) ;;
      *) verb="${{COMP_WORDS[i]}}"; break ;;
    esac
  done
  # bash splits --to=csv into three words.
  if [ "$word" = "=" ]; then
    word=""
  elif [ "$before" = "=" ]; then
    before="${{COMP_WORDS[COMP_CWORD - 2]}}"
  fi
  case "$verb" in
{options}  esac
  case "$verb $before" in
{values}  esac
  if [ -n "$values" ]; then
    COMPREPLY=($(compgen -W "$values" -- "$word"))
  elif [ -z "$verb" ] || [ "${{word:0:1}}" = "-" ]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
    if [ -z "$verb" ]; then
      compopt -o nosort 2> /dev/null  # commands in the order of their groups, from bash 4.4 on
    fi
  else
    COMPREPLY=()
  fi
}}
complete -o default -F _bough bough
)";

std::vector<std::string> list_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const auto& name : option.get_snames()) names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string list_options(const CLI::App& app) {
  std::string out;
  for (const auto* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // not for users
    for (const auto& name : list_names(*option)) out += (out.empty() ? "" : " ") + name;
  }
  return out;
}

}  // namespace

std::string make_bash_completion(const CLI::App& app) {
  const auto verbs = app.get_subcommands(nullptr);
  std::string names, options, values;
  for (const auto* verb : verbs) {
    names += verb->get_name() + " ";
    options += fmt::format("    {}) options=\"{}\" ;;\n", verb->get_name(), list_options(*verb));
    for (const auto* option : verb->get_options()) {
      const auto words = list_choices(*option);
      if (words.empty()) continue;
      for (const auto& name : list_names(*option)) {
        values += fmt::format("    \"{} {}\") values=\"{}\" ;;\n", verb->get_name(), name, words);
      }
    }
  }
  std::string groups;
  for (const auto& [heading, members] : list_command_groups(app)) {
    groups += "    # " + heading + ":";
    for (const auto* verb : members) groups += " " + verb->get_name();
    groups += '\n';
  }
  options = groups + fmt::format("    \"\") options=\"{}{}\" ;;\n", names, list_options(app)) + options;
  return fmt::format(kScript, fmt::arg("options", options), fmt::arg("values", values));
}

}  // namespace bough::cli
