#include "cli/studio/commands.hpp"

#include <algorithm>
#include <cctype>
#include <map>

#include "analysis/common/output_folder.hpp"
#include "base/diagnostic.hpp"
#include "cli/common/options.hpp"

namespace bough::cli {

namespace {

enum class Kind { Flag, Text, Path };
using Options = std::map<std::string, Kind>;

/// Commands without an entry cannot be started by the page.
const std::map<std::string, Options>& get_commands() {
  static const std::map<std::string, Options> commands{
      {"check", {{"--json", Kind::Flag}}},
      {"modes", {{"-o", Kind::Path}, {"-n", Kind::Text}, {"--ese", Kind::Flag}}},
      {"static", {{"-o", Kind::Path}}},
      {"reduce", {{"-o", Kind::Path}, {"--strain-energy", Kind::Flag}}},
      {"compare", {{"-o", Kind::Path}}},
      {"run", {{"-o", Kind::Path}, {"--set", Kind::Text}, {"--resume", Kind::Flag}}},
      {"equilibrium", {{"-o", Kind::Path}, {"--set", Kind::Text}}},
      {"linearize",
       {{"-o", Kind::Path},
        {"--set", Kind::Text},
        {"--at", Kind::Text},
        {"--equilibrium", Kind::Flag},
        {"--open", Kind::Flag},
        {"--sweep", Kind::Text}}},
      {"response", {{"-o", Kind::Path}}},
      {"report", {{"-o", Kind::Path}, {"--title", Kind::Text}}}};
  return commands;
}

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("studio.bad-request", {}, what, "reload the page");
}

/// The name as a command line takes it: a file "-x" would be an option.
std::string make_path(const std::string& name, const std::string& folder) {
  if (name.empty() || name.find('\0') != std::string::npos) refuse("the name of a file is empty or has a zero byte");
  if (!analysis::is_inside(name, folder))
    throw InputError("cli.outside-folder", {name}, "the file does not lie in " + folder + ", the folder of the studio",
                     "start bough studio in a folder that contains all files");
  return name.front() == '-' ? "./" + name : name;
}

}  // namespace

std::vector<std::string> make_command(const nlohmann::json& request, const std::string& folder) {
  const auto verb = request.at("verb").get<std::string>();
  const auto found = get_commands().find(verb);
  if (found == get_commands().end()) refuse("the page cannot run the command \"" + verb + "\"");
  std::vector<std::string> words{verb};
  for (const auto& file : request.at("files")) words.push_back(make_path(file.get<std::string>(), folder));
  for (const auto& entry : request.at("options")) {
    const auto name = entry.at(0).get<std::string>();
    const auto option = found->second.find(name);
    const bool has_value = entry.size() > 1;
    if (option == found->second.end() || has_value != (option->second != Kind::Flag))
      refuse("the page cannot give " + verb + " the option \"" + name + "\"");
    words.push_back(name);
    if (!has_value) continue;
    auto value = entry.at(1).get<std::string>();
    if (option->second == Kind::Path) {
      words.push_back(make_path(value, folder));
      continue;
    }
    if (value.empty() || value.find('\0') != std::string::npos) refuse("the value of " + name + " is empty");
    // One word with the value of a long option: a value never begins an option.
    if (name.starts_with("--"))
      words.back() += "=" + value;
    else if (value.find_first_not_of("0123456789") == std::string::npos)
      words.push_back(value);
    else
      refuse("the value of " + name + " is no whole number");
  }
  return words;
}

std::string quote_command(const std::vector<std::string>& words) {
  std::string line = "bough";
  for (const auto& word : words) {
    const bool is_plain = std::all_of(word.begin(), word.end(), [](unsigned char c) {
      return std::isalnum(c) != 0 || std::string("-_./=:,+@").find(static_cast<char>(c)) != std::string::npos;
    });
    line += ' ';
    if (is_plain && !word.empty()) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace bough::cli
