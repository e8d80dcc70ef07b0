#include <cmath>

#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

using records::ShellElement;

/// Blank where zero: readers of meshes take every number after PID for a grid.
void add_axes(const ShellElement& e, CardFields& card) {
  if (e.mcid)
    card.add(*e.mcid);
  else if (e.theta_deg != 0)
    card.add(e.theta_deg);
  else
    card.add_blank();
  if (e.z_offset != 0)
    card.add(e.z_offset);
  else
    card.add_blank();
}

void add_thickness(const ShellElement& e, CardFields& card) {
  for (const double t : e.t) std::isnan(t) ? card.add_blank() : card.add(t);
  if (e.t.empty()) card.add_blank(static_cast<int>(e.grids.size()));
}

void write_shell(const ShellElement& e, CardSink& sink) {
  CardFields card(e.card);
  card.add(e.id).add(e.pid);
  for (const int grid : e.grids) card.add(grid);
  const bool is_quadratic = e.card == "CQUAD8" || e.card == "CTRIA6";
  if (!is_quadratic) {
    add_axes(e, card);
    if (e.relative_thickness || !e.t.empty()) {
      card.end_line().add_blank().add(e.relative_thickness ? 1 : 0);
      add_thickness(e, card);
    }
    sink.put(card);
    return;
  }
  for (const int grid : e.midsides) card.add_id(grid);
  if (e.midsides.empty()) card.add_blank(static_cast<int>(e.grids.size()));
  if (e.grids.size() == 3) add_axes(e, card);
  add_thickness(e, card);
  if (e.grids.size() == 4) add_axes(e, card);
  sink.put(card.add_id(e.relative_thickness ? 1 : 0));
}

}  // namespace

void write_shells(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.shells) write_shell(e, sink);
  for (const auto& p : deck.pshear)
    sink.put(CardFields("PSHEAR").add(p.id).add(p.mid).add(p.t).add(p.nsm).add(p.f1).add(p.f2));
  for (const auto& e : deck.shear_panels) {
    CardFields card("CSHEAR");
    card.add(e.id).add(e.pid);
    for (const int grid : e.grids) card.add(grid);
    sink.put(card);
  }
}

}  // namespace bough::nastran::detail
