#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/json_rows.hpp"
#include "cli/compare/compare_report.hpp"

namespace bough::cli {

namespace {

using analysis::FrfReport;
using analysis::SensorReport;
using analysis::TestReport;
using Eigen::Index;

constexpr std::size_t kMaxRows = 12;
constexpr std::array<const char*, 6> kComponents{"x", "y", "z", "rx", "ry", "rz"};

std::string name_dof(const TestReport& r, std::size_t k) {
  return fmt::format("{}:{}", r.a.node_id[static_cast<std::size_t>(r.dofs[k].a)],
                     kComponents[static_cast<std::size_t>(r.dofs[k].component)]);
}

/// Largest entry of the row and the column of a pair, in modes that have a pair.
double calc_off_diagonal(const TestReport& r, const modal::ModePair& pair) {
  double largest = 0;
  for (const auto& other : r.pairs) {
    if (other.a == pair.a) continue;
    largest = std::max(
        {largest, std::abs(r.cross_orthogonality(pair.a, other.b)), std::abs(r.cross_orthogonality(other.a, pair.b))});
  }
  return largest;
}

}  // namespace

std::string format_report(const TestReport& r) {
  std::string text = fmt::format("A  {}: {} nodes, {} modes\ntest  {}: {} nodes, {} modes\n", r.file_a,
                                 r.a.node_id.size(), r.a.num_modes(), r.file_b, r.b.node_id.size(), r.b.num_modes());
  text += fmt::format("{} measured dofs at {} nodes in common; test-analysis model: {}\n", r.dofs.size(),
                      r.match.pairs.size(), r.kind);
  Table table{{"A", "Hz", "test", "Hz", "difference %", "MAC", "cross-orth.", "largest other", "MPC"}, {}};
  if (r.model_hz.size() > 0) table.headings.insert(table.headings.begin() + 2, "TAM Hz");
  std::size_t next = 0;
  for (int i = 0; i < r.a.num_modes(); ++i) {
    std::vector<std::string> row{std::to_string(i + 1), fmt::format("{:.6g}", r.a.frequency_hz[i])};
    if (r.model_hz.size() > 0) row.push_back(i < r.model_hz.size() ? fmt::format("{:.6g}", r.model_hz[i]) : "-");
    if (next < r.pairs.size() && r.pairs[next].a == i) {
      const auto& p = r.pairs[next++];
      const double hz = r.b.frequency_hz[p.b];
      for (auto& word : {std::to_string(p.b + 1), fmt::format("{:.6g}", hz),
                         hz != 0 ? fmt::format("{:+.3f}", 100 * (r.a.frequency_hz[i] / hz - 1)) : std::string("-"),
                         fmt::format("{:.4f}", p.mac), fmt::format("{:.4f}", std::abs(r.cross_orthogonality(p.a, p.b))),
                         fmt::format("{:.4f}", calc_off_diagonal(r, p)), fmt::format("{:.4f}", r.collinearity[p.b])})
        row.push_back(word);
    } else {
      row.emplace_back("-");
    }
    table.rows.push_back(std::move(row));
  }
  text += "\n" + table.to_text();
  for (int j = 0; j < r.b.num_modes(); ++j)
    if (std::none_of(r.pairs.begin(), r.pairs.end(), [j](const auto& p) { return p.b == j; }))
      text += fmt::format("test mode {} of {:.6g} Hz has no partner\n", j + 1, r.b.frequency_hz[j]);
  std::vector<std::size_t> order(r.dofs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return r.comac[static_cast<Index>(a)] < r.comac[static_cast<Index>(b)];
  });
  Table comac{{"lowest COMAC at", "COMAC"}, {}};
  for (std::size_t k = 0; k < std::min(kMaxRows, order.size()); ++k)
    comac.rows.push_back({name_dof(r, order[k]), fmt::format("{:.4f}", r.comac[static_cast<Index>(order[k])])});
  return text + "\n" + comac.to_text();
}

nlohmann::json make_json(const TestReport& r) {
  auto pairs = nlohmann::json::array(), dofs = pairs;
  for (const auto& p : r.pairs)
    pairs.push_back({{"a", p.a + 1},
                     {"test", p.b + 1},
                     {"frequency_hz", r.a.frequency_hz[p.a]},
                     {"test_hz", r.b.frequency_hz[p.b]},
                     {"mac", p.mac},
                     {"cross_orthogonality", r.cross_orthogonality(p.a, p.b)},
                     {"largest_other", calc_off_diagonal(r, p)},
                     {"phase_collinearity", r.collinearity[p.b]}});
  for (std::size_t k = 0; k < r.dofs.size(); ++k)
    dofs.push_back({{"name", name_dof(r, k)}, {"comac", r.comac[static_cast<Index>(k)]}});
  nlohmann::json json{{"a", r.file_a},
                      {"test", r.file_b},
                      {"tam", r.kind},
                      {"num_nodes", r.match.pairs.size()},
                      {"dofs", dofs},
                      {"mac", to_json(r.mac)},
                      {"cross_orthogonality", to_json(r.cross_orthogonality)},
                      {"self_orthogonality", to_json(r.self_orthogonality)},
                      {"pairs", pairs}};
  if (r.model_hz.size() > 0) json["model_hz"] = to_json_list(r.model_hz);
  return json;
}

std::string format_report(const FrfReport& r) {
  std::string text = fmt::format("A  {}: subcase {}\ntest  {}: {} functions, {} without a curve\n", r.file_a, r.subcase,
                                 r.file_b, r.pairs.size() + static_cast<std::size_t>(r.num_unmatched), r.num_unmatched);
  Table table{{"curve", "FRAC", "level, dB", "peak Hz", "test peak Hz", "points"}, {}};
  for (const auto& p : r.pairs)
    table.rows.push_back({p.name, fmt::format("{:.4f}", p.frac), fmt::format("{:+.2f}", p.level_db),
                          fmt::format("{:.6g}", p.peak_hz), fmt::format("{:.6g}", p.test_peak_hz),
                          std::to_string(p.num_points)});
  return text + "\n" + table.to_text() + fmt::format("FRAC of all functions: {:.4f}\n", r.frac);
}

nlohmann::json make_json(const FrfReport& r) {
  using Pair = analysis::FrfPair;
  const auto functions =
      make_rows(r.pairs, "curve", &Pair::name, "test", &Pair::test, "reference", &Pair::reference,
                "reference_direction", &Pair::reference_direction, "frac", &Pair::frac, "level_db", &Pair::level_db,
                "peak_hz", &Pair::peak_hz, "test_peak_hz", &Pair::test_peak_hz, "num_points", &Pair::num_points);
  return {{"a", r.file_a},
          {"test", r.file_b},
          {"subcase", r.subcase},
          {"frac", r.frac},
          {"unmatched", r.num_unmatched},
          {"functions", functions}};
}

std::string format_report(const SensorReport& r) {
  std::string text =
      fmt::format("{}: {} modes, {} translations that move\n", r.file, r.model.num_modes(), r.num_candidates);
  Table table{{"sensor", "node", "component", "independence"}, {}};
  for (std::size_t k = 0; k < r.dofs.size(); ++k)
    table.rows.push_back({std::to_string(k + 1), std::to_string(r.dofs[k].first),
                          kComponents[static_cast<std::size_t>(r.dofs[k].second - 1)],
                          fmt::format("{:.4f}", r.independence[static_cast<Index>(k)])});
  double largest = 0;
  for (Index i = 0; i < r.mac.rows(); ++i)
    for (Index j = 0; j < i; ++j) largest = std::max(largest, r.mac(i, j));
  return text + "\n" + table.to_text() + fmt::format("largest MAC of two modes at these dofs: {:.4f}\n", largest);
}

nlohmann::json make_json(const SensorReport& r) {
  auto sensors = nlohmann::json::array();
  for (std::size_t k = 0; k < r.dofs.size(); ++k)
    sensors.push_back({{"node", r.dofs[k].first},
                       {"component", r.dofs[k].second},
                       {"independence", r.independence[static_cast<Index>(k)]}});
  return {{"file", r.file}, {"num_candidates", r.num_candidates}, {"sensors", sensors}, {"mac", to_json(r.mac)}};
}

}  // namespace bough::cli
