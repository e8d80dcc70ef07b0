#include "report/table_chapters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "report/html.hpp"
#include "report/modal_chapter.hpp"

namespace bough::report {

namespace {

/// Columns of the arrays that `compare` writes, by the end of the path.
std::vector<std::string> name_columns(const std::string& path, Eigen::Index count) {
  if (path == "/pairs") return {"mode of A", "mode of B", "frequency A", "frequency B", "MAC", "in span"};
  if (path == "/stiffness/values") return {"norm in A", "norm in B", "relative difference"};
  if (path == "/refinement/values") return {"mode", "coarse", "middle", "fine", "order", "extrapolated"};
  if (path.starts_with("/integrals/") && (path.ends_with("/difference") || path.ends_with("/norm")))
    return {"Γ0", "Γ1", "Γ2", "Γ3", "Γ4"};
  if (path.ends_with("/captured")) return {"m x", "m y", "m z", "Jxx", "Jyy", "Jzz"};
  if (path == "/nodes") return {"A", "B"};
  std::vector<std::string> names;
  for (Eigen::Index i = 1; i <= count; ++i) names.push_back(std::to_string(i));
  return names;
}

std::string make_array_table(const records::ComparisonArray& array, const std::vector<std::string>* words) {
  std::vector<HtmlTable::Column> columns{{words ? "" : "row", words != nullptr}};
  for (auto& name : name_columns(array.path, array.values.cols())) columns.push_back({name});
  HtmlTable table(array.description, columns);
  for (Eigen::Index i = 0; i < array.values.rows(); ++i) {
    std::vector<std::string> row{words && static_cast<std::size_t>(i) < words->size()
                                     ? (*words)[static_cast<std::size_t>(i)]
                                     : std::to_string(i + 1)};
    for (Eigen::Index j = 0; j < array.values.cols(); ++j) row.push_back(format_value(array.values(i, j)));
    if (row.size() == columns.size()) table.add_row(std::move(row));
  }
  return table.to_html(300);
}

/// With what the frequencies differ by.
std::string make_pairs_table(const records::ComparisonArray& array) {
  if (array.values.cols() != 6) return make_array_table(array, nullptr);
  HtmlTable table(
      array.description,
      {{"mode of A"}, {"of B"}, {"frequency A"}, {"frequency B"}, {"B less A, %"}, {"MAC"}, {"in the span of B"}});
  for (const auto& row : array.values.rowwise()) {
    const double difference = row(2) != 0 ? 100 * (row(3) / row(2) - 1) : std::nan("");
    table.add_row({format_value(row(0)), format_value(row(1)), format_value(row(2)), format_value(row(3)),
                   format_value(difference, 4), format_value(row(4)), format_value(row(5))});
  }
  return table.to_html(300);
}

std::string name_files(const records::Comparison& comparison) {
  if (comparison.source.size() < 2) return {};
  return make_text("A is " + comparison.source[0].first + ", B is " + comparison.source[1].first + ".", "note");
}

double take_percentile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

std::string make_percentiles(const CampaignTable& table) {
  HtmlTable html(
      "Over the cases that have a number",
      {{"column", true}, {"cases"}, {"min"}, {"5 %"}, {"median"}, {"95 %"}, {"max"}, {"mean"}, {"std. dev."}});
  for (const auto& column : table.columns) {
    if (!column.words.empty() || column.name == "case" || column.name == "exit_code") continue;
    std::vector<double> values;
    std::copy_if(column.numbers.begin(), column.numbers.end(), std::back_inserter(values),
                 [](double v) { return std::isfinite(v); });
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    const double n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double square = 0;
    for (const double v : values) square += (v - mean) * (v - mean);
    html.add_row({column.name, std::to_string(values.size()), format_value(values.front()),
                  format_value(take_percentile(values, 0.05)), format_value(take_percentile(values, 0.5)),
                  format_value(take_percentile(values, 0.95)), format_value(values.back()), format_value(mean),
                  format_value(values.size() > 1 ? std::sqrt(square / (n - 1)) : std::nan(""))});
  }
  return html.empty() ? "" : html.to_html();
}

}  // namespace

Chapter make_chapter(const records::Comparison& comparison, const std::string& file, const Facts& facts) {
  Chapter chapter{"comparison", file, facts, {}, {}, {}, {}};
  const auto find_words = [&](const std::string& path) -> const std::vector<std::string>* {
    for (const auto& [name, list] : comparison.words)
      if (path.substr(0, path.rfind('/')) == name.substr(0, name.rfind('/'))) return &list;
    return nullptr;
  };
  std::string rest;
  for (const auto& array : comparison.arrays) {
    if (array.path == "/mac" || array.path == "/mass_mac")
      chapter.add_panel(array.path.substr(1), array.path == "/mac" ? "MAC" : "MAC weighted with the mass",
                        draw_heat_map(array.description, array.values, "mode of A", "mode of B"));
    else if (array.path == "/pairs") {
      double min_mac = 1;
      for (Eigen::Index i = 0; i < array.values.rows(); ++i) min_mac = std::min(min_mac, array.values(i, 4));
      chapter.checks.push_back({"least MAC of a pair", format_value(min_mac, 4),
                                min_mac < 0.9 ? Verdict::Warning : Verdict::Good,
                                fmt::format("{} pairs; below 0.9 look at the share in the span", array.values.rows())});
      chapter.add_panel("pairs", "Pairs of modes", name_files(comparison) + make_pairs_table(array));
    } else if (array.path == "/refinement/values") {
      chapter.add_panel("refinement", "Refinement", make_array_table(array, find_words(array.path)));
    } else if (array.path.starts_with("/integrals/")) {
      const auto method = array.path.substr(11, array.path.rfind('/') - 11);
      rest += make_array_table({array.path, array.values, method + ": " + array.description, array.dims}, nullptr);
    } else if (array.path == "/stiffness/values") {
      chapter.add_panel("stiffness", "Geometric stiffness", make_array_table(array, find_words(array.path)));
    } else if (array.path == "/offset") {
      const std::vector<std::string> axes{"x", "y", "z"};
      rest += make_array_table(array, &axes);
    } else if (array.path != "/nodes") {
      rest += make_array_table(array, nullptr);
    }
  }
  if (!rest.empty()) chapter.add_panel("numbers", "Mass integrals and other numbers", rest);
  return chapter;
}

Chapter make_chapter(const CampaignTable& table) {
  Chapter chapter{"campaign", table.file, table.facts, {}, {}, {}, {}};
  std::vector<HtmlTable::Column> columns;
  std::size_t rows = 0;
  int failed = 0;
  for (const auto& column : table.columns) {
    columns.push_back({column.name, !column.words.empty()});
    rows = std::max(rows, std::max(column.numbers.size(), column.words.size()));
    if (column.name == "exit_code")
      failed = static_cast<int>(
          std::count_if(column.numbers.begin(), column.numbers.end(), [](double v) { return v != 0; }));
  }
  HtmlTable cases("", columns);
  for (std::size_t i = 0; i < rows; ++i) {
    std::vector<std::string> row;
    for (const auto& column : table.columns)
      row.push_back(i < column.words.size()     ? column.words[i]
                    : i < column.numbers.size() ? format_value(column.numbers[i])
                                                : "");
    cases.add_row(std::move(row));
  }
  chapter.checks.push_back(
      {"cases that failed", fmt::format("{} of {}", failed, rows), failed > 0 ? Verdict::Bad : Verdict::Good, ""});
  chapter.add_panel("scatter", "One column against another",
                    make_place("scatter", "The picture is drawn by a script; this reader runs none."));
  if (const auto percentiles = make_percentiles(table); !percentiles.empty())
    chapter.add_panel("percentiles", "Percentiles", percentiles);
  chapter.add_panel("cases", "Cases", cases.to_html(1000));
  auto list = nlohmann::json::array();
  for (const auto& column : table.columns) {
    if (!column.words.empty()) continue;
    auto numbers = nlohmann::json::array();
    for (const double v : column.numbers) numbers.push_back(std::isfinite(v) ? nlohmann::json(v) : nlohmann::json());
    list.push_back({{"name", column.name}, {"numbers", numbers}, {"output", column.is_output}});
  }
  chapter.data = nlohmann::json{{"columns", list}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return chapter;
}

Chapter make_chapter(const std::vector<SelectedMode>& modes, double total_cost, const std::string& file) {
  Chapter chapter{"selection", file, {{"total cost", format_value(total_cost)}}, {}, {}, {}, {}};
  const bool is_system = !modes.empty() && !modes.front().body.empty();
  std::vector<HtmlTable::Column> columns{{"mode"},    {"frequency [Hz]"}, {"cost"},
                                         {"share %"}, {"kept", true},     {"reason", true}};
  if (is_system) columns.insert(columns.begin(), {"body", true});
  HtmlTable table("Modes by component cost", columns);
  double dropped = 0;
  for (const auto& m : modes) {
    std::vector<std::string> row{std::to_string(m.mode),  format_value(m.frequency_hz), format_value(m.cost),
                                 format_percent(m.share), m.kept ? "yes" : "no",        m.reason};
    if (is_system) row.insert(row.begin(), m.body);
    table.add_row(row);
    if (!m.kept) dropped += m.share;
  }
  chapter.checks.push_back({"cost of the modes that go", format_percent(dropped) + " %", Verdict::None, ""});
  chapter.add_panel("modes", "Modes", table.to_html());
  return chapter;
}

}  // namespace bough::report
