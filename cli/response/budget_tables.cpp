#include "cli/response/budget_tables.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/common/console.hpp"

namespace bough::cli {

namespace {

using Eigen::Index;
constexpr double kToRpm = 60 / (2 * std::numbers::pi);

std::vector<double> to_list(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

bool is_wheel(const records::PointingBudget& budget, std::size_t source) { return budget.speed[source].size() > 0; }

}  // namespace

std::string format_budget(const records::PointingBudget& budget) {
  std::string text;
  if (budget.to_hz > 0)
    text += fmt::format("spectral densities from {:.4g} to {:.4g} Hz\n", budget.from_hz, budget.to_hz);
  for (const auto& table : budget.tables) {
    text += table.exposure > 0 ? fmt::format("\n{} RMS, exposure {:.6g}\n", table.weighting, table.exposure)
                               : std::string("\ntotal RMS\n");
    Table lines{{"source"}, {}};
    lines.headings.insert(lines.headings.end(), budget.outputs.name.begin(), budget.outputs.name.end());
    const auto add = [&](const std::string& name, const Eigen::RowVectorXd& values) {
      std::vector<std::string> line{name};
      for (const double value : values) line.push_back(fmt::format("{:.6g}", value));
      lines.rows.push_back(std::move(line));
    };
    for (std::size_t s = 0; s < budget.sources.size(); ++s) {
      add(budget.sources[s], table.rms.row(static_cast<Index>(s)));
      if (is_wheel(budget, s)) add(budget.sources[s] + ", at rpm", kToRpm * table.speed.row(static_cast<Index>(s)));
    }
    add("root of the sum of squares", table.total.transpose());
    text += lines.to_text();
  }
  return text;
}

nlohmann::json make_budget_json(const records::PointingBudget& budget) {
  nlohmann::json json{{"outputs", budget.outputs.name}, {"sources", budget.sources}};
  if (budget.to_hz > 0) json["from_hz"] = budget.from_hz, json["to_hz"] = budget.to_hz;
  auto tables = nlohmann::json::array();
  for (const auto& table : budget.tables) {
    nlohmann::json one{{"weighting", table.weighting}, {"total", to_list(table.total)}};
    if (table.exposure > 0) one["exposure"] = table.exposure;
    for (std::size_t s = 0; s < budget.sources.size(); ++s) {
      nlohmann::json source{{"source", budget.sources[s]},
                            {"rms", to_list(table.rms.row(static_cast<Index>(s)).transpose())}};
      if (is_wheel(budget, s)) {
        source["worst_rpm"] = to_list(kToRpm * table.speed.row(static_cast<Index>(s)).transpose());
        source["rpm"] = to_list(kToRpm * budget.speed[s]);
        for (Index i = 0; i < table.rms.cols(); ++i)
          source["over_speed"].push_back(to_list(table.over_speed[s].col(i)));
      }
      one["rows"].push_back(std::move(source));
    }
    tables.push_back(std::move(one));
  }
  json["tables"] = std::move(tables);
  return json;
}

}  // namespace bough::cli
