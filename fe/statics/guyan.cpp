/// Static (Guyan) reduction to the a-set. R. J. Guyan, "Reduction of stiffness and mass matrices", AIAA J. 3 (1965)
/// 380.
///
/// With o the dofs left out, u_o = G u_a + K_oo^-1 P_o, G = -K_oo^-1 K_oa. The columns of T get G; the second term is
/// added by StaticSolver, so static solutions are those of the whole f-set. One sparse factorization of K_oo, n_a
/// solutions in blocks; T then has up to num_gdofs n_a entries of 12 bytes, and an assembly costs
/// O(elements (s^2 n_a + s n_a^2)) with s the dofs of an element: meant for a few hundred a-dofs.
#include <algorithm>

#include "fe/matrices/system.hpp"
#include "fe/model/builder.hpp"
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

}  // namespace

std::vector<int> ModelBuilder::list_set(const std::vector<records::GridComponents>& set, const std::string& card) {
  std::vector<int> ldofs;
  std::unordered_map<int, const SourceLocation*> fixed;
  for (const auto& [ldof, at] : fixed_by_) fixed.emplace(ldof, &at);
  std::unordered_map<int, const std::string*> dependent;
  for (const auto& equation : equations_) dependent.emplace(equation.dependent, &equation.card);
  for (const auto& entry : model_.autospc_)  // may be named all the same
    dependent.erase(model_.nodes_[model_.find_node(entry.node)].first_gdof + std::max(entry.component - 1, 0));
  const auto add = [&](int ldof, const SourceLocation& at) {
    if (ldof < 0) return;
    std::string why;
    if (const auto it = dependent.find(ldof); it != dependent.end())
      why = ", which " + *it->second + " makes dependent";
    else if (const auto held = fixed.find(ldof); held != fixed.end())
      why = ", which is fixed at line " + std::to_string(held->second->line) + " of " + held->second->file;
    if (why.empty())
      ldofs.push_back(ldof);
    else
      diagnostics_.error("fe.analysis-set", at, card + " names " + name_dof(ldof) + why,
                         "take it out of the " + card + ": only dofs that are free otherwise are kept or left out");
  };
  for (const auto& entry : set) {
    const SourceLocation at = deck_.locate(entry.at);
    if (entry.c == 0) add(find_ldof(entry.g, 0, card, at), at);
    for (int c = 0; c < 6; ++c)
      if (entry.c >> c & 1u) add(find_ldof(entry.g, c + 1, card, at), at);
  }
  std::sort(ldofs.begin(), ldofs.end());
  ldofs.erase(std::unique(ldofs.begin(), ldofs.end()), ldofs.end());
  return ldofs;
}

void ModelBuilder::omit_dofs() {
  if (deck_.aset.empty() && deck_.omit.empty()) return;
  // With a QSET the a-set is the boundary of component modes, which stand for the others: those then stay as they are.
  if (deck_.card_counts.count("QSET") + deck_.card_counts.count("QSET1") > 0) return;
  std::vector<int> kept_ldofs = list_set(deck_.aset, "ASET");
  const std::vector<int> omit = list_set(deck_.omit, "OMIT");
  for (const int ldof : omit)
    if (std::binary_search(kept_ldofs.begin(), kept_ldofs.end(), ldof))
      diagnostics_.error("fe.analysis-set", deck_.locate({}), name_dof(ldof) + " is in the ASET and in the OMIT",
                         "name it in one of them");
  diagnostics_.throw_if_errors();
  // With an ASET everything else is left out but the supports of a free body; with OMIT alone what it names is.
  if (!deck_.aset.empty()) {
    std::vector<records::GridComponents> supports = deck_.suport;
    if (const auto set = deck_.suport1.find(model_.subcase_.suport1); set != deck_.suport1.end())
      supports.insert(supports.end(), set->second.begin(), set->second.end());
    for (const auto& entry : supports)
      for (int c = 0; c < 6; ++c)
        if (entry.c >> c & 1u) kept_ldofs.push_back(find_ldof(entry.g, c + 1, "SUPORT", deck_.locate(entry.at)));
    std::sort(kept_ldofs.begin(), kept_ldofs.end());
  }
  const auto is_kept = [&](int ldof) {
    return deck_.aset.empty() ? !std::binary_search(omit.begin(), omit.end(), ldof)
                              : std::binary_search(kept_ldofs.begin(), kept_ldofs.end(), ldof);
  };

  std::vector<int> kept;
  for (int f = 0; f < model_.num_fdofs(); ++f)
    if (is_kept(model_.nodes_[model_.fdof_node_[f]].first_gdof + std::max(model_.fdof_component_[f] - 1, 0)))
      kept.push_back(f);
  const int num_omitted = model_.num_fdofs() - static_cast<int>(kept.size());
  if (num_omitted == 0) return;
  if (kept.empty()) {
    diagnostics_.error("fe.analysis-set", deck_.locate({}), "ASET and OMIT leave no dof to the analysis",
                       "name the dofs that the modes need in the ASET");
    diagnostics_.throw_if_errors();
  }

  std::shared_ptr<const StaticSolver> omitted;
  try {
    omitted = std::make_shared<const StaticSolver>(model_, get_stiffness(model_), kept);
  } catch (const ComputationError& error) {
    if (error.items().front().id != "fe.mechanism") throw;
    for (const auto& item : error.items())
      diagnostics_.error("fe.omitted-singular", deck_.locate({}),
                         "with the ASET held the dofs left out still move freely: " + item.what,
                         "add the dof named to the ASET, or constrain it");
    diagnostics_.throw_if_errors();
  }
  model_.T_ = calc_reduced_transform(model_, *omitted, kept);
  model_.checked_stiffness_ = nullptr;
  model_.omitted_ = std::move(omitted);
  for (auto& slots : model_.node_fdof_) slots.fill(-1);
  std::vector<int> node, component;
  for (const int f : kept) {
    const int k = model_.fdof_node_[f], c = model_.fdof_component_[f];
    model_.node_fdof_[k][std::max(c - 1, 0)] = static_cast<int>(node.size());
    node.push_back(k);
    component.push_back(c);
  }
  model_.fdof_node_ = std::move(node);
  model_.fdof_component_ = std::move(component);
  diagnostics_.note("fe.static-reduction", deck_.locate({}),
                    "ASET and OMIT leave " + std::to_string(kept.size()) + " dofs to the analysis, " +
                        std::to_string(num_omitted) + " follow them statically",
                    "take the cards out for the modes of the whole model");
}

}  // namespace bough::fe
