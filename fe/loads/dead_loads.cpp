/// Warning of PARAM,FOLLOWK,YES for loads without follower stiffness.
#include <map>

#include "fe/loads/load_sets.hpp"

namespace bough::fe {

void report_dead_loads(const records::Deck& deck, int set, Diagnostics& diagnostics) {
  const auto* param = deck.find_param("FOLLOWK");
  if (!param || (param->value != "YES" && param->value != "Y")) return;
  struct Kind {
    int count = 0;
    records::CardLocation at;
  };
  std::map<std::string, Kind> kinds;
  const auto count = [&](const std::string& card, const records::CardLocation& at) {
    auto& kind = kinds[card];
    if (kind.count++ == 0) kind.at = at;
  };
  const auto& cards = deck.load_cards;
  for (const auto& load : cards.directed)
    if (load.sid == set) count(std::string(load.is_moment ? "MOMENT" : "FORCE") + (load.is_cross ? "2" : "1"), load.at);
  for (const auto& load : cards.beams)
    if (load.sid == set && load.in_element_axes) count("PLOAD1 in element axes", load.at);
  for (const auto& load : cards.rotations)
    if (load.sid == set) count("RFORCE", load.at);
  std::string words;
  for (const auto& [card, kind] : kinds)
    words += (words.empty() ? "" : ", ") + card + " (" + std::to_string(kind.count) + ")";
  if (kinds.empty()) return;
  diagnostics.warning("fe.dead-load", deck.locate(kinds.begin()->second.at),
                      "load set " + std::to_string(set) + " keeps its direction where the structure moves, though " +
                          "PARAM,FOLLOWK,YES asks it to follow: " + words,
                      "of the loads only PLOAD, PLOAD2 and PLOAD4 without a direction follow; K_G and preloads are "
                      "those of a dead load, static results are not concerned");
}

}  // namespace bough::fe
