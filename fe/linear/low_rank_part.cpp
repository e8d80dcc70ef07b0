#include "fe/linear/low_rank_part.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "base/diagnostic.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using SparseColumns = Eigen::SparseMatrix<double>;

SparseColumns join_columns(const SparseColumns& A, const SparseColumns& B) {
  SparseColumns C(A.rows(), A.cols() + B.cols());
  C.leftCols(A.cols()) = A;
  C.rightCols(B.cols()) = B;
  return C;
}

MatrixXd join_diagonal(const MatrixXd& A, const MatrixXd& B) {
  MatrixXd C = MatrixXd::Zero(A.rows() + B.rows(), A.cols() + B.cols());
  C.topLeftCorner(A.rows(), A.cols()) = A;
  C.bottomRightCorner(B.rows(), B.cols()) = B;
  return C;
}

}  // namespace

VectorXd LowRankPart::calc_diagonal() const {
  const MatrixXd UW = U * W;
  VectorXd d = VectorXd::Zero(U.rows());
  for (Eigen::Index k = 0; k < U.outerSize(); ++k)
    for (SparseColumns::InnerIterator it(U, k); it; ++it) d(it.row()) += it.value() * UW(it.row(), k);
  return d;
}

LowRankPart make_form_part(const SparseColumns& X, const MatrixXd& K) {
  if (K.isZero(0)) return {SparseColumns(X.rows(), 0), MatrixXd(0, 0), MatrixXd(0, 0), 0};
  const VectorXd size = K.diagonal().cwiseAbs().cwiseSqrt();
  const double largest = size.size() ? size.maxCoeff() : 0;
  // Rotations and translations, each in its own unit; what has no separate diagonal is of the largest.
  const VectorXd unit = size.unaryExpr([&](double s) { return s > 1e-8 * largest ? s : largest > 0 ? largest : 1; });
  const VectorXd inverse = unit.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> parts(inverse.asDiagonal() * K * inverse.asDiagonal());
  std::vector<Eigen::Index> kept;
  const double max_eigenvalue = K.size() ? parts.eigenvalues().cwiseAbs().maxCoeff() : 0;
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    if (std::abs(parts.eigenvalues()(i)) > 1e-14 * max_eigenvalue) kept.push_back(i);
  const VectorXd values = parts.eigenvalues()(kept);
  const MatrixXd Q = unit.asDiagonal() * parts.eigenvectors()(Eigen::all, kept);
  LowRankPart part;
  part.U = X * SparseColumns(Q.sparseView(0, 0));
  part.W = values.asDiagonal();
  part.W_inverse = values.cwiseInverse().asDiagonal();
  part.num_positive = static_cast<int>((values.array() > 0).count());
  return part;
}

LowRankPart make_product_part(const SparseColumns& D, const SparseColumns& V, const MatrixXd& K) {
  std::vector<Eigen::Index> kept;
  std::vector<double> size;
  std::vector<Eigen::Triplet<double>> picks;
  for (Eigen::Index j = 0; j < K.rows(); ++j) {
    const double v = V.col(j).norm(), k = K.col(j).cwiseAbs().maxCoeff();
    if (v == 0 && k == 0) continue;
    picks.emplace_back(static_cast<int>(j), static_cast<int>(kept.size()), 1);
    kept.push_back(j);
    size.push_back(std::max(v, k));
  }
  const auto r = static_cast<Eigen::Index>(kept.size());
  SparseColumns pick(K.rows(), r);
  pick.setFromTriplets(picks.begin(), picks.end());
  const MatrixXd K_kept = K(kept, kept);
  const SparseColumns D_kept = D * pick, V_kept = V * pick;
  if (V_kept.nonZeros() == 0) return make_form_part(D_kept, K_kept);
  const VectorXd s = Eigen::Map<const VectorXd>(size.data(), r), inverse = s.cwiseInverse();
  LowRankPart part;
  part.U = join_columns(D_kept, V_kept * inverse.asDiagonal());
  part.W = part.W_inverse = MatrixXd::Zero(2 * r, 2 * r);
  part.W.topLeftCorner(r, r) = K_kept;
  part.W.topRightCorner(r, r).diagonal() = part.W.bottomLeftCorner(r, r).diagonal() = s;
  part.W_inverse.topRightCorner(r, r).diagonal() = part.W_inverse.bottomLeftCorner(r, r).diagonal() = inverse;
  part.W_inverse.bottomRightCorner(r, r) = -(inverse.asDiagonal() * K_kept * inverse.asDiagonal());
  part.num_positive = static_cast<int>(r);  // [K s; s 0] has as many of either sign
  return part;
}

LowRankPart scale(const LowRankPart& part, double factor) {
  BOUGH_DEMAND(factor != 0);
  return {part.U, factor * part.W, part.W_inverse / factor,
          factor > 0 ? part.num_positive : part.rank() - part.num_positive};
}

LowRankPart join(const LowRankPart& a, double factor_a, const LowRankPart& b, double factor_b) {
  if (a.rank() == 0) return b.rank() == 0 ? b : scale(b, factor_b);
  const LowRankPart x = scale(a, factor_a);
  if (b.rank() == 0) return x;
  const LowRankPart y = scale(b, factor_b);
  return {join_columns(x.U, y.U), join_diagonal(x.W, y.W), join_diagonal(x.W_inverse, y.W_inverse),
          x.num_positive + y.num_positive};
}

LowRankPart take_kept(const LowRankPart& part, const std::vector<int>& kept) {
  std::vector<int> row_of(static_cast<std::size_t>(part.U.rows()), -1);
  for (std::size_t i = 0; i < kept.size(); ++i) row_of[static_cast<std::size_t>(kept[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index k = 0; k < part.U.outerSize(); ++k)
    for (SparseColumns::InnerIterator it(part.U, k); it; ++it)
      if (const int row = row_of[static_cast<std::size_t>(it.row())]; row >= 0)
        entries.emplace_back(row, static_cast<int>(k), it.value());
  LowRankPart result = part;
  result.U.resize(static_cast<Eigen::Index>(kept.size()), part.rank());
  result.U.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace bough::linear
