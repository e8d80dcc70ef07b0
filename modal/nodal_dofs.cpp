#include "modal/nodal_dofs.hpp"

#include "base/diagnostic.hpp"
#include "base/rotation.hpp"

namespace bough::modal {

NodalDofs NodalDofs::from_model(const fe::Model& model) {
  NodalDofs dofs;
  const auto is_grid = [](const auto& node) { return node.num_dofs == 6; };
  const auto p = std::count_if(model.nodes().begin(), model.nodes().end(), is_grid);
  dofs.num_dofs = model.num_gdofs();
  dofs.xyz.resize(p, 3);
  dofs.row.resize(p, 6);
  Eigen::Index k = 0;
  for (const auto& node : model.nodes()) {
    if (!is_grid(node)) continue;
    dofs.xyz.row(k) = node.x;
    for (int a = 0; a < 6; ++a) dofs.row(k, a) = node.first_gdof + a;
    ++k;
  }
  return dofs;
}

NodalDofs NodalDofs::from_map(const Eigen::Ref<const Eigen::MatrixXi>& dof_map, const MatrixXd& xyz) {
  NodalDofs dofs;
  dofs.num_dofs = static_cast<int>(dof_map.rows());
  dofs.xyz = xyz;
  dofs.row.setConstant(xyz.rows(), 6, -1);
  for (int i = 0; i < dofs.num_dofs; ++i) {
    const int node = dof_map(i, 0), code = dof_map(i, 1);
    if (code < 1 || code > 6) continue;
    BOUGH_DEMAND(node >= 1 && node <= xyz.rows());
    dofs.row(node - 1, code - 1) = i;
  }
  return dofs;
}

MatrixXd NodalDofs::gather(const Eigen::Ref<const MatrixXd>& X, int k) const {
  MatrixXd block(6, X.cols());
  for (int a = 0; a < 6; ++a) {
    if (row(k, a) >= 0)
      block.row(a) = X.row(row(k, a));
    else
      block.row(a).setZero();
  }
  return block;
}

void NodalDofs::scatter(const Eigen::Ref<const MatrixXd>& block, int k, Eigen::Ref<MatrixXd> X) const {
  for (int a = 0; a < 6; ++a)
    if (row(k, a) >= 0) X.row(row(k, a)) = block.row(a);
}

MatrixXd NodalDofs::calc_rigid_modes(const Vector3d& reference) const {
  MatrixXd Phi_R = MatrixXd::Zero(num_dofs, 6);
  Eigen::Matrix<double, 6, 6> block = Eigen::Matrix<double, 6, 6>::Identity();
  for (int k = 0; k < num_nodes(); ++k) {
    block.topRightCorner<3, 3>() = -skew(xyz.row(k).transpose() - reference);
    scatter(block, k, Phi_R);
  }
  return Phi_R;
}

}  // namespace bough::modal
