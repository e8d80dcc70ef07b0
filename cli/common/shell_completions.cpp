#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "base/quoted_text.hpp"
#include "cli/common/help_files.hpp"
#include "cli/common/usage_text.hpp"

namespace bough::cli {

namespace {

/// The first sentence of what an option does, on one line: what fits next to a name in a list.
std::string shorten(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? ' ' : c;
  if (const auto stop = out.find(". "); stop != std::string::npos) out.resize(stop);
  return out;
}

/// Options of an app that are for users, positionals left out.
std::vector<const CLI::Option*> list_named(const CLI::App& app) {
  std::vector<const CLI::Option*> out;
  for (const auto* option : app.get_options())
    if (!option->get_group().empty() && option->nonpositional()) out.push_back(option);
  return out;
}

/// In single quotes of zsh, with the characters that _arguments and _describe read told from theirs.
std::string quote_zsh(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else if (c == ':' || c == '[' || c == ']' || c == '\\') {
      out += std::string("\\") + c;
    } else {
      out += c;
    }
  }
  return out;
}

std::string write_zsh_options(const CLI::App& app) {
  std::string out;
  for (const auto* option : list_named(app)) {
    std::string argument;
    if (option->get_type_size() != 0 && option->get_expected_max() > 0) {
      const auto words = list_choices(*option);
      const char* const sign = option->get_expected_min() == 0 ? "::" : ":";
      argument = sign + std::string("value:") + (words.empty() ? "_files" : "(" + words + ")");
    }
    const auto about = quote_zsh(shorten(option->get_description()));
    for (const auto& name : option->get_snames()) out += fmt::format("'*-{}[{}]{}' ", name, about, argument);
    for (const auto& name : option->get_lnames())
      out += fmt::format("'*--{}{}[{}]{}' ", name, argument.empty() ? "" : "=", about, argument);
  }
  return out;
}

std::string quote_fish(const std::string& text) { return quote_with('\'', text); }

std::string write_fish_options(const CLI::App& app, const std::string& condition) {
  std::string out;
  for (const auto* option : list_named(app)) {
    out += "complete -c bough -n " + quote_fish(condition);
    for (const auto& name : option->get_snames()) out += " -s " + name;
    for (const auto& name : option->get_lnames()) out += " -l " + name;
    const auto words = list_choices(*option);
    if (!words.empty()) {
      out += " -x -a " + quote_fish(words);
    } else if (option->get_type_size() != 0 && option->get_expected_min() > 0) {
      out += " -r";
    }
    out += " -d " + quote_fish(shorten(option->get_description())) + "\n";
  }
  return out;
}

constexpr auto kZsh = R"(#compdef bough
# Completion of bough for zsh, written by bough --zsh-completion.
_bough() {{
  local -a verbs
  local verb="" word
  for word in "${{(@)words[2,CURRENT-1]}}"; do
    if [[ $word != -* ]]; then verb=$word; break; fi
  done
  case $verb in
{options}  esac
}}
if [ "$funcstack[1]" = "_bough" ]; then
  _bough "$@"
else
  compdef _bough bough
fi
)";

}  // namespace

std::string make_zsh_completion(const CLI::App& app) {
  // One list per group, which zsh shows below its heading.
  std::string groups;
  int number = 0;
  for (const auto& [heading, members] : list_command_groups(app)) {
    groups += "        verbs=(\n";
    for (const auto* verb : members)
      groups += fmt::format("          '{}:{}'\n", verb->get_name(), quote_zsh(shorten(verb->get_description())));
    groups += fmt::format("        )\n        _describe -t commands-{} '{}' verbs\n", ++number, quote_zsh(heading));
  }
  std::string options = fmt::format(
      "    '')\n      if [[ $words[CURRENT] = -* ]]; then\n        _arguments {}\n      else\n{}      fi ;;\n",
      write_zsh_options(app), groups);
  for (const auto* verb : app.get_subcommands(nullptr)) {
    options += fmt::format("    {}) _arguments {}'*:file:_files' ;;\n", verb->get_name(), write_zsh_options(*verb));
  }
  return fmt::format(kZsh, fmt::arg("options", options));
}

std::string make_fish_completion(const CLI::App& app) {
  std::string names, out = "# Completion of bough for fish, written by bough --fish-completion.\n";
  for (const auto* verb : app.get_subcommands(nullptr)) names += " " + verb->get_name();
  const auto none = "not __fish_seen_subcommand_from" + names;
  out += write_fish_options(app, none);
  for (const auto* verb : app.get_subcommands(nullptr)) {
    out += "complete -c bough -f -n " + quote_fish(none) + " -a " + verb->get_name() + " -d " +
           quote_fish(verb->get_group() + ": " + shorten(verb->get_description())) + "\n";
    out += write_fish_options(*verb, "__fish_seen_subcommand_from " + verb->get_name());
  }
  return out;
}

}  // namespace bough::cli
