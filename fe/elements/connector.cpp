#include "fe/elements/connector.hpp"

#include "fe/elements/carried.hpp"
#include "fe/elements/solve_in_range.hpp"

namespace bough::fe {

Connector::Connector(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, ConnectorData data,
                     std::unique_ptr<const Element> core)
    : Element(id, std::move(card), std::move(nodes), std::move(gdofs)), data_(std::move(data)), core_(std::move(core)) {
  BOUGH_DEMAND(core_->num_dofs() == 12 && core_->stress_state() != nullptr);
  BOUGH_DEMAND(data_.G.rows() == 12 && data_.G.cols() == num_dofs());
  BOUGH_DEMAND(data_.ends.empty() || data_.ends.size() == 2);
  const StressState& state = *core_->stress_state();
  MatrixXd K_c = MatrixXd::Zero(12, 12), F(state.num_internal_forces(), 12);
  core_->add_stiffness(1, K_c);
  state.calc_internal_forces_of(MatrixXd::Identity(12, 12), F);
  // K_c = Fᵀ E⁺ F, E = F K_c⁺ Fᵀ the stiffness of the internal forces.
  const MatrixXd E = F * solve_in_range(K_c, F.transpose());
  end_forces_ = solve_in_range(E, F).transpose();
}

void Connector::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  MatrixXd K_c = MatrixXd::Zero(12, 12);
  core_->add_stiffness(scale, K_c);
  K.noalias() += data_.G.transpose() * K_c * data_.G;
}

void Connector::add_mass(MassKind, double scale, Eigen::Ref<MatrixXd> M) const {
  const MatrixXd W = 0.5 * scale * data_.mass * data_.weights.transpose() * data_.weights;
  for (Eigen::Index i = 0; i < W.rows(); ++i)
    for (Eigen::Index j = 0; j < W.cols(); ++j) M.block<3, 3>(6 * i, 6 * j).diagonal().array() += W(i, j);
}

void Connector::calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const {
  const VectorXd q = data_.G * u;
  core_->stress_state()->calc_internal_forces(q, force);
}

void Connector::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                        Eigen::Ref<MatrixXd> K_G) const {
  MatrixXd K_c = MatrixXd::Zero(12, 12);
  core_->stress_state()->add_geometric_stiffness(force, scale, K_c);
  K_G.noalias() += data_.G.transpose() * K_c * data_.G;
  const VectorXd on_ends = scale * (end_forces_ * force);
  for (std::size_t k = 0; k < data_.ends.size(); ++k) {
    const auto& shares = data_.ends[k].shares;
    const auto& rotation = data_.ends[k].rotation;
    const auto first = 6 * static_cast<Eigen::Index>(k);
    const Vector3d f = on_ends.segment<3>(first);
    const Vector3d moment = on_ends.segment<3>(first + 3) + rotation.arm.cross(f);
    const auto turn = data_.G.middleRows<3>(first + 3);
    K_G.noalias() -= turn.transpose() * calc_arm_stiffness(f, rotation.arm) * turn;
    Eigen::Matrix<double, 12, 12> form = Eigen::Matrix<double, 12, 12>::Zero();
    for (int c = 0; c < 3; ++c) form += moment[c] * rotation.forms[static_cast<std::size_t>(c)];
    for (Eigen::Index i = 0; i < shares.cols(); ++i)
      for (Eigen::Index j = 0; j < shares.cols(); ++j)
        for (Eigen::Index a = 0; a < 4; ++a)
          for (Eigen::Index b = 0; b < 4; ++b)
            K_G.block<3, 3>(6 * i, 6 * j) += shares(a, i) * shares(b, j) * form.block<3, 3>(3 * a, 3 * b);
  }
}

}  // namespace bough::fe
