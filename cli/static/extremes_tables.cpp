#include "cli/static/extremes_tables.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/common/console.hpp"

namespace bough::cli {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::array<const char*, 3> kKinds{"tension", "compression", "shear"};

/// The least (sign 1) or the largest (-1) of a column.
struct Extreme {
  double value = 0;
  int id = 0, subcase = 0;
};
Extreme find_extreme(const MatrixXd& values, const Eigen::MatrixXi& cases, const std::vector<int>& id, Index column,
                     bool is_largest) {
  Index row = 0;
  const double value = is_largest ? values.col(column).maxCoeff(&row) : values.col(column).minCoeff(&row);
  return {value, id[static_cast<std::size_t>(row)], cases(row, column)};
}

/// The smallest margin of each kind: element and value; none without a number.
struct Smallest {
  std::string card, kind;
  double margin = 0;
  int id = 0;
};
std::vector<Smallest> list_smallest(const std::vector<records::StressMargins>& margins) {
  std::vector<Smallest> list;
  for (const auto& block : margins)
    for (Index k = 0; k < 3; ++k) {
      Index at = -1;
      for (Index r = 0; r < block.margin.rows(); ++r)
        if (std::isfinite(block.margin(r, k)) && (at < 0 || block.margin(r, k) < block.margin(at, k))) at = r;
      if (at >= 0)
        list.push_back({block.card, kKinds[static_cast<std::size_t>(k)], block.margin(at, k),
                        block.id[static_cast<std::size_t>(at)]});
    }
  return list;
}

}  // namespace

std::string format_margins(const std::vector<records::StressMargins>& margins) {
  const auto smallest = list_smallest(margins);
  if (smallest.empty()) return {};
  Table table{{"margin of safety", "of", "smallest", "element"}, {}};
  for (const auto& one : smallest)
    table.rows.push_back({one.card, one.kind, fmt::format("{:.6e}", one.margin), std::to_string(one.id)});
  return table.to_text() + "\n";
}

nlohmann::json to_json(const std::vector<records::StressMargins>& margins) {
  auto list = nlohmann::json::array();
  for (const auto& one : list_smallest(margins))
    list.push_back({{"card", one.card}, {"of", one.kind}, {"margin", one.margin}, {"element", one.id}});
  return list;
}

std::string format_case_extremes(const std::vector<records::CaseExtremes>& extremes) {
  std::string text;
  for (const auto& block : extremes) {
    Table table{{"over subcases: " + block.path, "smallest", "id", "subcase", "largest", "id", "subcase"}, {}};
    for (std::size_t c = 0; c < block.components.size(); ++c) {
      const auto column = static_cast<Index>(c);
      const auto low = find_extreme(block.low, block.low_case, block.id, column, false);
      const auto high = find_extreme(block.high, block.high_case, block.id, column, true);
      table.rows.push_back({block.components[c], fmt::format("{:.6e}", low.value), std::to_string(low.id),
                            std::to_string(low.subcase), fmt::format("{:.6e}", high.value), std::to_string(high.id),
                            std::to_string(high.subcase)});
    }
    text += table.to_text() + "\n";
  }
  return text;
}

nlohmann::json to_json(const std::vector<records::CaseExtremes>& extremes) {
  auto json = nlohmann::json::object();
  const auto to_object = [](const Extreme& e) {
    return nlohmann::json{{"value", e.value}, {"id", e.id}, {"subcase", e.subcase}};
  };
  for (const auto& block : extremes)
    for (std::size_t c = 0; c < block.components.size(); ++c) {
      const auto column = static_cast<Index>(c);
      json[block.path][block.components[c]] = {
          {"min", to_object(find_extreme(block.low, block.low_case, block.id, column, false))},
          {"max", to_object(find_extreme(block.high, block.high_case, block.id, column, true))}};
    }
  return json;
}

}  // namespace bough::cli
