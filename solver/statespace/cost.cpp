#include "solver/statespace/cost.hpp"

#include <algorithm>
#include <sstream>

#include "base/diagnostic.hpp"
#include "solver/statespace/blocks.hpp"
#include "solver/statespace/spectrum.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

/// Exchanges the eigenvalues k and k + 1 of the triangular T = Uᴴ A U (Golub & Van Loan, Matrix Computations, 7.6.2).
void exchange(MatrixXcd& T, MatrixXcd& U, Index k) {
  Eigen::JacobiRotation<std::complex<double>> turn;
  turn.makeGivens(T(k, k + 1), T(k + 1, k + 1) - T(k, k));
  T.applyOnTheLeft(k, k + 1, turn.adjoint());
  T.applyOnTheRight(k, k + 1, turn);
  U.applyOnTheRight(k, k + 1, turn);
  T(k + 1, k) = 0;
}

/// R of T1 R - R T2 = F, both triangular.
MatrixXcd solve_sylvester(const MatrixXcd& T1, const MatrixXcd& T2, const MatrixXcd& F) {
  MatrixXcd R = F, shifted = T1;
  for (Index j = 0; j < R.cols(); ++j) {
    for (Index k = 0; k < j; ++k) R.col(j) += R.col(k) * T2(k, j);
    shifted.diagonal() = T1.diagonal().array() - T2(j, j);
    shifted.triangularView<Eigen::Upper>().solveInPlace(R.col(j));
  }
  return R;
}

}  // namespace

StablePart split_stable(const MatrixXd& A, bool leave_unstable) {
  StablePart part;
  const Index n = A.rows();
  BOUGH_DEMAND(A.cols() == n);
  if (n == 0) return part;
  MatrixXd a = A;
  const Eigen::VectorXd scale = balance(a);
  const Eigen::ComplexSchur<MatrixXd> schur(a);
  MatrixXcd T = schur.matrixT(), U = schur.matrixU();
  const double largest = T.diagonal().cwiseAbs().maxCoeff();
  Index kept = 0;
  for (Index i = 0; i < n; ++i) {
    const std::complex<double> pole = T(i, i);
    if (std::abs(pole) <= 1e-6 * largest) continue;
    if (pole.real() > -1e-11 * std::abs(pole)) {
      part.unstable = pole;
      if (leave_unstable) continue;
    }
    for (Index k = i; k > kept; --k) exchange(T, U, k - 1);
    ++kept;
  }
  const Index rest = n - kept;
  part.num_rigid = static_cast<int>(rest);
  part.T = T.topLeftCorner(kept, kept);
  part.U = scale.asDiagonal() * U.leftCols(kept);
  part.L = U.leftCols(kept).adjoint();
  if (rest > 0)
    part.L += solve_sylvester(part.T, T.bottomRightCorner(rest, rest), T.topRightCorner(kept, rest)) *
              U.rightCols(rest).adjoint();
  part.L = part.L * scale.cwiseInverse().asDiagonal();
  return part;
}

MatrixXd solve_lyapunov(const StablePart& part, const MatrixXd& Q) {
  const Index n = part.T.rows();
  MatrixXcd Y = -(part.L * Q * part.L.adjoint()), shifted = part.T;
  for (Index j = n; j-- > 0;) {
    for (Index k = j + 1; k < n; ++k) Y.col(j) -= Y.col(k) * std::conj(part.T(j, k));
    shifted.diagonal() = part.T.diagonal().array() + std::conj(part.T(j, j));
    shifted.triangularView<Eigen::Upper>().solveInPlace(Y.col(j));
  }
  const MatrixXd X = (part.U * Y * part.U.adjoint()).real();
  return 0.5 * (X + X.transpose());
}

ComponentCost calc_component_cost(const MatrixXd& A, const MatrixXd& B, const MatrixXd& C) {
  const StablePart part = split_stable(A);
  if (!part.is_stable()) {
    std::ostringstream what;
    what << "the pole " << part.unstable.real() << " ± " << std::abs(part.unstable.imag())
         << " i does not decay: the outputs grow without limit and no mode can be ranked";
    throw ComputationError("select.unstable", {}, what.str(), "give the modes damping, or choose a stable state");
  }
  ComponentCost cost;
  cost.num_rigid = part.num_rigid;
  // Outputs of the stable part only.
  const MatrixXd seen = (C * part.U * part.L).real();
  const MatrixXd X = solve_lyapunov(part, B * B.transpose());
  cost.state = (X * seen.transpose()).cwiseProduct(seen.transpose()).rowwise().sum();
  cost.total = (seen * X * seen.transpose()).trace();
  return cost;
}

bool is_seen(const StateSpace& s, const MatrixXd& projector) {
  MatrixXd A = s.A;
  const Eigen::VectorXd scale = balance(A);
  const MatrixXd inverse = scale.cwiseInverse().asDiagonal(), C = s.C * scale.asDiagonal();
  MatrixXd all = inverse * s.B, part = inverse * projector * s.B;
  for (Index k = 0; k < std::min<Index>(A.rows(), 4); ++k) {
    if ((C * part).norm() > 1e-9 * C.norm() * all.norm()) return true;
    all = A * all;
    part = A * part;
  }
  return false;
}

double calc_mean_square_difference(const StateSpace& full, const StateSpace& reduced) {
  const StateSpace both = subtract(full, reduced);
  return std::max(0.0, calc_component_cost(both.A, both.B, both.C).total);
}

double calc_modal_cost(double omega, double zeta, double b_squared, double c_d_squared, double c_r_squared) {
  return b_squared * (c_d_squared + omega * omega * c_r_squared) / (4 * zeta * omega * omega * omega);
}

}  // namespace bough::statespace
