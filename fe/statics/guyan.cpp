/// Static (Guyan) reduction to the a-set. R. J. Guyan, "Reduction of stiffness and mass matrices", AIAA J. 3 (1965)
/// 380.
///
/// With o the dofs left out, u_o = G u_a + K_oo^-1 P_o, G = -K_oo^-1 K_oa. The columns of T get G; the second term is
/// added by StaticSolver, so static solutions are those of the whole f-set. One sparse factorization of K_oo, n_a
/// solutions in blocks; T then has up to num_gdofs n_a entries of 12 bytes, and an assembly costs
/// O(elements (s^2 n_a + s n_a^2)) with s the dofs of an element: meant for a few hundred a-dofs.
#include "fe/statics/guyan.hpp"

#include <algorithm>

#include "fe/matrices/system.hpp"
#include "fe/statics/statics.hpp"

namespace bough::fe {
namespace {

constexpr Eigen::Index kBlock = 64;  ///< columns of G at once: dense storage of num_gdofs x kBlock

using SparseColumns = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// T_f [1; G] for the f-dofs of the a-set, `kept`.
SparseRows calc_reduced_transform(const Model& model, const StaticSolver& omitted, const std::vector<int>& kept) {
  const SparseColumns T_f = model.T();
  const auto num_kept = static_cast<Eigen::Index>(kept.size());
  SparseColumns T_a(model.num_gdofs(), num_kept);
  for (Eigen::Index begin = 0; begin < num_kept; begin += kBlock) {
    const Eigen::Index size = std::min(kBlock, num_kept - begin);
    MatrixXd U = MatrixXd::Zero(model.num_gdofs(), size);
    for (Eigen::Index j = 0; j < size; ++j)
      for (SparseColumns::InnerIterator it(T_f, kept[static_cast<std::size_t>(begin + j)]); it; ++it)
        U(it.row(), j) = it.value();
    U -= omitted.solve(calc_stiffness_times(model, U));
    for (Eigen::Index j = 0; j < size; ++j) {
      T_a.startVec(begin + j);
      for (int i = 0; i < model.num_gdofs(); ++i)
        if (U(i, j) != 0) T_a.insertBack(i, begin + j) = U(i, j);
    }
  }
  T_a.finalize();
  return T_a;
}

/// Free dofs that the entries of a card name, ascending. Reports fe.analysis-set for dofs that a card constrains; dofs
/// that AUTOSPC fixed may be named.
std::vector<int> list_set(const Model& model, const records::Deck& deck,
                          const std::vector<records::GridComponents>& set, const std::string& card,
                          Diagnostics& diagnostics) {
  std::vector<int> dofs;
  std::unordered_map<int, const ConstrainedDof*> constrained;
  for (const auto& one : model.constrained_dofs()) constrained.emplace(one.dof, &one);
  const auto add = [&](int dof, const SourceLocation& at) {
    if (dof < 0) return;
    const auto found = constrained.find(dof);
    if (found == constrained.end()) {
      dofs.push_back(dof);
      return;
    }
    const ConstrainedDof& by = *found->second;
    const std::string why = by.card.empty()
                                ? ", which is fixed at line " + std::to_string(by.at.line) + " of " + by.at.file
                                : ", which " + by.card + " makes dependent";
    diagnostics.error("fe.analysis-set", at, card + " names " + model.name_dof(dof) + why,
                      "take it out of the " + card + ": only dofs that are free otherwise are kept or left out");
  };
  for (const auto& entry : set) {
    const SourceLocation at = deck.locate(entry.at);
    if (entry.c == 0) add(model.find_ldof(entry.g, 0, card, at, diagnostics), at);
    for (int c = 0; c < 6; ++c)
      if (entry.c >> c & 1u) add(model.find_ldof(entry.g, c + 1, card, at, diagnostics), at);
  }
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
  return dofs;
}

/// f-dofs of the a-set. With an ASET all others are eliminated, except the supports of a free body; with OMIT alone the
/// dofs that it names.
std::vector<int> list_aset(const Model& model, const records::Deck& deck, Diagnostics& diagnostics) {
  std::vector<int> aset = list_set(model, deck, deck.aset, "ASET", diagnostics);
  const std::vector<int> omit = list_set(model, deck, deck.omit, "OMIT", diagnostics);
  for (const int dof : omit)
    if (std::binary_search(aset.begin(), aset.end(), dof))
      diagnostics.error("fe.analysis-set", deck.locate({}), model.name_dof(dof) + " is in the ASET and in the OMIT",
                        "name it in one of them");
  diagnostics.throw_if_errors();
  if (!deck.aset.empty()) {
    std::vector<records::GridComponents> supports = deck.suport;
    if (const auto set = deck.suport1.find(model.subcase().suport1); set != deck.suport1.end())
      supports.insert(supports.end(), set->second.begin(), set->second.end());
    for (const auto& entry : supports)
      for (int c = 0; c < 6; ++c)
        if (entry.c >> c & 1u)
          aset.push_back(model.find_ldof(entry.g, c + 1, "SUPORT", deck.locate(entry.at), diagnostics));
    std::sort(aset.begin(), aset.end());
  }
  std::vector<int> kept;
  for (int f = 0; f < model.num_fdofs(); ++f) {
    const auto [grid, component] = model.describe_fdof(f);
    const int dof = model.node(model.find_node(grid)).first_gdof + std::max(component - 1, 0);
    const bool is_kept = deck.aset.empty() ? !std::binary_search(omit.begin(), omit.end(), dof)
                                           : std::binary_search(aset.begin(), aset.end(), dof);
    if (is_kept) kept.push_back(f);
  }
  return kept;
}

}  // namespace

Model reduce_to_aset(Model model, const records::Deck& deck, Diagnostics& diagnostics) {
  if (deck.aset.empty() && deck.omit.empty()) return model;
  // With a QSET the a-set is the boundary of component modes, which represent the other dofs: no static reduction.
  if (deck.card_counts.count("QSET") + deck.card_counts.count("QSET1") > 0) return model;
  const std::vector<int> kept = list_aset(model, deck, diagnostics);
  const int num_omitted = model.num_fdofs() - static_cast<int>(kept.size());
  if (num_omitted == 0) return model;
  if (kept.empty()) {
    diagnostics.error("fe.analysis-set", deck.locate({}), "ASET and OMIT leave no dof to the analysis",
                      "name the dofs that the modes need in the ASET");
    diagnostics.throw_if_errors();
  }

  std::shared_ptr<const StaticSolver> omitted;
  try {
    omitted = std::make_shared<const StaticSolver>(model, get_stiffness(model), kept);
  } catch (const ComputationError& error) {
    if (error.items().front().id != "fe.mechanism") throw;
    for (const auto& item : error.items())
      diagnostics.error("fe.omitted-singular", deck.locate({}),
                        "with the ASET held the dofs left out still move freely: " + item.what,
                        "add the dof named to the ASET, or constrain it");
    diagnostics.throw_if_errors();
  }
  SparseRows T = calc_reduced_transform(model, *omitted, kept);
  diagnostics.note("fe.static-reduction", deck.locate({}),
                   "ASET and OMIT leave " + std::to_string(kept.size()) + " dofs to the analysis, " +
                       std::to_string(num_omitted) + " follow them statically",
                   "take the cards out for the modes of the whole model");
  return std::move(model).with_transform(
      std::move(T), kept, [omitted](const Eigen::Ref<const MatrixXd>& F_g) { return omitted->solve(F_g); });
}

}  // namespace bough::fe
