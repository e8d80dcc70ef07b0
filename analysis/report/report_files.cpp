#include "analysis/report/report_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/export/export_matrices.hpp"
#include "base/file_roles.hpp"
#include "formats/hdf5/comparison_file.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/hdf5/table_file.hpp"
#include "report/html.hpp"
#include "report/linear_chapter.hpp"
#include "report/static_chapter.hpp"
#include "report/table_chapters.hpp"

namespace bough::analysis {

namespace {

constexpr const char* kTakes =
    "give results, a flexible body, modes, a static solution, a response, a linear model, a sweep, a comparison, "
    "outcomes.h5, or the JSON of select";

report::Chapter make_selection_chapter(const std::string& file) {
  std::ifstream in(file);
  note_input(file);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  const auto fail = [&](const std::string& what) { return InputError("cli.no-report", {file}, what, kTakes); };
  if (!json.is_object() || !json.contains("modes") || !json.contains("total_cost"))
    throw fail("expected what `bough select --json` prints");
  std::vector<report::SelectedMode> modes;
  try {
    for (const auto& m : json.at("modes"))
      modes.push_back({m.at("mode").get<int>(), m.at("frequency_hz").get<double>(), m.at("cost").get<double>(),
                       m.at("share").get<double>(), m.at("kept").get<bool>(), m.at("reason").get<std::string>(),
                       m.value("body", std::string())});
    return report::make_chapter(modes, json.at("total_cost").get<double>(), file);
  } catch (const nlohmann::json::exception& error) {
    throw fail(std::string("not the list of modes that select prints: ") + error.what());
  }
}

report::Chapter make_campaign_chapter(const std::string& file) {
  auto outcomes = hdf5::read_outcomes(file);
  const auto get_rank = [](const hdf5::OutcomeColumn& column) {
    return column.path.starts_with("/parameters/") ? 0 : column.path.starts_with("/outputs/") ? 1 : 2;
  };
  std::stable_sort(outcomes.columns.begin(), outcomes.columns.end(),
                   [&](const auto& a, const auto& b) { return get_rank(a) < get_rank(b); });
  report::CampaignTable table{file, list_facts(file), {}};
  table.columns.push_back({"case", {outcomes.cases.begin(), outcomes.cases.end()}, {}, false});
  for (const auto& column : outcomes.columns) {
    const auto name = column.path.substr(column.path.rfind('/') + 1);
    const bool is_output = column.path.starts_with("/outputs/");
    if (column.numbers.size() == 0) {
      table.columns.push_back({name, {}, column.words, is_output});
      continue;
    }
    for (Eigen::Index c = 0; c < column.numbers.cols(); ++c) {
      const Eigen::VectorXd values = column.numbers.col(c);
      const auto count = column.numbers.cols() > 1 ? "." + std::to_string(c + 1) : "";
      table.columns.push_back({name + count, {values.begin(), values.end()}, {}, is_output});
    }
  }
  return report::make_chapter(table);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> list_facts(const std::string& file) {
  if (is_flat(file)) return {{"file", file}, {"format", "flat"}};
  if (is_flx(file)) return {{"file", file}, {"format", ".FLX"}};
  const auto info = hdf5::read_info(file);
  std::vector<std::pair<std::string, std::string>> facts{{"file", file}};
  const auto add = [&](const char* attribute, const char* name) {
    const auto found = info.attributes.find(attribute);
    if (found != info.attributes.end() && !found->second.empty()) facts.emplace_back(name, found->second);
  };
  add("name", "name");
  add("campaign", "campaign");
  add("bough_version", "written by Bough");
  add("format_version", "version of the format");
  add("subcase", "subcase");
  add("frame", "frame");
  if (const auto found = info.attributes.find("wall_time"); found != info.attributes.end())
    facts.emplace_back("wall time, s", report::format_value(std::strtod(found->second.c_str(), nullptr), 3));
  add("fingerprint", "SHA-256 of all inputs");
  // Names and hashes in turn; a name may hold a comma itself.
  const auto source = info.attributes.find("source");
  if (source == info.attributes.end()) return facts;
  std::string name;
  for (std::size_t from = 0; from <= source->second.size();) {
    const auto to = std::min(source->second.find(", ", from), source->second.size());
    const std::string word = source->second.substr(from, to - from);
    from = to + 2;
    if (word.size() == 64 && word.find_first_not_of("0123456789abcdef") == std::string::npos && !name.empty()) {
      facts.emplace_back("made from " + name, "SHA-256 " + word);
      name.clear();
    } else {
      name += (name.empty() ? "" : ", ") + word;
    }
  }
  return facts;
}

std::vector<std::pair<std::string, std::string>> list_settings(const std::string& file) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const auto& object : hdf5::read_info(file).objects) {
    if (!object.path.starts_with("/settings@")) continue;
    char* end = nullptr;
    const double number = std::strtod(object.description.c_str(), &end);
    const bool is_number = !object.description.empty() && *end == '\0';
    settings.emplace_back(object.path.substr(10), is_number ? fmt::format("{:.12g}", number) : object.description);
  }
  return settings;
}

report::Chapter make_chapter(const std::string& file, const ReportRequest& request, Diagnostics& diagnostics) {
  if (has_suffix(file, ".json")) return make_selection_chapter(file);
  const auto format = read_file_format(file);
  if (format == "bough-results") return make_results_chapter(file, request, diagnostics);
  if (format == "bough-flexbody") return make_body_chapter(file, diagnostics);
  if (format == "bough-modes") return make_modes_chapter(file);
  if (format == "bough-complex-modes") return make_complex_chapter(file);
  if (format == "bough-frequency" || format == "bough-transient") return make_response_chapter(file);
  if (format == "bough-linear") return make_linear_chapter(file);
  if (format == "bough-response") return make_model_response_chapter(file);
  if (format == "bough-budget") return report::make_chapter(hdf5::read_budget(file), file, list_facts(file));
  if (format == "bough-sweep") return make_sweep_chapter(file);
  if (format == "bough-static") return report::make_chapter(hdf5::read_static(file), file, list_facts(file));
  if (format == "bough-comparison") return report::make_chapter(hdf5::read_comparison(file), file, list_facts(file));
  if (format == "bough-outcomes") return make_campaign_chapter(file);
  throw InputError("cli.no-report", {file}, "no page can be made of a file of format \"" + format + "\"", kTakes);
}

}  // namespace bough::analysis
