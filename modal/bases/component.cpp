#include "modal/bases/component.hpp"

#include <algorithm>

#include "fe/linear/blas.hpp"
#include "fe/linear/products.hpp"

namespace bough::modal::bases {
namespace {

MatrixXd calc_gram(const MatrixXd& X, const MatrixXd& A_X) {
  return linear::symmetrize(linear::calc_inner_products(X, A_X));
}

/// Columns in basic axes of those in the displacement axes of each grid.
MatrixXd turn_to_basic(const fe::Model& model, const std::vector<int>& grids, const MatrixXd& Psi) {
  MatrixXd turned(Psi.rows(), Psi.cols());
  for (std::size_t k = 0; k < grids.size(); ++k) {
    const auto& R = model.node(model.find_node(grids[k])).R_basic_cd;
    for (int part = 0; part < 2; ++part) {
      const auto first = static_cast<Eigen::Index>(6 * k) + 3 * part;
      turned.middleCols<3>(first) = Psi.middleCols<3>(first) * R.transpose();
    }
  }
  return turned;
}

void demand_all(const std::vector<int>& grids, const Partition& partition) {
  const auto& boundary = partition.boundary;
  for (const int id : grids)
    for (int c = 1; c <= 6; ++c)
      if (std::find(boundary.begin(), boundary.end(), std::pair(id, c)) == boundary.end())
        throw InputError("modal.held-boundary", {},
                         "component " + std::to_string(c) + " of boundary grid " + std::to_string(id) +
                             " is held, depends on other degrees of freedom or has no stiffness",
                         "free it (SPC, MPC, AUTOSPC), or take another grid as boundary");
}

}  // namespace

Component calc_component(const fe::System& system, const ComponentOptions& options, Diagnostics& diagnostics) {
  const fe::Model& model = system.model;
  Component component;
  component.boundary = options.boundary;
  std::sort(component.boundary.begin(), component.boundary.end());
  const FixedInterface fixed(system, component.boundary, diagnostics);
  demand_all(component.boundary, fixed.partition());
  const MatrixXd Psi = turn_to_basic(model, component.boundary, fixed.calc_constraint_modes());
  const auto modes = fixed.calc_modes(options.num_modes, options.max_hz, diagnostics, options.solver);
  MatrixXd F(model.num_gdofs(), 0);
  if (options.has_inertial_residuals) F = fe::calc_mass_times(model, model.mass_kind(), model.calc_rigid_modes());
  const auto residual = calc_residual_vectors(
      model, [&](const MatrixXd& loads) { return fixed.solve(loads); }, MatrixXd(model.num_gdofs(), 0), modes.Phi, F);

  const auto nb = Psi.cols(), nm = modes.Phi.cols(), nq = nm + residual.modes.Phi.cols();
  component.num_modes = static_cast<int>(nm);
  component.shapes.resize(model.num_gdofs(), nb + nq);
  component.shapes << Psi, modes.Phi, residual.modes.Phi;
  component.lambda.resize(nq);
  component.lambda << modes.lambda, residual.modes.lambda;
  const MatrixXd& X = component.shapes;
  // Constraint modes and fixed-interface modes have no common strain energy.
  component.K = MatrixXd::Zero(nb + nq, nb + nq);
  component.K.topLeftCorner(nb, nb) = calc_gram(Psi, fe::calc_stiffness_times(model, Psi));
  component.K.bottomRightCorner(nq, nq) = component.lambda.asDiagonal();
  component.M = calc_gram(X, fe::calc_mass_times(model, model.mass_kind(), X));
  component.M.bottomRightCorner(nq, nq).setIdentity();
  if (fe::has_damping(model)) component.B = calc_gram(X, fe::calc_damping_times(model, X));
  const MatrixXd K4 = calc_gram(X, fe::calc_structural_damping_times(model, 0, X));
  if (!K4.isZero(0)) component.K4 = K4;
  return component;
}

}  // namespace bough::modal::bases
