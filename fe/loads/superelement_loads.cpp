#include <algorithm>
#include <cmath>

#include "fe/elements/superelement.hpp"
#include "fe/loads/load_sets.hpp"
#include "fe/model/load_selection.hpp"
#include "formats/records/selection.hpp"

namespace bough::fe {
namespace {

constexpr double kGrounded = 1e-9;  // share of strain energy: condensation leaves 1e-13

bool has_component_gravity(const records::Deck& deck) {
  const auto* param = deck.find_param("CMSALOAD");
  return param && param->value.starts_with('Y');
}

/// Largest share of the strain energy of rigid-body motion in that of the diagonal of K.
double calc_rigid_energy(const Superelement& superelement, const MatrixXd& Phi_R) {
  MatrixXd K = MatrixXd::Zero(superelement.num_dofs(), superelement.num_dofs());
  superelement.add_stiffness(1, K);
  double largest = 0;
  for (Eigen::Index r = 0; r < Phi_R.cols(); ++r) {
    const double allowed = K.diagonal().dot(Phi_R.col(r).cwiseAbs2());
    if (allowed > 0) largest = std::max(largest, std::abs(Phi_R.col(r).dot(K * Phi_R.col(r))) / allowed);
  }
  return largest;
}

/// K_G of one load on the dofs of a superelement.
QuadraticForm make_form(const Superelement& superelement, const MatrixXd& K_G) {
  const auto n = static_cast<int>(K_G.rows());
  QuadraticForm form{superelement.gdofs(), MatrixXd::Identity(n, n), MatrixXd(n * (n + 1) / 2, 1)};
  for (int j = 0; j < n; ++j)
    for (int i = j; i < n; ++i) form.weights(find_weight(n, i, j), 0) = K_G(i, j);
  return form;
}

}  // namespace

bool add_superelement_loads(const LoadTarget& t) {
  bool is_found = false;
  for (const auto& card : t.deck.super.seload) {
    if (card.set != t.set) continue;
    is_found = true;
    VectorXd load;
    for (const auto& element : t.model.elements()) {
      const auto* superelement = dynamic_cast<const Superelement*>(element.get());
      if (!superelement || superelement->id() != card.superelement) continue;
      load = superelement->get_load(card.load);
      for (Eigen::Index i = 0; i < load.size(); ++i)
        t.F[superelement->gdofs()[static_cast<std::size_t>(i)]] += t.scale * load[i];
    }
    if (load.size() == 0)
      t.diagnostics.error("fe.superelement-load", t.deck.locate(card.at),
                          "SELOAD names load " + std::to_string(card.load) + " of superelement " +
                              std::to_string(card.superelement) + ", whose section and matrices have no such load",
                          "correct LIDSE: DTI SELOAD of the .pch file lists the loads");
  }
  return is_found;
}

bool add_part_loads(const Model& model, int set, AppliedLoad& load) {
  bool is_found = false;
  for (const auto& element : model.elements()) {
    const auto* superelement = dynamic_cast<const Superelement*>(element.get());
    if (!superelement || !superelement->is_part() || !superelement->has_load(set)) continue;
    is_found = true;
    const VectorXd F = superelement->get_load(set);
    for (Eigen::Index i = 0; i < F.size(); ++i) load.F[superelement->gdofs()[static_cast<std::size_t>(i)]] += F[i];
    if (const MatrixXd K_G = superelement->get_load_stiffness(set); !K_G.isZero(0))
      load.followers.push_back(make_form(*superelement, K_G));
  }
  return is_found;
}

std::vector<const Element*> list_without_gravity(const Model& model, const records::Deck& deck) {
  std::vector<const Element*> list;
  if (deck.superelements.empty()) return list;
  const bool is_requested = has_component_gravity(deck);
  for (const auto& element : model.elements())
    if (const auto* one = dynamic_cast<const Superelement*>(element.get()); one && (one->is_part() || !is_requested))
      list.push_back(one);
  return list;
}

VectorXd calc_superelement_force(const Model& model, const VectorXd& a,
                                 const std::vector<const Element*>& superelements) {
  VectorXd force = VectorXd::Zero(model.num_gdofs());
  for (const auto* element : superelements) {
    MatrixXd M = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
    element->add_mass(model.mass_kind(), model.wtmass(), M);
    const VectorXd f = M * a(element->gdofs());
    for (Eigen::Index i = 0; i < f.size(); ++i) force[element->gdofs()[static_cast<std::size_t>(i)]] += f[i];
  }
  return force;
}

void report_gravity(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics) {
  if (deck.superelements.empty()) return;
  const auto at = deck.locate(records::find_selection(deck, "LOAD", set));
  const bool is_requested = has_component_gravity(deck);
  const MatrixXd Phi_R = model.calc_rigid_modes();
  std::string external, parts;
  for (const auto& element : model.elements()) {
    const auto* one = dynamic_cast<const Superelement*>(element.get());
    if (!one || !one->offset_mass(model.mass_kind())) continue;
    const std::string name = std::to_string(one->id());
    if (one->is_part()) {
      if (!one->has_load(set)) parts += (parts.empty() ? "" : ", ") + name;
    } else if (!is_requested) {
      external += (external.empty() ? "" : ", ") + name;
    } else if (calc_rigid_energy(*one, Phi_R(one->gdofs(), Eigen::all)) > kGrounded) {
      diagnostics.error("fe.superelement-gravity", at,
                        "superelement " + name +
                            " resists rigid-body motion of its boundary, and PARAM,CMSALOAD accelerates it: its mass "
                            "matrix does not give the load",
                        "free the component of its supports, or give the load as a column of PX and by SELOAD");
    }
  }
  if (!external.empty())
    diagnostics.warning("fe.superelement-gravity", at,
                        "GRAV, RFORCE and ACCEL of LOAD " + std::to_string(set) +
                            " do not act on the mass of external superelement(s) " + external,
                        "give PARAM,CMSALOAD,YES, or the load of the component by SELOAD");
  if (!parts.empty())
    diagnostics.warning("fe.superelement-gravity", at,
                        "GRAV, RFORCE and ACCEL of LOAD " + std::to_string(set) +
                            " do not act on the mass of superelement(s) " + parts + ", whose sections have no set " +
                            std::to_string(set),
                        "repeat the cards in each BEGIN SUPER section");
}

std::unordered_map<int, VectorXd> calc_interior_values(const Model& model, const records::Deck& deck, int set) {
  std::unordered_map<int, VectorXd> values;
  if (set == 0 || deck.superelements.empty()) return values;
  for (int e = 0; const auto& element : model.elements()) {
    const int index = e++;
    const auto* item = dynamic_cast<const RecoveredItem*>(element.get());
    if (!item || item->of_loads().values.size() == 0) continue;
    const auto& of_loads = item->of_loads();
    VectorXd sum = VectorXd::Zero(of_loads.values.rows());
    const auto add = [&](int load, double scale) {
      const auto column = of_loads.load_columns.find(load);
      if (column != of_loads.load_columns.end()) sum += scale * of_loads.values.col(column->second);
    };
    if (of_loads.is_part)
      add(set, 1);
    else
      for_each_plain_set(deck, set, [&](int sid, double scale, const records::CardLocation&) {
        for (const auto& card : deck.super.seload)
          if (card.set == sid && card.superelement == of_loads.superelement) add(card.load, scale);
      });
    if (!sum.isZero(0)) values.emplace(index, std::move(sum));
  }
  return values;
}

}  // namespace bough::fe
