#include "fe/linear/null_space.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "fe/linear/fixed_number.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Start vectors without a preferred direction under D, the same in any units.
MatrixXd make_start(const VectorXd& root, Eigen::Index cols) {
  return MatrixXd::NullaryExpr(root.size(), cols, [&root](Eigen::Index i, Eigen::Index c) {
    return calc_fixed_number(static_cast<int>(i), static_cast<int>(c)) / root(i);
  });
}

void reduce_columns(MatrixXd& X) {
  for (Eigen::Index c = 0; c < X.cols(); ++c) {
    Eigen::Index row = 0, column = 0;
    X.rightCols(X.cols() - c).cwiseAbs().maxCoeff(&row, &column);
    X.col(c).swap(X.col(c + column));
    X.col(c) /= X(row, c);
    for (Eigen::Index other = 0; other < X.cols(); ++other)
      if (other != c) X.col(other) -= X(row, other) * X.col(c);
  }
}

/// Motions among the m softest with less energy than `max_energy`.
MatrixXd find_soft_motions(const SymmetricMatrix& K, const VectorXd& D, const SymmetricFactor& factor, Eigen::Index m,
                           double max_energy) {
  const SoftSpace space = calc_soft_space(K, D, factor, m);
  std::vector<int> found;
  for (int c = 0; c < m; ++c)
    if (space.energy[c] < max_energy) found.push_back(c);
  return space.X(Eigen::all, found);
}

}  // namespace

SoftSpace calc_soft_space(const SymmetricMatrix& K, const VectorXd& D, const SymmetricFactor& factor, Eigen::Index m) {
  const VectorXd root = D.cwiseSqrt();
  SoftSpace space{make_start(root, m), {}};
  MatrixXd& X = space.X;
  for (int iteration = 0; iteration < 6; ++iteration) {
    X = factor.solve(D.asDiagonal() * X);
    MatrixXd scaled = root.asDiagonal() * X;
    scaled = Eigen::HouseholderQR<MatrixXd>(scaled).householderQ() * MatrixXd::Identity(D.size(), m);
    X = root.cwiseInverse().asDiagonal() * scaled;
    const MatrixXd projected = X.transpose() * multiply(K, X);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(0.5 * (projected + projected.transpose()));
    X = (X * ritz.eigenvectors()).eval();
    space.energy = ritz.eigenvalues().cwiseAbs();
  }
  return space;
}

double calc_softest_energy(const SymmetricMatrix& K, const RowKinds& kinds, const SymmetricFactor& factor) {
  const VectorXd D = fill_diagonal(get_diagonal(K), kinds);
  VectorXd x = factor.solve(D.cwiseProduct(make_start(D.cwiseSqrt(), 1).col(0)));
  const double size = x.dot(D.cwiseProduct(x));
  if (!(size > 0) || !std::isfinite(size)) return 0;
  x /= std::sqrt(size);
  return std::abs(x.dot(multiply(K, x).col(0)));
}

MatrixXd find_mechanisms(const SymmetricMatrix& K, const RowKinds& kinds, int expected, double max_energy) {
  const VectorXd D = fill_diagonal(get_diagonal(K), kinds);
  const Eigen::Index n = D.size();
  const SymmetricFactor factor(add_diagonal(K, kNullShift * D), false, FactorMethod::Pivoting);
  if (factor.is_singular()) return MatrixXd(n, 0);
  const Eigen::Index m = std::min<Eigen::Index>(n, std::clamp(expected + 2, 6, kMaxMechanisms));
  MatrixXd basis = find_soft_motions(K, D, factor, m, max_energy);
  const Eigen::Index all = std::min<Eigen::Index>(n, kMaxMechanisms);
  if (basis.cols() == m && m < all)
    basis = find_soft_motions(K, D, factor, all, max_energy);  // there may be more of them
  reduce_columns(basis);
  return basis;
}

}  // namespace bough::linear
