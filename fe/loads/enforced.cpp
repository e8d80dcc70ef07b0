#include "fe/loads/load_sets.hpp"
#include "fe/model/builder.hpp"
#include "fe/model/constraints.hpp"

#include <algorithm>
#include <cstdio>

namespace bough::fe {
namespace {

std::string show_factor(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

FixedPart collect_fixed_part(int num_ldofs, const std::vector<ConstraintEquation>& resolved,
                             const std::vector<char>& is_fixed) {
  FixedPart part;
  std::vector<char> is_dependent(static_cast<std::size_t>(num_ldofs), 0);
  std::vector<int> column(static_cast<std::size_t>(num_ldofs), -1);
  for (const auto& equation : resolved) is_dependent[static_cast<std::size_t>(equation.dependent)] = 1;
  std::vector<Eigen::Triplet<double>> entries;
  for (int l = 0; l < num_ldofs; ++l)
    if (is_fixed[static_cast<std::size_t>(l)] && !is_dependent[static_cast<std::size_t>(l)]) {
      column[static_cast<std::size_t>(l)] = static_cast<int>(part.ldofs.size());
      entries.emplace_back(l, static_cast<int>(part.ldofs.size()), 1.0);
      part.ldofs.push_back(l);
    }
  for (const auto& equation : resolved)
    for (const auto& [ldof, c] : equation.terms)
      if (const int j = column[static_cast<std::size_t>(ldof)]; j >= 0) entries.emplace_back(equation.dependent, j, c);
  part.C.resize(num_ldofs, static_cast<int>(part.ldofs.size()));
  part.C.setFromTriplets(entries.begin(), entries.end());
  return part;
}

std::vector<std::pair<int, const records::Spcd*>> list_spcd_dofs(const Model& model, const records::Deck& deck,
                                                                 int set) {
  std::vector<std::pair<int, const records::Spcd*>> dofs;
  if (set == 0 || deck.load_cards.spcd.empty()) return dofs;
  for (const auto& plain : list_plain_sets(deck, set)) {
    for (const auto& card : deck.load_cards.spcd) {
      const int index = card.sid == plain.sid ? model.find_node(card.g) : -1;
      if (index < 0) continue;
      const Node& where = model.node(index);
      for (int c = 0; c < where.num_dofs; ++c)
        if (where.num_dofs == 1 || (card.c >> c & 1u)) dofs.emplace_back(where.first_gdof + c, &card);
    }
  }
  return dofs;
}

void ModelBuilder::hold_spcd() {
  if (!options_.uses_enforced || options_.ignore_spc) return;
  const records::Spcd* first = nullptr;
  for (const auto& [dof, card] : list_spcd_dofs(model_, deck_, model_.subcase_.load)) {
    if (is_fixed_[dof]) continue;
    if (!first) first = card;
    is_fixed_[dof] = 1;
    fixed_by_.emplace_back(dof, deck_.locate(card->at));
    model_.held_by_spcd_.push_back(dof);
  }
  if (!first) return;
  const auto num = model_.held_by_spcd_.size();
  diagnostics_.warning("fe.spcd-not-fixed", deck_.locate(first->at),
                       "SPCD moves " + name_dof(model_.held_by_spcd_.front()) +
                           (num > 1 ? " (and " + std::to_string(num - 1) + " dofs more)" : "") +
                           ", which no SPC of the subcase fixes; it is held as if one did",
                       "fix it with the SPC set of the subcase");
}

bool Model::is_held_for(const records::Deck& deck, int set) const {
  std::vector<int> moved;
  for (const auto& [dof, card] : list_spcd_dofs(*this, deck, set)) moved.push_back(dof);
  std::sort(moved.begin(), moved.end());
  return std::all_of(moved.begin(), moved.end(),
                     [&](int dof) { return std::binary_search(fixed_dofs_.begin(), fixed_dofs_.end(), dof); }) &&
         std::all_of(held_by_spcd_.begin(), held_by_spcd_.end(),
                     [&](int dof) { return std::binary_search(moved.begin(), moved.end(), dof); });
}

VectorXd Model::calc_enforced(const records::Deck& deck, int set, Diagnostics& diagnostics) const {
  VectorXd d = VectorXd::Zero(static_cast<Eigen::Index>(fixed_dofs_.size()));
  const auto find = [&](int dof) {
    const auto at = std::lower_bound(fixed_dofs_.begin(), fixed_dofs_.end(), dof);
    return at != fixed_dofs_.end() && *at == dof ? static_cast<int>(at - fixed_dofs_.begin()) : -1;
  };
  for (const auto& [dof, value] : enforced_)
    if (const int i = find(dof); i >= 0) d[i] = value;
  if (set == 0) return d;
  VectorXd by_load = VectorXd::Zero(d.size());
  std::vector<char> is_given(static_cast<std::size_t>(d.size()), 0);
  for (const auto& plain : list_plain_sets(deck, set)) {
    const int sid = plain.sid;
    bool is_combined = false;
    for (const auto& card : deck.load_cards.spcd) {
      if (card.sid != sid) continue;
      is_combined = sid != set;
      const SourceLocation at = deck.locate(card.at);
      const int index = find_node(card.g);
      if (index < 0 && is_refused(card.g)) continue;
      if (index < 0) {
        diagnostics.error("fe.missing-grid", at,
                          "SPCD names grid " + std::to_string(card.g) + ", which the deck does not define",
                          "add the GRID or correct the id");
        continue;
      }
      const Node& where = nodes_[static_cast<std::size_t>(index)];
      for (int c = 0; c < where.num_dofs; ++c) {
        if (where.num_dofs == 6 && !(card.c >> c & 1u)) continue;
        const int i = find(where.first_gdof + c);
        if (i < 0) {
          diagnostics.error("fe.spcd-not-fixed", at,
                            "SPCD moves grid " + std::to_string(card.g) + " component " +
                                std::to_string(where.num_dofs == 1 ? 0 : c + 1) + ", which no SPC of the subcase fixes",
                            "fix it with the SPC set of the subcase");
          continue;
        }
        by_load[i] += plain.scale * card.d;
        is_given[static_cast<std::size_t>(i)] = 1;
      }
    }
    if (is_combined)
      diagnostics.warning("fe.spcd-combined", deck.locate(plain.at),
                          "LOAD " + std::to_string(set) + " combines the SPCD cards of set " + std::to_string(sid) +
                              ", which MSC Nastran leaves out; they are taken " + show_factor(plain.scale) + " times",
                          "give the SPCD cards the id of the LOAD card for their own values");
  }
  for (Eigen::Index i = 0; i < d.size(); ++i)
    if (is_given[static_cast<std::size_t>(i)]) d[i] = by_load[i];
  return d;
}

}  // namespace bough::fe
