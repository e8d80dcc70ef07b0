#include "analysis/campaign/batch_steps.hpp"

#include <algorithm>
#include <filesystem>

#include "analysis/common/inputs.hpp"
#include "formats/toml/specs.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;
using toml_files::CampaignSpec;

namespace {

/// The value of -o, --output of a command; empty when it has none.
std::string find_option(const std::vector<std::string>& words, const std::vector<std::string>& names) {
  for (std::size_t i = 1; i < words.size(); ++i)
    for (const auto& name : names) {
      if (words[i] == name && i + 1 < words.size()) return words[i + 1];
      if (words[i].rfind(name + "=", 0) == 0) return words[i].substr(name.size() + 1);
    }
  return {};
}

}  // namespace

bool is_input_word(const std::vector<std::string>& words, std::size_t i) {
  return i > 0 && words[i].rfind('-', 0) != 0 && (i == 1 || words[i - 1].rfind('-', 0) != 0);
}

std::string make_absolute(const std::string& folder, const std::string& path) {
  return (fs::path(folder) / path).lexically_normal().string();
}

void check_steps(const CampaignSpec& spec, const std::vector<std::string>& verbs, Diagnostics& diagnostics) {
  std::vector<std::string> names{"case"};
  for (const auto& p : spec.parameters) names.push_back(p.name);
  for (const auto& step : spec.steps) {
    const auto& verb = step.words.front();
    if (std::find(verbs.begin(), verbs.end(), verb) == verbs.end() || verb == "batch") {
      const auto nearest = find_nearest(verb, verbs);
      diagnostics.error(
          "batch.bad-step", step.at, "'" + verb + "' is no command for a step",
          nearest.empty() || verb == "batch" ? "bough --help lists the commands" : "did you mean " + nearest);
    }
    for (const auto& word : step.words)
      for (auto open = word.find('{'); open != std::string::npos; open = word.find('{', open + 1)) {
        const auto close = word.find('}', open);
        const auto name = word.substr(open + 1, close == std::string::npos ? close : close - open - 1);
        if (close != std::string::npos && std::find(names.begin(), names.end(), name) != names.end()) continue;
        const auto nearest = find_nearest(name, names);
        diagnostics.error("batch.bad-step", step.at, "{" + name + "} is no parameter",
                          nearest.empty() ? "add it as [[parameter]]" : "did you mean {" + nearest + "}");
      }
  }
}

void warn_of_unused(const CampaignSpec& spec, Diagnostics& diagnostics) {
  for (const auto& p : spec.parameters) {
    const bool is_column = p.at.file == spec.table;  // a column of the table of cases may be a description
    const auto names_it = [&](const std::string& word) { return word.find("{" + p.name + "}") != std::string::npos; };
    if (!p.file.empty() || is_column || std::any_of(spec.steps.begin(), spec.steps.end(), [&](const auto& step) {
          return std::any_of(step.words.begin(), step.words.end(), names_it);
        }))
      continue;
    diagnostics.warning(
        "batch.unused-parameter", p.at,
        "parameter '" + p.name + "' changes no file and no step names it: the cases do not depend on it",
        "put {" + p.name + "} into a step, or give file with card or key");
  }
}

void check_places(const CampaignSpec& spec, Diagnostics& diagnostics) {
  for (const auto& step : spec.steps)
    for (const auto* option : {"-o", "--output", "--vtu", "--fi"}) {
      const auto path = fs::path(find_option(step.words, {option})).lexically_normal();
      if (path.is_absolute() || (!path.empty() && *path.begin() == ".."))
        diagnostics.error("cli.output-outside", step.at,
                          std::string(option) + " " + path.string() + " does not lie in the folder of the case",
                          "let the steps write there, or give --force-outside");
    }
}

std::vector<std::string> find_outputs(const CampaignSpec& spec, const std::string& folder) {
  std::vector<std::string> outputs;
  for (const auto& step : spec.steps) {
    const auto& words = step.words;
    std::string output = find_option(words, {"-o", "--output"});
    const std::string input = words.size() > 1 ? words[1] : "";
    const auto stem = fs::path(input).stem().string();
    if (output.empty() && words[0] == "run") output = stem + ".h5";
    if (output.empty() && words[0] == "flx") output = stem + ".FLX";
    if (output.empty() && words[0] == "reduce") {
      auto name = find_option(words, {"--name"});
      if (const auto file = make_absolute(folder, input); has_suffix(file, ".toml") && fs::is_regular_file(file)) {
        Diagnostics ignored;
        const auto body = toml_files::read_body_spec(file, ignored);
        output = body.output_file;
        if (name.empty()) name = body.name;
      }
      if (output.empty()) output = (name.empty() ? stem : name) + ".h5";
    }
    if (!output.empty()) outputs.push_back(make_absolute(folder, output));
  }
  return outputs;
}

void fill_in(std::vector<std::string>& words, const CampaignSpec& spec, const BatchCase& one) {
  for (auto& word : words)
    for (std::size_t i = 0; i <= spec.parameters.size(); ++i) {
      const bool is_case = i == spec.parameters.size();
      const auto name = "{" + (is_case ? "case" : spec.parameters[i].name) + "}";
      const auto text = is_case ? std::to_string(one.number) : one.values[i].text;
      for (auto at = word.find(name); at != std::string::npos; at = word.find(name, at + text.size()))
        word.replace(at, name.size(), text);
    }
}

bool is_collected_as_json(const CampaignSpec& spec, std::size_t step) {
  return std::any_of(spec.collect.begin(), spec.collect.end(),
                     [&](const auto& c) { return !c.json.empty() && c.step == static_cast<int>(step) + 1; });
}

}  // namespace bough::analysis
