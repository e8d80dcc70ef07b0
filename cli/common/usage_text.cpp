#include "cli/common/usage_text.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/diagnostic.hpp"
#include "cli/common/console.hpp"

namespace bough::cli {

namespace {

CLI::Validator make_bound(const std::string& name, const std::string& expected, bool takes_zero) {
  const auto check = [expected, takes_zero](const std::string& text) {
    double value = 0;
    const bool is_number = CLI::detail::lexical_cast(text, value);
    return is_number && std::isfinite(value) && (value > 0 || (takes_zero && value == 0))
               ? std::string{}
               : "found " + text + ", expected " + expected;
  };
  return {check, name};
}

/// Unknown options, else surplus arguments.
std::vector<std::string> find_extras(const CLI::App& app) {
  std::vector<std::string> options, all = app.remaining(true);
  for (const auto& word : all)
    if (word.size() > 1 && word[0] == '-') options.push_back(word.substr(0, word.find('=')));
  return options.empty() ? all : options;
}

std::string find_nearest_option(const CLI::App& verb, const std::string& word) {
  std::vector<std::string> known;
  for (const auto* option : verb.get_options())
    for (const auto& name : option->get_lnames()) known.push_back("--" + name);
  return find_nearest(word, known);
}

class NarrowFormatter : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrap(CLI::Formatter::make_option_desc(option), 0, kWidth - column_width_);
  }
  std::string make_subcommand(const CLI::App* verb) const override {
    std::ostringstream out;
    CLI::detail::format_help(out, verb->get_display_name(true),
                             wrap(verb->get_description(), 0, kWidth - column_width_), column_width_);
    return out.str();
  }
  std::string make_description(const CLI::App* app) const override {
    return wrap(app->get_description(), 0, kWidth) + "\n";
  }
  std::string make_footer(const CLI::App* app) const override {
    std::istringstream in(app->get_footer());
    std::string out, line;
    while (std::getline(in, line)) out += (line.starts_with("  ") ? line : wrap(line, 0, kWidth)) + "\n";
    return out;
  }

 private:
  static constexpr std::size_t kWidth = 80;
};

}  // namespace

std::pair<std::string, std::string> describe_parse_error(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const CLI::App& verb = chosen.empty() ? app : *chosen.front();
  const std::string help = "see bough " + (chosen.empty() ? "" : verb.get_name() + " ") + "--help";
  const auto extras = find_extras(app);
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || extras.empty()) return {error.what(), help};
  std::string what, advice;
  for (const auto& word : extras) {
    const bool is_option = word.size() > 1 && word[0] == '-';
    what += (what.empty() ? "" : ", ") + std::string(is_option ? "unknown option " : "unexpected argument ") + word;
    if (const auto near = is_option ? find_nearest_option(verb, word) : ""; !near.empty())
      advice += "did you mean " + near + "; ";
  }
  return {what, advice + help};
}

std::shared_ptr<CLI::Formatter> make_formatter() { return std::make_shared<NarrowFormatter>(); }

std::string list_choices(const CLI::Option& option) {
  const auto type = option.get_type_name();
  const auto open = type.find('{'), close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  auto words = type.substr(open + 1, close - open - 1);
  std::replace(words.begin(), words.end(), ',', ' ');
  return words;
}

CLI::Validator make_positive() { return make_bound("POSITIVE", "a number above 0", false); }
CLI::Validator make_not_negative() { return make_bound("NONNEGATIVE", "0 or a number above it", true); }
CLI::Validator make_finite() {
  return {[](const std::string& text) {
            double value = 0;
            const bool is_number = CLI::detail::lexical_cast(text, value);
            return is_number && std::isfinite(value) ? std::string{} : "found " + text + ", expected a finite number";
          },
          ""};
}

}  // namespace bough::cli
