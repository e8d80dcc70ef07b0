/// Acoustic fluid: pressures at grids with CD = -1, solids with FCTN = PFLUID. Real modes and statics of the structure
/// are without it in Nastran too (the coupling is in the complex and frequency solutions).
#include <string>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {

void finish_fluid(Reading& r) {
  if (r.fluid_grids.empty() && r.fluid_properties.empty()) return;
  auto& deck = r.deck;
  const auto is_fluid = [&](int grid) { return r.fluid_grids.count(grid) > 0; };
  const std::size_t before = deck.solids.size();
  std::erase_if(deck.solids, [&](const auto& e) { return r.fluid_properties.count(e.pid) > 0; });
  const std::size_t num_solids = before - deck.solids.size();
  const auto take_out = [&](auto& list) { std::erase_if(list, [&](const auto& entry) { return is_fluid(entry.g); }); };
  take_out(deck.spc);
  take_out(deck.load_cards.spcd);
  take_out(deck.temperatures.grids);
  for (auto* set : {&deck.suport, &deck.aset, &deck.omit, &deck.qset, &deck.bset, &deck.cset}) take_out(*set);
  for (auto& [sid, set] : deck.suport1) take_out(set);
  std::erase_if(deck.plotel, [&](const auto& e) { return is_fluid(e.ga) || is_fluid(e.gb); });
  const auto count = [&](std::size_t n, const char* what) {
    if (n == 0) return std::string{};
    const auto text = std::to_string(n) + " fluid " + what;
    deck.left_out.push_back(text);
    return text;
  };
  std::string what;
  for (const auto& text :
       {count(r.fluid_grids.size(), "GRID"), count(r.fluid_properties.size(), "PSOLID"), count(num_solids, "solids")})
    if (!text.empty()) what += (what.empty() ? "" : ", ") + text;
  r.diagnostics.note("deck.fluid", deck.locate(r.first_fluid), "fluid is left out: " + what,
                     "it has pressures, not displacements; its effect on the structure is not computed");
}

}  // namespace bough::nastran::detail
