#include "bough/modal/null_motions.hpp"

#include <algorithm>
#include <cmath>

#include "bough/fe/factor.hpp"
#include "bough/modal/canonical.hpp"
#include "bough/modal/krylov.hpp"

namespace bough::modal::detail {
namespace {

using Eigen::Index;

/// diag K with a plain value where nothing stiffens a dof.
VectorXd calc_scale(const Pencil& pencil) {
  VectorXd D = pencil.K_diagonal;
  const double largest = D.maxCoeff();
  for (double& d : D)
    if (d <= 1e-14 * largest) d = largest > 0 ? largest : 1;
  return D;
}

/// The D-orthonormal motions of K whose forces are roundoff, by inverse iteration of K + 1e-13 D on `m` vectors; all of
/// them where fewer than m come out.
MatrixXd iterate(const Pencil& pencil, const VectorXd& D, const fe::SymmetricFactor& factor, Index m) {
  const VectorXd root = D.cwiseSqrt();
  MatrixXd X(pencil.size(), m);
  for (Index c = 0; c < m; ++c)
    for (int i = 0; i < pencil.size(); ++i) X(i, c) = calc_fixed_number(i, static_cast<int>(c)) / root(i);
  VectorXd energy;
  for (int iteration = 0; iteration < 6; ++iteration) {
    X = factor.solve(D.asDiagonal() * X);
    MatrixXd scaled = root.asDiagonal() * X;
    scaled = Eigen::HouseholderQR<MatrixXd>(scaled).householderQ() * MatrixXd::Identity(pencil.size(), m);
    X = root.cwiseInverse().asDiagonal() * scaled;
    const MatrixXd projected = X.transpose() * pencil.calc_K_times(X);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(0.5 * (projected + projected.transpose()));
    X = (X * ritz.eigenvectors()).eval();
    energy = ritz.eigenvalues().cwiseAbs();
  }
  std::vector<Index> low;
  for (Index c = 0; c < m; ++c)
    if (energy(c) < 1e-13) low.push_back(c);
  const MatrixXd Y = X(Eigen::all, low);
  return Y.cols() > 0 ? (Y * find_forceless(pencil, Y)).eval() : Y;
}

MatrixXd find_null_space(const Pencil& pencil, const VectorXd& D, int expected) {
  fe::PetscMat shifted;
  fe::check_petsc(MatDuplicate(pencil.K.get(), MAT_COPY_VALUES, shifted.out()));
  fe::PetscVec shift;
  fe::check_petsc(MatCreateVecs(pencil.K.get(), shift.out(), nullptr));
  fe::scatter(1e-13 * D, shift.get());
  fe::check_petsc(MatDiagonalSet(shifted.get(), shift.get(), ADD_VALUES));
  const fe::SymmetricFactor factor(shifted.get(), false, fe::FactorMethod::Pivoting);
  if (factor.is_singular()) return MatrixXd(pencil.size(), 0);
  constexpr Index most = 400;
  for (Index m = expected + 6;; m *= 2) {
    m = std::min<Index>({m, most, pencil.size()});
    MatrixXd Y = iterate(pencil, D, factor, m);
    if (Y.cols() < m || m == pencil.size()) return Y;
    if (m == most) return MatrixXd(pencil.size(), 0);
  }
}

/// Each column gets a unit entry in D-scale (largest by complete pivoting) where the others are zero: motions of
/// separate parts come apart.
void separate(const VectorXd& D, MatrixXd& Y) {
  const VectorXd root = D.cwiseSqrt();
  MatrixXd X = root.asDiagonal() * Y;
  for (Index c = 0; c < X.cols(); ++c) {
    Index row = 0, column = 0;
    X.rightCols(X.cols() - c).cwiseAbs().maxCoeff(&row, &column);
    X.col(c).swap(X.col(c + column));
    X.col(c) /= X(row, c);
    for (Index other = 0; other < X.cols(); ++other)
      if (other != c) X.col(other) -= X(row, other) * X.col(c);
  }
  Y = root.cwiseInverse().asDiagonal() * X;
}

VectorXd calc_masses(const Pencil& pencil, const MatrixXd& Y) {
  return Y.cwiseProduct(pencil.M_diagonal.asDiagonal() * Y).colwise().sum();
}

/// Splits the motions by whether they move mass; `light`: the share of its parts' masses below which a motion has none.
void split_by_mass(const Pencil& pencil, const VectorXd& D, MatrixXd& Y, MatrixXd& massless) {
  constexpr double light = 1e-13;
  separate(D, Y);
  VectorXd parts = calc_masses(pencil, Y);
  const double largest = (pencil.M_diagonal.array() / D.array()).maxCoeff();
  std::vector<Index> some, none;
  for (Index c = 0; c < Y.cols(); ++c) (parts(c) > 1e-22 * largest ? some : none).push_back(c);
  massless = Y(Eigen::all, none);
  Y = Y(Eigen::all, some).eval();
  for (int pass = 0; pass < 2 && Y.cols() > 0; ++pass) {
    parts = calc_masses(pencil, Y);
    Y = (Y * parts.cwiseSqrt().cwiseInverse().asDiagonal()).eval();
    const MatrixXd G = Y.transpose() * pencil.calc_M_times(Y);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(0.5 * (G + G.transpose()));
    const auto num_light = (solver.eigenvalues().array() < light).count();
    MatrixXd more(Y.rows(), massless.cols() + num_light);
    more << massless, Y * solver.eigenvectors().leftCols(num_light);
    massless = more;
    const Index left = Y.cols() - num_light;
    Y = (Y * solver.eigenvectors().rightCols(left) *
         solver.eigenvalues().tail(left).cwiseSqrt().cwiseInverse().asDiagonal())
            .eval();
  }
}

/// As many dofs as X has columns, whose holding holds every combination of them.
std::vector<int> choose_dofs(const VectorXd& D, const MatrixXd& X) {
  std::vector<int> dofs;
  if (X.cols() == 0) return dofs;
  MatrixXd scaled = D.cwiseSqrt().asDiagonal() * X;
  scaled *= scaled.colwise().norm().cwiseInverse().asDiagonal();
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(scaled.transpose());
  for (Index i = 0; i < X.cols(); ++i) dofs.push_back(static_cast<int>(qr.colsPermutation().indices()(i)));
  return dofs;
}

/// X without what is in the M-orthonormal R, orthonormal under M; directions of which next to nothing is left go.
MatrixXd complement(const Pencil& pencil, const MatrixXd& R, MatrixXd X) {
  for (int pass = 0; pass < 2 && X.cols() > 0; ++pass) {
    if (R.cols() > 0) X -= R * (pencil.calc_M_times(R).transpose() * X).eval();
    const MatrixXd G = X.transpose() * pencil.calc_M_times(X);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(0.5 * (G + G.transpose()));
    const auto left = (solver.eigenvalues().array() > 1e-8).count();
    X = (X * solver.eigenvectors().rightCols(left) *
         solver.eigenvalues().tail(left).cwiseSqrt().cwiseInverse().asDiagonal())
            .eval();
  }
  return X;
}

}  // namespace

RigidMotions find_null_motions(const Pencil& pencil) {
  auto result = find_rigid_motions(pencil);
  const VectorXd D = calc_scale(pencil);
  MatrixXd Y = find_null_space(pencil, D, static_cast<int>(result.modes.cols() + result.massless.cols()));
  if (Y.cols() == 0) return result;
  split_by_mass(pencil, D, Y, result.massless);
  // The motions of the whole in their order, as the iteration has them: what is no motion of K falls out.
  const MatrixXd known = Y * (Y.transpose() * pencil.calc_M_times(result.modes));
  MatrixXd R(pencil.size(), 0);
  for (Index i = 0; i < known.cols(); ++i) {
    const MatrixXd next = complement(pencil, R, known.col(i));
    R = (MatrixXd(R.rows(), R.cols() + next.cols()) << R, next).finished();
  }
  const MatrixXd others = complement(pencil, R, Y);
  const MatrixXd turned =
      others.cols() > 0
          ? (others * calc_cluster_rotation(calc_basis_weights(pencil.model), pencil.model.T() * others)).eval()
          : others;
  result.modes = (MatrixXd(R.rows(), R.cols() + turned.cols()) << R, turned).finished();
  result.held = choose_dofs(D, result.massless);
  if (!result.held.empty()) {
    const MatrixXd at_held = result.massless(result.held, Eigen::all);
    result.modes -= result.massless * at_held.partialPivLu().solve(MatrixXd(result.modes(result.held, Eigen::all)));
  }
  result.supports = choose_dofs(D, result.modes);
  return result;
}

}  // namespace bough::modal::detail
