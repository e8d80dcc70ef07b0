#include "modal/canonical.hpp"

#include <cmath>
#include <utility>

#include "fe/linear/blas.hpp"
#include "fe/linear/factor.hpp"
#include "fe/linear/fixed_number.hpp"
#include "fe/linear/products.hpp"
#include "modal/tolerances.hpp"

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
  const double size = std::max((high - low).norm(), kTiny);
  VectorXd weights = VectorXd::Zero(model.num_gdofs());
  for (std::size_t k = 0; k < model.nodes().size(); ++k) {
    const auto& node = model.nodes()[k];
    const double own = 1.25 + 0.25 * linear::calc_fixed_number(static_cast<int>(k), 7);
    for (int c = 0; c < node.num_dofs; ++c)
      weights(node.first_gdof + c) = own * (c + 1) * (c < 3 ? 1.0 : 0.01 * size * size);
  }
  return weights;
}

MatrixXd calc_cluster_rotation(const VectorXd& weights, const Eigen::Ref<const MatrixXd>& Phi) {
  const MatrixXd W = Phi.transpose() * weights.asDiagonal() * Phi;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(linear::symmetrize(W));
  return solver.eigenvectors();
}

void orthonormalize_ascending(const MatrixXd& G, MatrixXd& X) {
  if (X.cols() == 0) return;
  const Eigen::LLT<MatrixXd> cholesky(linear::symmetrize(G));
  MatrixXd inverse = MatrixXd::Identity(G.rows(), G.cols());
  if (cholesky.info() == Eigen::Success)
    inverse = cholesky.matrixU().solve(inverse);
  else
    inverse = Eigen::SelfAdjointEigenSolver<MatrixXd>(linear::symmetrize(G)).operatorInverseSqrt();
  MatrixXd Y(X.rows(), X.cols());
  linear::multiply_dense(false, X, inverse, 0, Y);
  X = std::move(Y);
}

void project_out(const linear::SymmetricMatrix& M, const MatrixXd& R, MatrixXd& X) {
  if (R.cols() == 0) return;
  const MatrixXd MR = linear::multiply(M, R);
  for (int pass = 0; pass < 2; ++pass) X -= R * linear::calc_inner_products(MR, X);
}

VectorXd find_largest(const Eigen::Ref<const MatrixXd>& X) {
  constexpr double kEqual = 1e-6;
  VectorXd largest = VectorXd::Zero(X.cols());
  for (Eigen::Index j = 0; j < X.cols() && X.rows() > 0; ++j) {
    const double limit = (1 - kEqual) * X.col(j).cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < X.rows(); ++i) {
      if (std::abs(X(i, j)) < limit) continue;
      largest(j) = X(i, j);
      break;
    }
  }
  return largest;
}

void fix_signs(MatrixXd& Phi) {
  const VectorXd largest = find_largest(Phi);
  for (Eigen::Index j = 0; j < Phi.cols(); ++j)
    if (largest(j) < 0) Phi.col(j) *= -1;
}

int find_cluster_end(const VectorXd& values, int first, double tolerance, double floor) {
  int end = first + 1;
  while (end < values.size() && std::abs(values(end) - values(end - 1)) <= tolerance * (std::abs(values(end)) + floor))
    ++end;
  return end;
}

void make_canonical(const VectorXd& weights, int first, const std::function<int(int)>& find_end,
                    const std::function<MatrixXd(const MatrixXd&)>& expand, VectorXd& values, MatrixXd& X,
                    MatrixXd* rotation) {
  for (int a = first, b = first; a < values.size(); a = b) {
    b = find_end(a);
    if (b == a + 1) continue;
    const MatrixXd Y = X.middleCols(a, b - a), Q = calc_cluster_rotation(weights, expand(Y));
    X.middleCols(a, b - a) = Y * Q;
    if (rotation) rotation->middleCols(a, b - a) = (rotation->middleCols(a, b - a) * Q).eval();
    values.segment(a, b - a).setConstant(values.segment(a, b - a).mean());
  }
}

void make_canonical(const VectorXd& weights, const std::function<MatrixXd(const MatrixXd&)>& expand, VectorXd& values,
                    MatrixXd& X, MatrixXd* rotation) {
  make_canonical(
      weights, 0, [&](int a) { return find_cluster_end(values, a, kCloseness, 0); }, expand, values, X, rotation);
}

}  // namespace bough::modal::detail
