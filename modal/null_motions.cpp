#include "modal/null_motions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fe/linear/null_space.hpp"
#include "fe/linear/products.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "modal/canonical.hpp"
#include "modal/extraction.hpp"
#include "modal/roots.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::detail {
namespace {

using Eigen::Index;

/// diag K; for a DOF without stiffness a value in proportion to its mass.
VectorXd calc_scale(const Pencil& pencil) {
  const VectorXd &D = pencil.K_diagonal, &M = pencil.M_diagonal;
  VectorXd scale = linear::fill_diagonal(D, pencil.kinds);
  double mass = 0;  // per stiffness
  for (Index i = 0; i < D.size(); ++i)
    if (D(i) == scale(i)) mass = std::max(mass, M(i) / D(i));
  for (Index i = 0; i < D.size(); ++i)
    if (D(i) != scale(i) && mass > 0 && M(i) > 0) scale(i) = M(i) / mass;
  return scale;
}

/// The D-orthonormal motions of K whose forces are roundoff, found among m; all of them where fewer than m come out.
MatrixXd find_null_motions_of(const Pencil& pencil, const VectorXd& D, const linear::SymmetricFactor& factor, Index m) {
  const auto space = linear::calc_soft_space(pencil.K, D, factor, m);
  std::vector<Index> low;
  for (Index c = 0; c < m; ++c)
    if (space.energy(c) < kStrainlessEnergy) low.push_back(c);
  const MatrixXd Y = space.X(Eigen::all, low);
  return Y.cols() > 0 ? (Y * find_forceless(pencil, Y, kIterationForce)).eval() : Y;
}

/// Nothing when they are too many, or the factor fails.
std::optional<MatrixXd> find_null_space(const Pencil& pencil, const VectorXd& D, int expected) {
  const linear::SymmetricFactor factor(linear::add_diagonal(pencil.K, linear::kNullShift * D), false,
                                       linear::FactorMethod::Pivoting);
  if (factor.is_singular()) return std::nullopt;
  constexpr Index max_motions = 400;
  for (Index m = expected + 6;; m *= 2) {
    m = std::min<Index>({m, max_motions, pencil.size()});
    MatrixXd Y = find_null_motions_of(pencil, D, factor, m);
    if (Y.cols() < m || m == pencil.size()) return Y;
    if (m == max_motions) return std::nullopt;
  }
}

void append(MatrixXd& A, const MatrixXd& B) { A = join(A, B); }

/// Makes the D-orthonormal motions Y orthogonal under D and M, normal under M, by descending mass. In rounds: a motion
/// with little mass per D among such with much keeps its digits. Those that have none in roundoff, next to their parts
/// or next to the others, go to `massless`: as modes their zero would be vague by 1e-3 of the others.
MatrixXd split_by_mass(const Pencil& pencil, const VectorXd& D, MatrixXd Y, MatrixXd& massless) {
  MatrixXd heavy(Y.rows(), 0);
  const double nothing = kDofMassShare * (pencil.M_diagonal.array() / D.array()).maxCoeff();  // of a single dof
  double max_motions = 0;
  while (Y.cols() > 0) {
    for (int pass = 0; pass < 2 && heavy.cols() > 0; ++pass)
      Y -= heavy * (pencil.calc_M_times(heavy).transpose() * Y).eval();
    Y *= (Y.cwiseAbs2().transpose() * D).cwiseSqrt().cwiseInverse().asDiagonal();
    const MatrixXd G = Y.transpose() * pencil.calc_M_times(Y);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(linear::symmetrize(G));
    Y = (Y * solver.eigenvectors()).eval();
    const VectorXd mass = solver.eigenvalues(), parts = Y.cwiseAbs2().transpose() * pencil.M_diagonal;
    max_motions = std::max(max_motions, mass.maxCoeff());
    std::vector<Index> next, none, later;
    for (Index c = Y.cols() - 1; c >= 0; --c) {
      const bool is_light = !(mass(c) > std::max(kMasslessShare * std::max(parts(c), max_motions), nothing));
      (is_light ? none : mass(c) > kMassRound * mass.maxCoeff() ? next : later).push_back(c);
    }
    append(massless, Y(Eigen::all, none));
    append(heavy, Y(Eigen::all, next) * mass(next).cwiseSqrt().cwiseInverse().asDiagonal());
    Y = Y(Eigen::all, later).eval();
  }
  return heavy;
}

/// Chooses one DOF for each column of X so that constraining them constrains every combination of the columns.
std::vector<int> choose_dofs(const VectorXd& D, const MatrixXd& X) {
  std::vector<int> dofs;
  if (X.cols() == 0) return dofs;
  MatrixXd scaled = D.cwiseSqrt().asDiagonal() * X;
  const VectorXd norms = scaled.colwise().norm().transpose();  // not lazily: the product changes what they are of
  scaled *= norms.cwiseInverse().asDiagonal();
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(scaled.transpose());
  for (Index i = 0; i < X.cols(); ++i) dofs.push_back(static_cast<int>(qr.colsPermutation().indices()(i)));
  return dofs;
}

/// The motions in the span of Z that are M-orthogonal to its subspace R, ordered as by split_by_mass; motions of equal
/// mass have the canonical basis of repeated eigenvalues.
MatrixXd complement(const Pencil& pencil, const VectorXd& D, const MatrixXd& R, const MatrixXd& Z) {
  const Index left = Z.cols() - R.cols();
  if (left <= 0) return MatrixXd(Z.rows(), 0);
  MatrixXd X = Z * (Z.cwiseAbs2().transpose() * D).cwiseSqrt().cwiseInverse().asDiagonal();
  for (int pass = 0; pass < 2 && R.cols() > 0; ++pass) X -= R * (pencil.calc_M_times(R).transpose() * X).eval();
  const VectorXd root = D.cwiseSqrt();
  const Eigen::JacobiSVD<MatrixXd> svd(root.asDiagonal() * X, Eigen::ComputeThinU);
  MatrixXd none(Z.rows(), 0);
  X = split_by_mass(pencil, D, root.cwiseInverse().asDiagonal() * svd.matrixU().leftCols(left), none);
  const VectorXd weights = calc_basis_weights(pencil.model), size = X.cwiseAbs2().transpose() * D;
  for (Index a = 0, b = 0; a < X.cols(); a = b) {
    b = find_cluster_end(size, static_cast<int>(a), kMassRound, 0);
    const MatrixXd Y = X.middleCols(a, b - a);
    X.middleCols(a, b - a) = Y * calc_cluster_rotation(weights, pencil.model.T() * Y);
  }
  return X;
}

}  // namespace

RigidMotions find_null_motions(const Pencil& pencil) {
  auto result = find_rigid_motions(pencil);
  const VectorXd D = calc_scale(pencil);
  const auto Y = find_null_space(pencil, D, static_cast<int>(result.modes.cols() + result.massless.cols()));
  if (!Y) return result;
  result.is_complete = true;
  result.massless.resize(pencil.size(), 0);
  const MatrixXd Z = split_by_mass(pencil, D, *Y, result.massless);
  // The motions of the whole in their order, as far as the iteration has them.
  MatrixXd R(pencil.size(), 0);
  for (Index i = 0; i < result.modes.cols(); ++i) {
    MatrixXd x = Z * (Z.transpose() * pencil.calc_M_times(result.modes.col(i)));
    for (int pass = 0; pass < 2 && R.cols() > 0; ++pass) x -= R * (pencil.calc_M_times(R).transpose() * x).eval();
    const double mass = x.cwiseProduct(pencil.calc_M_times(x)).sum();
    if (mass > kOwnMassShare) append(R, x / std::sqrt(mass));
  }
  result.modes = join(R, complement(pencil, D, R, Z));
  result.held = choose_dofs(D, result.massless);
  if (!result.held.empty()) {
    const MatrixXd at_held = result.massless(result.held, Eigen::all);
    result.modes -= result.massless * at_held.partialPivLu().solve(MatrixXd(result.modes(result.held, Eigen::all)));
  }
  // Components along massless motions were added and subtracted: their round-off shows in M.
  orthonormalize(pencil, result.modes);
  result.supports = choose_dofs(D, result.modes);
  return result;
}

}  // namespace bough::modal::detail
