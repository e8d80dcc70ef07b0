#include "solver/statespace/zeros.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "base/diagnostic.hpp"
#include "solver/statespace/blocks.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

struct Quadruple {
  MatrixXd A, B, C, D;
};

/// Orthogonal Q with Qᵀ m = [R; 0], R of full row rank; gives the rank.
Index compress_rows(const MatrixXd& m, double tolerance, MatrixXd& Q) {
  const Index rows = m.rows();
  Q = MatrixXd::Identity(rows, rows);
  if (m.size() == 0) return 0;
  const Eigen::JacobiSVD<MatrixXd, Eigen::FullPivHouseholderQRPreconditioner> svd(m, Eigen::ComputeFullU);
  Q = svd.matrixU();
  return static_cast<Index>((svd.singularValues().array() > tolerance).count());
}

/// Takes out infinite zeros until D has full row rank: the states that the undriven outputs see are no longer free, and
/// their own equations become outputs.
void reduce(Quadruple& s, double tolerance) {
  for (;;) {
    MatrixXd U;
    const Index sigma = compress_rows(s.D, tolerance, U), p = s.D.rows(), n = s.A.rows();
    if (sigma == p || n == 0) return;
    const MatrixXd C = U.transpose() * s.C, D = U.transpose() * s.D;
    MatrixXd V;
    const Index rho = compress_rows(C.bottomRows(p - sigma).transpose(), tolerance, V), left = n - rho;
    // The seen states last.
    MatrixXd T(n, n);
    T << V.rightCols(left), V.leftCols(rho);
    const MatrixXd A = T.transpose() * s.A * T, B = T.transpose() * s.B, C_bar = C.topRows(sigma) * T;
    Quadruple next;
    next.A = A.topLeftCorner(left, left);
    next.B = B.topRows(left);
    next.C.resize(sigma + rho, left);
    next.C << C_bar.leftCols(left), A.bottomLeftCorner(rho, left);
    next.D.resize(sigma + rho, s.D.cols());
    next.D << D.topRows(sigma), B.bottomRows(rho);
    s = std::move(next);
    if (rho == 0) return;
  }
}

void transpose(Quadruple& s) {
  s.A.transposeInPlace();
  s.D.transposeInPlace();
  const MatrixXd B = s.C.transpose();
  s.C = s.B.transpose();
  s.B = B;
}

/// Zeros stay where they are when states, inputs and outputs are scaled.
void scale(Quadruple& s) {
  const Eigen::VectorXd d = balance(s.A);
  s.B = d.cwiseInverse().asDiagonal() * s.B;
  s.C = s.C * d.asDiagonal();
  const double size = s.A.size() > 0 ? s.A.norm() : 1;
  for (Index j = 0; j < s.B.cols(); ++j) {
    const double norm = s.B.col(j).norm() + s.D.col(j).norm();
    if (norm > 0) s.B.col(j) *= size / norm, s.D.col(j) *= size / norm;
  }
  for (Index i = 0; i < s.C.rows(); ++i) {
    const double norm = s.C.row(i).norm() + s.D.row(i).norm();
    if (norm > 0) s.C.row(i) *= size / norm, s.D.row(i) *= size / norm;
  }
}

}  // namespace

Eigen::VectorXcd calc_zeros(const MatrixXd& A, const MatrixXd& B, const MatrixXd& C, const MatrixXd& D) {
  BOUGH_DEMAND(A.rows() == A.cols() && B.rows() == A.rows() && C.cols() == A.cols() && D.rows() == C.rows() &&
               D.cols() == B.cols());
  Quadruple s{A, B, C, D};
  scale(s);
  const double tolerance = 1e-11 * std::max(s.A.norm(), 1e-300);
  reduce(s, tolerance);
  transpose(s);
  reduce(s, tolerance);
  const Index n = s.A.rows(), m = s.D.cols(), r = s.D.rows();
  if (n == 0) return {};
  // [C D] W = [0 D_f]: what is left of [A - s 1, B] W is the square pencil of the finite zeros.
  MatrixXd CD(r, n + m);
  CD << s.C, s.D;
  MatrixXd W;
  const Index rank = compress_rows(CD.transpose(), tolerance, W);
  MatrixXd AB(n, n + m);
  AB << s.A, s.B;
  const MatrixXd null = W.rightCols(n + m - rank);
  if (null.cols() != n) return {};  // every s: the inputs do not reach the outputs independently
  const MatrixXd left = AB * null, right = null.topRows(n);
  const Eigen::GeneralizedEigenSolver<MatrixXd> solver(left, right, false);
  std::vector<std::complex<double>> zeros;
  const double min_beta = 1e-13 * right.norm();
  for (Index i = 0; i < n; ++i) {
    if (std::abs(solver.betas()[i]) > min_beta) zeros.push_back(solver.alphas()[i] / solver.betas()[i]);
  }
  std::stable_sort(zeros.begin(), zeros.end(), [](const auto& a, const auto& b) {
    const auto key = [](const auto& z) { return std::tuple(std::abs(z), z.real(), std::abs(z.imag()), -z.imag()); };
    return key(a) < key(b);
  });
  return Eigen::Map<const Eigen::VectorXcd>(zeros.data(), static_cast<Index>(zeros.size()));
}

}  // namespace bough::statespace
