#include "fe/linear/mechanism.hpp"

#include <algorithm>
#include <random>

#include <Eigen/Eigenvalues>

#include "fe/linear/ranks.hpp"

namespace bough::fe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd make_random(Eigen::Index rows, Eigen::Index cols) {
  std::mt19937 generator(20111);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return MatrixXd::NullaryExpr(rows, cols, [&] { return uniform(generator); });
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

/// Those of m motions that strain next to nothing, by inverse iteration on a subspace.
MatrixXd find_soft_motions(const SymmetricMatrix& K, const VectorXd& D, const SymmetricFactor& factor, Eigen::Index m,
                           double most) {
  const Eigen::Index n = D.size();
  MatrixXd X = make_random(n, m);
  VectorXd energy;
  for (int iteration = 0; iteration < 5; ++iteration) {
    X = factor.solve(D.asDiagonal() * X);
    for (Eigen::Index c = 0; c < m; ++c) X.col(c) /= std::sqrt(X.col(c).dot(D.cwiseProduct(X.col(c))));
    // An orthonormal basis under D, then its Ritz vectors.
    MatrixXd scaled = D.cwiseSqrt().asDiagonal() * X;
    scaled = Eigen::HouseholderQR<MatrixXd>(scaled).householderQ() * MatrixXd::Identity(n, m);
    X = D.cwiseSqrt().cwiseInverse().asDiagonal() * scaled;
    MatrixXd projected = X.transpose() * fe::multiply(K, X);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(0.5 * (projected + projected.transpose()));
    X = (X * ritz.eigenvectors()).eval();
    energy = ritz.eigenvalues().cwiseAbs();
  }
  std::vector<int> found;
  for (int c = 0; c < m; ++c)
    if (energy[c] < most) found.push_back(c);
  return X(Eigen::all, found);
}

}  // namespace

double calc_softest_energy(const SymmetricMatrix& K, const RowKinds& kinds, const SymmetricFactor& factor) {
  const VectorXd D = fill_diagonal(get_diagonal(K), kinds);
  VectorXd x = factor.solve(D.cwiseProduct(make_random(D.size(), 1).col(0)));
  const double size = x.dot(D.cwiseProduct(x));
  if (!(size > 0) || !std::isfinite(size)) return 0;
  x /= std::sqrt(size);
  return std::abs(x.dot(multiply(K, x).col(0)));
}

MatrixXd find_mechanisms(const SymmetricMatrix& K, const RowKinds& kinds, int expected, double most) {
  const VectorXd D = fill_diagonal(get_diagonal(K), kinds);
  const Eigen::Index n = D.size();
  const SymmetricFactor factor(add_diagonal(K, 1e-13 * D), false, FactorMethod::Pivoting);
  if (factor.is_singular()) return MatrixXd(n, 0);
  const Eigen::Index m = std::min<Eigen::Index>(n, std::clamp(expected + 2, 6, kMostMechanisms));
  MatrixXd basis = find_soft_motions(K, D, factor, m, most);
  const Eigen::Index all = std::min<Eigen::Index>(n, kMostMechanisms);
  if (basis.cols() == m && m < all) basis = find_soft_motions(K, D, factor, all, most);  // there may be more of them
  reduce_columns(basis);
  return basis;
}

}  // namespace bough::fe
