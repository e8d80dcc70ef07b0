#include "modal/canonical.hpp"

#include <cmath>

#include "fe/linear/blas.hpp"
#include "modal/krylov.hpp"

namespace bough::modal::detail {

VectorXd calc_basis_weights(const fe::Model& model) {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
  bool any = false;
  for (const auto& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    low = any ? low.cwiseMin(node.x).eval() : node.x;
    high = any ? high.cwiseMax(node.x).eval() : node.x;
    any = true;
  }
  const double size = std::max((high - low).norm(), 1e-300);
  VectorXd weights = VectorXd::Zero(model.num_gdofs());
  for (std::size_t k = 0; k < model.nodes().size(); ++k) {
    const auto& node = model.nodes()[k];
    const double own = 1.25 + 0.25 * calc_fixed_number(static_cast<int>(k), 7);
    for (int c = 0; c < node.num_dofs; ++c)
      weights(node.first_gdof + c) = own * (c + 1) * (c < 3 ? 1.0 : 0.01 * size * size);
  }
  return weights;
}

MatrixXd calc_cluster_rotation(const VectorXd& weights, const Eigen::Ref<const MatrixXd>& Phi) {
  const MatrixXd W = Phi.transpose() * weights.asDiagonal() * Phi;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(0.5 * (W + W.transpose()));
  return solver.eigenvectors();
}

void orthonormalize_ascending(const MatrixXd& G, MatrixXd& X) {
  if (X.cols() == 0) return;
  const Eigen::LLT<MatrixXd> cholesky(0.5 * (G + G.transpose()));
  MatrixXd inverse = MatrixXd::Identity(G.rows(), G.cols());
  if (cholesky.info() == Eigen::Success)
    inverse = cholesky.matrixU().solve(inverse);
  else
    inverse = Eigen::SelfAdjointEigenSolver<MatrixXd>(0.5 * (G + G.transpose())).operatorInverseSqrt();
  const MatrixXd Y = X;
  fe::multiply_dense(false, Y, inverse, 0, X);
}

void fix_signs(MatrixXd& Phi) {
  for (Eigen::Index j = 0; j < Phi.cols(); ++j) {
    if (Phi.rows() == 0) return;
    const double largest = Phi.col(j).cwiseAbs().maxCoeff();
    Eigen::Index i = 0;
    while (std::abs(Phi(i, j)) < (1 - 1e-6) * largest) ++i;
    if (Phi(i, j) < 0) Phi.col(j) *= -1;
  }
}

int find_cluster_end(const VectorXd& values, int first, double tolerance, double floor) {
  int end = first + 1;
  while (end < values.size() && std::abs(values(end) - values(end - 1)) <= tolerance * (std::abs(values(end)) + floor))
    ++end;
  return end;
}

}  // namespace bough::modal::detail
