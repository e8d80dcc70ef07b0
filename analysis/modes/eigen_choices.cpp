#include "analysis/modes/eigen_choices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "analysis/common/choices.hpp"
#include "formats/records/selection.hpp"

namespace bough::analysis {
namespace {

/// The card that METHOD = `method` selects, the first of the deck where it selects none; null: there is none.
const records::EigenMethod* find_method(const records::Deck& deck, int method) {
  const auto& cards = deck.eigen_methods;
  const auto card =
      std::find_if(cards.begin(), cards.end(), [&](const auto& c) { return method == 0 || c.sid == method; });
  return card == cards.end() ? nullptr : &*card;
}

}  // namespace

modal::EigenOptions choose_eigen_options(const EigenChoice& choice, const records::Deck& deck, int method,
                                         Diagnostics& diagnostics) {
  if (choice.min_hz) demand_finite("--min-hz", *choice.min_hz);
  if (choice.max_hz) demand_finite("--max-hz", *choice.max_hz);
  demand_range("--number", choice.number, 0, std::numeric_limits<int>::max());
  modal::EigenOptions eigen;
  const auto* card = find_method(deck, method);
  if (method != 0 && !card)
    diagnostics.warning("cli.no-method", deck.locate(records::find_selection(deck, "METHOD", method)),
                        fmt::format("METHOD = {} names no EIGRL or EIGR card of the deck", method),
                        "add the card or correct the id; --number, --min-hz and --max-hz take precedence");
  eigen.num_modes = 0;
  eigen.check_inertia = !choice.no_check;
  if (!choice.solver.empty()) eigen.solver = modal::find_eps_type(choice.solver);
  if (card) {
    eigen.num_modes = card->is_lowest_only && choice.max_hz ? 0 : card->num_modes;
    eigen.min_hz = card->f1;
    eigen.max_hz = card->f2;
    if (!choice.buckling && counts_whatever_range(*card)) eigen.min_hz = eigen.max_hz = std::nullopt;
  }
  if (choice.min_hz) eigen.min_hz = choice.min_hz;
  if (choice.max_hz) eigen.max_hz = choice.max_hz;
  if (eigen.min_hz && eigen.max_hz && *eigen.max_hz <= *eigen.min_hz)
    throw InputError("cli.bad-range", {}, fmt::format("the range from {} to {} is empty", *eigen.min_hz, *eigen.max_hz),
                     "give --max-hz above --min-hz; either may also come from the deck's EIGRL");
  if (choice.number > 0) eigen.num_modes = choice.number;
  if (eigen.num_modes == 0 && !eigen.max_hz) eigen.num_modes = 10;
  return eigen;
}

void note_method_number(const EigenChoice& choice, const records::Deck& deck, int method, int found,
                        Diagnostics& diagnostics) {
  const auto* card = find_method(deck, method);
  if (!choice.max_hz || choice.number > 0 || !card) return;
  if (card->num_modes == 0 || card->is_lowest_only || found < card->num_modes) return;
  diagnostics.note("cli.method-number", deck.locate(card->at),
                   fmt::format("{} {}: ND = {} bounds the range of --max-hz too; there may be more modes in it",
                               card->is_eigrl ? "EIGRL" : "EIGR", card->sid, card->num_modes),
                   "--number takes precedence");
}

bool counts_whatever_range(const records::EigenMethod& card) {
  static const std::set<std::string> by_transformation{"GIV", "MGIV", "HOU", "MHOU", "AGIV", "AHOU"};
  return !card.is_eigrl && card.num_modes > 0 && by_transformation.count(card.method) > 0;
}

modal::Norm choose_norm(const records::Deck& deck, int method, const fe::Model& model) {
  const auto* card = find_method(deck, method);
  if (!card) return {};
  if (card->norm == "POINT") {
    const std::string who = fmt::format("EIGR {}: NORM = POINT names grid {}", card->sid, card->norm_grid);
    const int node = model.find_node(card->norm_grid);
    if (node < 0)
      throw InputError("fe.missing-grid", deck.locate(card->at), who + ", which the deck does not define",
                       "add the GRID, correct the id, or use NORM = MASS or MAX");
    if (model.node(node).num_dofs == 6 && card->norm_component == 0)
      throw InputError("fe.bad-component", deck.locate(card->at), who + " without a component, expected C = 1 to 6",
                       "name the component");
  }
  return {card->norm, card->norm_grid, card->norm_component};
}

}  // namespace bough::analysis
