#include "analysis/check/check_subcases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "analysis/check/subcase_models.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "fe/statics/static_case.hpp"

namespace bough::analysis {

namespace {

bool enforces(const records::Deck& deck, int set) {
  return set != 0 && std::any_of(deck.spc.begin(), deck.spc.end(), [](const auto& spc) { return spc.d != 0; });
}

}  // namespace

std::vector<SubcaseCheck> check_subcases(const records::Deck& deck, const fe::Model& model,
                                         const fe::ModelOptions& options, Diagnostics& diagnostics) {
  std::vector<SubcaseCheck> rows;
  for (const auto& s : deck.subcases)
    if (s.load != 0 || s.temperature != 0 || s.deform != 0 || enforces(deck, s.spc)) rows.push_back({s});
  if (rows.empty()) return rows;
  SubcaseFailures failures(rows.size(), deck.subcases.size());
  SubcaseModels models(deck, model, options);
  for (auto& row : rows) {
    Diagnostics found;
    try {
      const auto& held = models.get(row.subcase);
      const auto load = fe::calc_static_load(held, deck, row.subcase, found);
      found.throw_if_errors();
      row.resultant = fe::calc_resultant(held, load.F);
      row.num_enforced = static_cast<int>((load.d.array() != 0).count());
      row.num_heated = static_cast<int>(load.initial.of.size());
      row.is_resolved = true;
      if (load.F.isZero(0) && row.num_enforced == 0 && row.num_heated == 0)
        diagnostics.warning("cli.empty-load", deck.locate(row.subcase.find_command("LOAD")),
                            fmt::format("subcase {}: its loads and temperatures apply nothing", row.subcase.id),
                            "look at the factors of LOAD, at zero loads, and at grids that the loads miss");
      add_new(found, diagnostics);
    } catch (const Failure& failure) {
      failures.add(row.subcase.id, failure);
    }
  }
  // Loads are of no use to the modes of a deck: there it runs without them.
  static const std::set<std::string> with_statics{"",   "101", "SESTATIC", "SESTATICS", "STATICS",  "1",     "2",
                                                  "24", "105", "5",        "SEBUCKL",   "BUCKLING", "STATIC"};
  const bool is_static = with_statics.count(deck.sol) > 0;
  for (auto item : failures.get_items(diagnostics)) {
    if (!is_static && item.severity == Severity::Error) item.severity = Severity::Warning;
    diagnostics.add(std::move(item));
  }
  return rows;
}

}  // namespace bough::analysis
