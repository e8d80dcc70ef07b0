#include "analysis/split/structure.hpp"

#include <algorithm>
#include <set>

#include "fe/elements/connector.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/model/sets.hpp"
#include "formats/records/params.hpp"

namespace bough::analysis::splitting {

namespace {

constexpr int kSelectedSet = 1;  ///< id of the SPC set and the MPC set of a part

/// The cards of the sets that the union or plain set `sid` selects, under one id.
template <class Card>
void select_set(int sid, const std::vector<records::SetUnion>& unions, const std::string& what,
                const records::Deck& deck, std::vector<Card>& cards, Diagnostics& diagnostics) {
  std::set<int> plain;
  for (const auto& card : cards) plain.insert(card.sid);
  std::vector<int> sets;
  if (sid != 0) sets = fe::expand_set(sid, unions, {plain.begin(), plain.end()}, what, deck, diagnostics);
  std::erase_if(cards, [&](const Card& card) { return std::find(sets.begin(), sets.end(), card.sid) == sets.end(); });
  for (auto& card : cards) card.sid = kSelectedSet;
}

void select_sets(const records::Subcase& subcase, records::Deck& deck) {
  Diagnostics reported_by_model;
  select_set(subcase.spc, deck.spcadd, "SPC", deck, deck.spc, reported_by_model);
  select_set(subcase.mpc, deck.mpcadd, "MPC", deck, deck.mpc, reported_by_model);
  deck.spcadd.clear();
  deck.mpcadd.clear();
  deck.subcases = {subcase};
  deck.subcases.front().spc = deck.spc.empty() ? 0 : kSelectedSet;
  deck.subcases.front().mpc = deck.mpc.empty() ? 0 : kSelectedSet;
}

std::map<int, unsigned> list_held(const records::Deck& deck) {
  std::map<int, unsigned> held;
  for (const auto& grid : deck.grids)
    if (grid.ps != 0) held[grid.id] |= grid.ps;
  for (const auto& constraint : deck.spc) held[constraint.g] |= constraint.c;
  return held;
}

/// Components that every grid of an element holds, if all have the same displacement axes.
unsigned find_common(const Structure& structure) {
  std::set<int> joined;
  for (const auto& element : structure.elements)
    if (is_structural(element)) joined.insert(element.grids.begin(), element.grids.end());
  unsigned common = 0b111111;
  int axes = -1;
  for (const auto& grid : structure.deck.grids) {
    if (joined.count(grid.id) == 0) continue;
    const auto held = structure.held.find(grid.id);
    common &= held == structure.held.end() ? 0U : held->second;
    if (axes >= 0 && axes != grid.cd) return 0;
    axes = grid.cd;
  }
  return common;
}

/// CFAST and CWELD name shells or properties: their grids are those of the elements made of them.
void find_connected(const fe::Model& model, std::vector<DeckItem>& elements) {
  std::map<std::string, DeckItem*> connectors;
  for (auto& item : elements)
    if (item.card == "CFAST" || item.card == "CWELD") connectors[name_item(item)] = &item;
  if (connectors.empty()) return;
  for (const auto& element : model.elements()) {
    const auto* connector = dynamic_cast<const fe::Connector*>(element.get());
    if (connector == nullptr) continue;
    DeckItem& item = *connectors.at(connector->card() + " " + std::to_string(connector->id()));
    item.shells = connector->shells();
    item.grids.clear();
    for (const int node : connector->nodes()) item.grids.push_back(model.node(node).id);
    std::sort(item.grids.begin(), item.grids.end());
  }
}

void refuse_unsplit_cards(const records::Deck& deck, const records::Subcase& subcase, Diagnostics& diagnostics) {
  if (!deck.superelements.empty() || !deck.super.empty())
    diagnostics.error("split.superelements", deck.locate({}), "a deck with superelements is not split",
                      "give the deck without SEBULK and BEGIN SUPER");
  if (subcase.preload != 0 || subcase.statsub != 0)
    diagnostics.error("split.preload", deck.locate(subcase.preload_at),
                      "the subcase has a preload (STATSUB), whose stress the parts would lose",
                      "remove STATSUB, and load the system of the parts");
  for (const auto& nsm : deck.special.nsm)
    if (nsm.is_total && subcase.nsm != 0)
      diagnostics.error("split.spread-mass", deck.locate(nsm.at),
                        "NSML spreads one mass over elements that may come to several parts",
                        "write its mass per length or area as NSM");
  if (!deck.aset.empty() || !deck.omit.empty())
    diagnostics.error("split.omitted-dofs", deck.locate((deck.aset.empty() ? deck.omit : deck.aset).front().at),
                      "ASET and OMIT reduce the whole deck; parts are reduced on their cuts",
                      "remove them, or leave them out with --ignore ASET,ASET1,OMIT,OMIT1");
}

}  // namespace

Structure make_structure(const records::Deck& deck, const fe::Model& model, Diagnostics& diagnostics) {
  refuse_unsplit_cards(deck, model.subcase(), diagnostics);
  Structure structure;
  structure.deck = deck;
  select_sets(model.subcase(), structure.deck);
  structure.elements = list_elements(structure.deck);
  structure.rigid = list_rigid(structure.deck);
  find_connected(model, structure.elements);
  for (const auto& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    structure.position[node.id] = node.x;
    structure.axes[node.id] = node.R_basic_cd;
  }
  for (const auto& grid : deck.grids) structure.at[grid.id] = grid.at;
  constexpr unsigned kRotations = 0b111000;
  for (const auto& beam : structure.deck.beams) {
    if ((beam.pin_a & kRotations) != 0) structure.pinned.emplace(beam.id, beam.ga);
    if ((beam.pin_b & kRotations) != 0) structure.pinned.emplace(beam.id, beam.gb);
  }
  for (const auto& element : structure.elements)
    if (!element.is_drawn) structure.joined.insert(element.grids.begin(), element.grids.end());
  for (const auto& rigid : structure.rigid) structure.joined.insert(rigid.grids.begin(), rigid.grids.end());
  structure.alpha1 = records::get_real_param(deck, "ALPHA1", 0, diagnostics);
  structure.alpha2 = records::get_real_param(deck, "ALPHA2", 0, diagnostics);
  const Eigen::MatrixXd strained = Eigen::VectorXd::LinSpaced(model.num_gdofs(), 0, 1).array().square().matrix();
  const double g = records::get_real_param(deck, "G", 0, diagnostics);
  structure.has_material_damping = !fe::calc_structural_damping_times(model, g, strained).isZero(0);
  structure.held = list_held(structure.deck);
  structure.common_held = find_common(structure);
  for (auto& [grid, mask] : structure.held) mask &= ~structure.common_held;
  std::erase_if(structure.held,
                [&](const auto& entry) { return entry.second == 0 || structure.joined.count(entry.first) == 0; });
  diagnostics.throw_if_errors();
  return structure;
}

}  // namespace bough::analysis::splitting
