#include "formats/records/flex_body_units.hpp"

#include <cmath>

namespace bough::records {

double UnitChange::calc_force() const { return mass * length / (time * time); }

double UnitChange::calc_modal() const { return std::sqrt(mass) * length; }

double calc_locator_unit(int direction, const UnitChange& change) {
  if (direction == 0) return 1;
  return direction <= 3 ? change.calc_force() : change.calc_force() * change.length;
}

double calc_component_unit(const std::string& component, const UnitChange& change) {
  const double force = change.calc_force();
  const auto begins = [&](const char* word) { return component.starts_with(word); };
  if (begins("stress") || begins("sxx") || begins("syy") || begins("szz") || begins("sxy") || begins("syz") ||
      begins("szx"))
    return force / (change.length * change.length);
  if (begins("moment") || begins("torque")) return force * change.length;
  // Forces and moments per length of shells and panels; N12 ... N41 are the corner forces of a panel.
  if (begins("q") || begins("Q") || begins("Nx") || begins("Ny")) return force / change.length;
  if (begins("M")) return force;
  return force;
}

namespace {

void scale_integrals(MassIntegrals& g, const UnitChange& c) {
  if (g.empty()) return;
  const double e = c.calc_modal(), square = c.length * c.length;
  g.gamma0 *= c.mass * c.length / e;
  g.gamma1 *= c.mass * square / e;
  for (auto& m : g.gamma2) m *= c.mass * square / (e * e);
  for (auto& m : g.gamma3) m *= c.mass * square / e;
  for (auto& row : g.gamma4)
    for (auto& m : row) m *= c.mass * square / (e * e);
}

/// The unit of each entry of A_I.
double calc_inertial_unit(int i, const UnitChange& c) { return (i < 3 ? c.length : 1) / (c.time * c.time); }

/// Rows 0..2 are translations, 3..5 rotations.
void scale_shapes(MatrixXd& phi, const UnitChange& c) {
  for (Eigen::Index i = 0; i < phi.rows(); ++i) phi.row(i) *= (i < 3 ? c.length : 1) / c.calc_modal();
}

void scale_full(FlexBody& body, const UnitChange& c) {
  for (Eigen::Index i = 0; i < body.dof_map.rows(); ++i) {
    // A scalar point moves like a translation.
    const bool is_turn = body.dof_map(i, 1) > 3;
    if (body.full_phi.size() > 0) body.full_phi.row(i) *= (is_turn ? 1 : c.length) / c.calc_modal();
    for (int k = 0; body.F_I.size() > 0 && k < kNumInertialLoads; ++k)
      body.F_I(i, k) *= c.calc_force() * (is_turn ? c.length : 1) / calc_inertial_unit(k, c);
  }
}

void scale_stiffening(FlexBody& body, const UnitChange& c) {
  const double e = c.calc_modal(), energy = c.calc_force() * c.length;
  for (int k = 0; k < kNumInertialLoads; ++k) {
    const double unit = calc_inertial_unit(k, c);
    body.kg_inertial[static_cast<std::size_t>(k)] *= energy / (e * e) / unit;
    if (body.preload_A_I.size() > k) body.preload_A_I(k) *= unit;
    if (body.inertial_load.cols() > k) body.inertial_load.col(k) *= energy / e / unit;
  }
  body.kg_preload *= energy / (e * e);
  for (std::size_t i = 0; i < body.locators.size(); ++i) {
    const double unit = calc_locator_unit(body.locators[i].direction, c);
    const auto col = static_cast<Eigen::Index>(i);
    body.kg_external[i] *= energy / (e * e) / unit;
    body.external_load.col(col) *= energy / e / unit;
    if (body.load_resultant.cols() > col) {
      body.load_resultant.col(col).head(3) *= c.calc_force() / unit;
      body.load_resultant.col(col).tail(3) *= energy / unit;
    }
    if (i < body.load_moment.size()) body.load_moment[i] *= energy / e / unit;
  }
}

void scale_third_order(FlexBody& body, const UnitChange& c) {
  ThirdOrder& third = body.third_order;
  if (third.empty()) return;
  const double e = c.calc_modal(), energy = c.calc_force() * c.length;
  for (int k = ThirdOrder::kMinEnergy; k <= ThirdOrder::kMaxEnergy; ++k)
    third.energy[static_cast<std::size_t>(k - ThirdOrder::kMinEnergy)] *= energy / std::pow(e, k);
  third.energy_small *= energy / std::pow(e, 3);
  for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField; ++k) {
    const auto at = static_cast<std::size_t>(k - ThirdOrder::kMinField);
    third.amplitudes[at] *= e / std::pow(e, k);
    for (auto& node : third.node) {
      node[at].leftCols(3) *= c.length / std::pow(e, k);
      node[at].rightCols(3) /= std::pow(e, k);
    }
    for (std::size_t i = 0; i < body.locators.size(); ++i)
      third.load[at].col(static_cast<Eigen::Index>(i)) *=
          energy / std::pow(e, k) / calc_locator_unit(body.locators[i].direction, c);
  }
  for (auto& psi : third.fields) scale_shapes(psi, c);  // their amplitudes have the unit of a modal coordinate
  third.coupling *= c.mass * c.length * c.length / (e * e);
  scale_integrals(third.integrals, c);
}

void scale_next_order(FlexBody& body, const UnitChange& c) {
  const double e = c.calc_modal(), energy = c.calc_force() * c.length;
  body.next_order.cubic *= energy / std::pow(e, 3);
  body.next_order.quartic *= energy / std::pow(e, 4);
}

void scale_recovery(FlexBody& body, const UnitChange& c) {
  for (auto& block : body.recovery) {
    const auto num = static_cast<Eigen::Index>(block.components.size());
    for (Eigen::Index row = 0; row < block.num_rows(); ++row) {
      const double unit = calc_component_unit(block.components[static_cast<std::size_t>(row % num)], c);
      if (block.matrix.size() > 0) block.matrix.row(row) *= unit / c.calc_modal();
      for (int k = ThirdOrder::kMinField; k <= ThirdOrder::kMaxField && block.has_beyond(); ++k)
        block.beyond[static_cast<std::size_t>(k - ThirdOrder::kMinField)].row(row) *=
            unit / std::pow(c.calc_modal(), k);
      for (int k = 0; k < block.inertial.cols(); ++k) block.inertial(row, k) *= unit / calc_inertial_unit(k, c);
      for (Eigen::Index k = 0; k < block.external.cols(); ++k)
        block.external(row, k) *= unit / calc_locator_unit(body.locators[static_cast<std::size_t>(k)].direction, c);
      if (block.offset.size() > 0) block.offset(row) *= unit;
    }
  }
}

}  // namespace

void change_units(FlexBody& body, const UnitChange& c) {
  const double e = c.calc_modal(), energy = c.calc_force() * c.length;
  body.mass *= c.mass;
  body.cg *= c.length;
  body.inertia *= c.mass * c.length * c.length;
  body.node_xyz *= c.length;
  body.frequency_hz /= c.time;
  body.eigenvalue /= c.time * c.time;
  for (auto& phi : body.phi) scale_shapes(phi, c);
  body.modal_mass *= c.mass * c.length * c.length / (e * e);
  body.modal_stiffness *= energy / (e * e);
  body.modal_damping *= energy * c.time / (e * e);
  if (body.effective_mass.size() > 0) {
    body.effective_mass.leftCols(3) *= c.mass;
    body.effective_mass.rightCols(3) *= c.mass * c.length * c.length;
  }
  for (auto* integrals : {&body.lumped, &body.consistent, &body.exact}) scale_integrals(*integrals, c);
  scale_full(body, c);
  scale_stiffening(body, c);
  scale_third_order(body, c);
  scale_next_order(body, c);
  scale_recovery(body, c);
  body.strain_energy.matrix *= energy / (e * e);
  body.mesh.grid_xyz *= c.length;
  body.mesh_phi *= static_cast<float>(c.length / c.calc_modal());
}

}  // namespace bough::records
