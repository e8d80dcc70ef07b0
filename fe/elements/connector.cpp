#include "fe/elements/connector.hpp"

namespace bough::fe {

Connector::Connector(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, ConnectorData data,
                     std::unique_ptr<const Element> core)
    : Element(id, std::move(card), std::move(nodes), std::move(gdofs)), data_(std::move(data)), core_(std::move(core)) {
  BOUGH_DEMAND(core_->num_dofs() == 12 && core_->stress_state() != nullptr);
  BOUGH_DEMAND(data_.G.rows() == 12 && data_.G.cols() == num_dofs());
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
}

}  // namespace bough::fe
