/// AUTOSPC as a step of ModelBuilder.
#include <algorithm>
#include <set>
#include <unordered_map>

#include "fe/model/autospc.hpp"
#include "fe/model/builder.hpp"
#include "fe/model/sets.hpp"

namespace bough::fe {
namespace {

/// Columns of T that belong to `ldofs`, in this order; `column_ldof`: of all of them.
SparseRows take_columns(const SparseRows& T, const std::vector<int>& column_ldof, const std::vector<int>& ldofs) {
  std::unordered_map<int, int> requested, place;
  for (size_t k = 0; k < ldofs.size(); ++k) requested.emplace(ldofs[k], static_cast<int>(k));
  for (size_t f = 0; f < column_ldof.size() && !requested.empty(); ++f)
    if (const auto found = requested.find(column_ldof[f]); found != requested.end())
      place.emplace(static_cast<int>(f), found->second);
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < T.outerSize() && !place.empty(); ++row)
    for (SparseRows::InnerIterator it(T, row); it; ++it)
      if (const auto found = place.find(it.col()); found != place.end())
        entries.emplace_back(row, found->second, it.value());
  SparseRows taken(T.rows(), static_cast<int>(ldofs.size()));
  taken.setFromTriplets(entries.begin(), entries.end());
  return taken;
}

}  // namespace

void ModelBuilder::apply_autospc(const Elimination& first) {
  const records::Param* param = deck_.find_param("AUTOSPC");
  const bool is_on = options_.autospc.value_or(!param || (param->value != "NO" && param->value != "N"));
  const double epsilon = get_real_param(deck_, "EPZERO", 1e-8, diagnostics_);
  diagnostics_.throw_if_errors();
  // Decks with AUTOSPC NO still have dofs that nothing touches; Nastran's solvers pass over such empty columns.
  const bool only_null = !is_on && param && !options_.autospc;
  if (!is_on && !only_null) return;
  model_.autospc_ = find_singular_dofs(model_, first.fdof_ldof, only_null ? 1e-14 : epsilon);
  const bool asks_mass = only_null || std::any_of(model_.autospc_.begin(), model_.autospc_.end(),
                                                  [](const AutospcEntry& entry) { return entry.is_skew; });
  std::vector<double> mass(model_.autospc_.size(), 0);
  if (asks_mass) mass = calc_masses(model_, first.fdof_ldof, model_.autospc_);
  std::set<int>
      massive;  // nodes; rotations have negligible mass, and rigid-body motions are recognized by their components
  for (size_t e = 0; e < mass.size(); ++e)
    if (mass[e] > 0 && !only_null && model_.autospc_[e].component <= 3) massive.insert(model_.autospc_[e].node);
  int num_massive = 0, num_skew = 0;
  std::vector<AutospcEntry> held;
  for (size_t e = 0; e < mass.size(); ++e) {
    auto& entry = model_.autospc_[e];
    // Mass without stiffness moves at zero frequency in normal modes.
    if (only_null && !options_.uses_enforced && mass[e] > 0) continue;
    // If the block has mass, the oblique direction is constrained and the others stay free; otherwise only the
    // component, which strains nothing either and agrees with Nastran's table.
    if (entry.component > 3 || massive.count(entry.node) == 0) entry.terms.clear();
    num_skew += entry.is_skew ? 1 : 0;
    num_massive += entry.terms.empty() ? 0 : 1;
    held.push_back(std::move(entry));
  }
  model_.autospc_ = std::move(held);
  // Without any stiffness at all there is nothing to solve yet.
  if (only_null && model_.autospc_.size() == static_cast<size_t>(model_.T_.cols())) model_.autospc_.clear();
  if (model_.autospc_.empty()) return;
  std::vector<int> oblique;
  for (const auto& entry : model_.autospc_) {
    const Node& node = model_.nodes_[model_.find_node(entry.node)];
    const int ldof = node.first_gdof + std::max(entry.component - 1, 0);
    if (entry.terms.empty()) {
      is_fixed_[ldof] = 1;
      continue;
    }
    ConstraintEquation equation{ldof, {}, "AUTOSPC of grid " + std::to_string(entry.node), deck_.locate({})};
    for (const auto& [component, factor] : entry.terms)
      equation.terms.emplace_back(node.first_gdof + component - 1, factor);
    equations_.push_back(std::move(equation));
    oblique.push_back(ldof);
  }
  model_.T_oblique_ = take_columns(model_.T_, first.fdof_ldof, oblique);
  if (!oblique.empty())  // what is attached to these dofs follows too
    equations_ = resolve_chains(
        model_.num_gdofs_, std::move(equations_), [this](int l) { return model_.name_dof(l); }, diagnostics_);
  set_transform();
  if (only_null) {
    diagnostics_.warning("fe.null-dofs", deck_.locate(param->at),
                         "PARAM,AUTOSPC,NO leaves " + std::to_string(model_.autospc_.size()) +
                             " dofs without stiffness, the first at grid " + std::to_string(model_.autospc_[0].node) +
                             "; they are constrained nevertheless",
                         "there is no solution with them; hold or remove them");
    return;
  }
  const auto are = [](int n) { return std::to_string(n) + (n == 1 ? " is" : " are"); };
  std::string what = "AUTOSPC holds " + std::to_string(model_.autospc_.size()) +
                     " dofs without stiffness, the first at grid " + std::to_string(model_.autospc_[0].node);
  if (num_skew > 0)
    what += "; " + are(num_skew) + " the weakest of a singular block (an oblique direction without stiffness)";
  if (num_massive > 0) what += ", " + std::to_string(num_massive) + " of them with mass: the direction itself is held";
  diagnostics_.note("fe.autospc", deck_.locate({}), what, "PARAM,AUTOSPC,NO keeps them");
}

}  // namespace bough::fe
