#include "solver/statespace/hankel.hpp"

#include "solver/statespace/cost.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

/// Y of T Y + Y Tᴴ + Q = 0, T upper triangular, Q Hermitian.
MatrixXcd solve_triangular(const MatrixXcd& T, const MatrixXcd& Q) {
  MatrixXcd Y = -Q, shifted = T;
  for (Index j = T.rows(); j-- > 0;) {
    for (Index k = j + 1; k < T.rows(); ++k) Y.col(j) -= Y.col(k) * std::conj(T(j, k));
    shifted.diagonal() = T.diagonal().array() + std::conj(T(j, j));
    shifted.triangularView<Eigen::Upper>().solveInPlace(Y.col(j));
  }
  return 0.5 * (Y + Y.adjoint());
}

/// R with R Rᴴ = Y, negative eigenvalues being rounding.
MatrixXcd calc_root(const MatrixXcd& Y) {
  const Eigen::SelfAdjointEigenSolver<MatrixXcd> solver(Y);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

records::Hankel calc_hankel(const MatrixXd& A, const MatrixXd& B, const MatrixXd& C) {
  records::Hankel out;
  const StablePart part = split_stable(A, true);
  const Index n = A.rows(), kept = part.T.rows();
  out.num_left_out = static_cast<int>(n - kept);
  out.controllability = out.observability = MatrixXd::Zero(n, n);
  if (kept == 0) return out;
  const MatrixXcd b = part.L * B, c = C * part.U;
  const MatrixXcd Yc = solve_triangular(part.T, b * b.adjoint());
  // Tᴴ Z + Z T + cᴴ c = 0: rows and columns in reverse make Tᴴ upper triangular.
  const MatrixXcd T = part.T.adjoint().reverse();
  const MatrixXcd Zr = solve_triangular(T, MatrixXcd(c.adjoint() * c).reverse());
  const MatrixXcd Z = Zr.reverse();
  out.value = Eigen::BDCSVD<MatrixXcd>(calc_root(Z).adjoint() * calc_root(Yc)).singularValues();
  out.controllability = (part.U * Yc * part.U.adjoint()).real();
  out.observability = (part.L.adjoint() * Z * part.L).real();
  return out;
}

double calc_truncation_bound(const Eigen::VectorXd& values, int kept) {
  const Index left = std::max<Index>(0, values.size() - kept);
  return 2 * values.tail(left).sum();
}

}  // namespace bough::statespace
