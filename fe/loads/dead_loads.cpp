#include "fe/loads/dead_loads.hpp"

#include <algorithm>
#include <map>

#include "fe/model/load_selection.hpp"

namespace bough::fe {

void report_dead_loads(const records::Deck& deck, int load_set, Diagnostics& diagnostics) {
  const auto* param = deck.find_param("FOLLOWK");
  if (load_set <= 0 || !param || (param->value != "YES" && param->value != "Y")) return;
  struct Kind {
    int count = 0;
    records::CardLocation at;
  };
  std::map<std::string, Kind> kinds;
  const auto count = [&](const std::string& card, const records::CardLocation& at) {
    auto& kind = kinds[card];
    if (kind.count++ == 0) kind.at = at;
  };
  std::vector<int> sets;
  for_each_plain_set(deck, load_set, [&](int sid, double, const records::CardLocation&) { sets.push_back(sid); });
  const auto is_used = [&](int sid) { return std::find(sets.begin(), sets.end(), sid) != sets.end(); };
  const auto& cards = deck.load_cards;
  for (const auto& load : cards.directed)
    if (is_used(load.sid))
      count(std::string(load.is_moment ? "MOMENT" : "FORCE") + (load.is_cross ? "2" : "1"), load.at);
  for (const auto& load : cards.beams)
    if (load.in_element_axes && is_used(load.sid)) count("PLOAD1 in element axes", load.at);
  for (const auto& load : cards.rotations)
    if (is_used(load.sid)) count("RFORCE", load.at);
  std::string words;
  for (const auto& [card, kind] : kinds)
    words += (words.empty() ? "" : ", ") + card + " (" + std::to_string(kind.count) + ")";
  if (kinds.empty()) return;
  diagnostics.warning("fe.dead-load", deck.locate(kinds.begin()->second.at),
                      "load set " + std::to_string(load_set) +
                          " keeps its direction where the structure moves, though " +
                          "PARAM,FOLLOWK,YES asks it to follow: " + words,
                      "of the loads only PLOAD, PLOAD2 and PLOAD4 without a direction follow in K_G and preloads; "
                      "bough static --nonlinear turns FORCE1, FORCE2, MOMENT1 and MOMENT2 too");
}

}  // namespace bough::fe
