#include "modal/matrix_body.hpp"

#include <cmath>
#include <numbers>

#include "base/diagnostic.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal {

namespace {

MatrixXd calc_damping(const records::FlexBody& body, double zeta, Diagnostics& diagnostics) {
  const Eigen::ArrayXd mass = body.modal_mass.diagonal();
  const double worst = (mass - 1).abs().maxCoeff();
  if (zeta > 0 && worst > detail::kShapeDigits) {
    diagnostics.warning("modal.damping-not-normalized", {},
                        "the generalized masses differ from 1 by up to " + std::to_string(worst) +
                            ": damping by ratio, 2 zeta sqrt(K/M), holds for unit generalized mass",
                        "scale the modes to unit generalized mass, or give the damping matrix");
  }
  return (2 * zeta * (body.modal_stiffness.diagonal().array() / mass).max(0).sqrt()).matrix().asDiagonal();
}

}  // namespace

records::FlexBody calc_matrix_body(const MatrixModel& model, const std::vector<int>& nodes, Diagnostics& diagnostics) {
  BOUGH_DEMAND(model.Phi.rows() == model.dofs.num_dofs && model.M.rows() == model.dofs.num_dofs);
  const auto n = model.Phi.cols();
  records::FlexBody body;
  body.mass = model.mass;
  body.modal_mass = model.Phi.transpose() * (model.M * model.Phi);
  body.modal_stiffness = model.Phi.transpose() * (model.K * model.Phi);
  const Eigen::VectorXd mass = body.modal_mass.diagonal();
  for (Eigen::Index j = 0; j < n; ++j) {
    if (mass[j] > 0) continue;
    throw InputError("modal.no-modal-mass", {},
                     "mode " + std::to_string(j + 1) + " of those kept has the generalized mass " +
                         std::to_string(mass[j]) + ", expected more than zero",
                     "check the mass matrix and the mode shapes");
  }
  body.eigenvalue = body.modal_stiffness.diagonal().cwiseQuotient(mass);
  body.frequency_hz = body.eigenvalue.cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  body.kind.assign(static_cast<std::size_t>(n), records::ModeKind::Normal);
  body.modal_damping = model.D.size() > 0 ? MatrixXd(model.Phi.transpose() * (model.D * model.Phi))
                                          : calc_damping(body, model.zeta, diagnostics);

  const MassTimes mass_times = [&](const MatrixXd& X) -> MatrixXd { return model.M * X; };
  body.consistent = calc_momentum_integrals(model.dofs, mass_times, model.Phi, model.reference);
  body.exact = calc_exact_integrals(model.dofs, mass_times, model.Phi, model.reference);
  body.integrals_method = "consistent";
  body.masses = "nodal momenta";

  body.node_id = nodes;
  body.node_xyz.resize(static_cast<Eigen::Index>(nodes.size()), 3);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const int k = nodes[i] - 1;
    BOUGH_DEMAND(k >= 0 && k < model.dofs.num_nodes());
    body.node_xyz.row(static_cast<Eigen::Index>(i)) = model.dofs.xyz.row(k) - model.reference.transpose();
    body.phi.push_back(model.dofs.gather(model.Phi, k));
  }
  return body;
}

}  // namespace bough::modal
