#include "fe/loads/enforced.hpp"

#include <algorithm>

#include "base/number_text.hpp"
#include "fe/model/load_selection.hpp"
#include "fe/model/named_grid.hpp"

namespace bough::fe {

bool is_held_for(const Model& model, const records::Deck& deck, int set) {
  const auto &fixed = model.fixed_dofs(), &by_spcd = model.fixed_by_spcd();
  std::vector<int> moved;
  for (const auto& [dof, card] : list_spcd_dofs(model, deck, set)) moved.push_back(dof);
  std::sort(moved.begin(), moved.end());
  return std::all_of(moved.begin(), moved.end(),
                     [&](int dof) { return std::binary_search(fixed.begin(), fixed.end(), dof); }) &&
         std::all_of(by_spcd.begin(), by_spcd.end(),
                     [&](int dof) { return std::binary_search(moved.begin(), moved.end(), dof); });
}

VectorXd calc_enforced(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics) {
  const auto& fixed = model.fixed_dofs();
  VectorXd d = VectorXd::Zero(static_cast<Eigen::Index>(fixed.size()));
  const auto find = [&](int dof) {
    const auto at = std::lower_bound(fixed.begin(), fixed.end(), dof);
    return at != fixed.end() && *at == dof ? static_cast<int>(at - fixed.begin()) : -1;
  };
  for (const auto& [dof, value] : model.spc_displacements())
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
      const int index = find_named_grid(model, card.g, "SPCD", at, diagnostics);
      if (index < 0) continue;
      const Node& where = model.node(index);
      if (where.num_dofs == 6 && card.c == 0) {
        diagnostics.error("fe.bad-component", at,
                          "SPCD names no component of grid " + std::to_string(card.g) + ", expected digits 1 to 6",
                          "write the components that it moves");
        continue;
      }
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
                              ", which MSC Nastran leaves out; they are taken " + show_number(plain.scale) + " times",
                          "give the SPCD cards the id of the LOAD card for their own values");
  }
  for (Eigen::Index i = 0; i < d.size(); ++i)
    if (is_given[static_cast<std::size_t>(i)]) d[i] = by_load[i];
  return d;
}

}  // namespace bough::fe
