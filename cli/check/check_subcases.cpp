#include "cli/check/check_subcases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "analysis/common/subcase_failures.hpp"
#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"

namespace bough::cli {

namespace {

constexpr std::size_t kMaxRows = 20;

struct Row {
  records::Subcase subcase;
  Eigen::Matrix<double, 6, 1> resultant = Eigen::Matrix<double, 6, 1>::Zero();
  int num_enforced = 0, num_heated = 0;
  bool is_resolved = false;
};

bool enforces(const records::Deck& deck, int set) {
  return set != 0 && std::any_of(deck.spc.begin(), deck.spc.end(), [](const auto& spc) { return spc.d != 0; });
}

std::string format_rows(const std::vector<Row>& rows) {
  Table table{{"subcase", "LOAD", "TEMP", "SPC", "MPC", "Fx", "Fy", "Fz", "Mx", "My", "Mz", "enforced", "heated"}, {}};
  const auto name = [](int set) { return set ? std::to_string(set) : std::string("-"); };
  for (std::size_t i = 0; i < std::min(rows.size(), kMaxRows); ++i) {
    const auto& row = rows[i];
    const auto& s = row.subcase;
    std::vector<std::string> cells{std::to_string(s.id), name(s.load), name(s.temperature), name(s.spc), name(s.mpc)};
    for (const double f : row.resultant) cells.push_back(row.is_resolved ? fmt::format("{:.5g}", f + 0.0) : "?");
    cells.push_back(row.is_resolved ? std::to_string(row.num_enforced) : "?");
    cells.push_back(row.is_resolved ? std::to_string(row.num_heated) : "?");
    table.rows.push_back(std::move(cells));
  }
  const auto rest = rows.size() - std::min(rows.size(), kMaxRows);
  return "loads of the subcases about the origin\n" + table.to_text() +
         (rest ? fmt::format("... and {} more\n", count(rest, "subcase")) : "");
}

}  // namespace

void check_subcases(const records::Deck& deck, const fe::Model& model, const fe::ModelOptions& options,
                    std::string& text, nlohmann::json& json, Diagnostics& diagnostics) {
  std::vector<Row> rows;
  for (const auto& s : deck.subcases)
    if (s.load != 0 || s.temperature != 0 || s.deform != 0 || enforces(deck, s.spc)) rows.push_back({s});
  json["subcases"] = nlohmann::json::array();
  if (rows.empty()) return;
  analysis::SubcaseFailures failures(rows.size(), deck.subcases.size());
  const auto get_held = [](const records::Subcase& s) { return std::array<int, 3>{s.spc, s.mpc, s.suport1}; };
  std::optional<fe::Model> own;
  const fe::Model* current = &model;
  for (auto& row : rows) {
    Diagnostics found;
    try {
      if (get_held(row.subcase) != get_held(current->subcase())) {
        auto own_options = options;
        own_options.subcase = row.subcase.id;
        Diagnostics of_model;
        own.emplace(fe::build_model(deck, own_options, of_model));
        current = &*own;
      }
      const auto load = fe::calc_static_load(*current, deck, row.subcase, found);
      found.throw_if_errors();
      row.resultant = fe::calc_resultant(*current, load.F);
      row.num_enforced = static_cast<int>((load.d.array() != 0).count());
      row.num_heated = static_cast<int>(load.initial.of.size());
      row.is_resolved = true;
      if (load.F.isZero(0) && row.num_enforced == 0 && row.num_heated == 0)
        diagnostics.warning("cli.empty-load", deck.locate(row.subcase.find_command("LOAD")),
                            fmt::format("subcase {}: its loads and temperatures apply nothing", row.subcase.id),
                            "look at the factors of LOAD, at zero loads, and at grids that the loads miss");
      analysis::add_new(found, diagnostics);
    } catch (const Failure& failure) {
      current = own ? &*own : &model;
      failures.add(row.subcase.id, failure);
    }
    auto cell = nlohmann::json{
        {"id", row.subcase.id},       {"load_set", row.subcase.load}, {"temperature_set", row.subcase.temperature},
        {"spc_set", row.subcase.spc}, {"mpc_set", row.subcase.mpc},   {"resolved", row.is_resolved}};
    if (row.is_resolved) {
      cell["resultant"] = to_json_list(row.resultant);
      cell["num_enforced"] = row.num_enforced;
      cell["num_heated"] = row.num_heated;
    }
    json["subcases"].push_back(std::move(cell));
  }
  // Loads are of no use to the modes of a deck: there it runs without them.
  static const std::set<std::string> with_statics{"",   "101", "SESTATIC", "SESTATICS", "STATICS",  "1",     "2",
                                                  "24", "105", "5",        "SEBUCKL",   "BUCKLING", "STATIC"};
  const bool is_static = with_statics.count(deck.sol) > 0;
  for (auto item : failures.get_items(diagnostics)) {
    if (!is_static && item.severity == Severity::Error) item.severity = Severity::Warning;
    diagnostics.add(std::move(item));
  }
  text += "\n" + format_rows(rows);
}

}  // namespace bough::cli
