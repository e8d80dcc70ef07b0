#include "solver/bodies/row_basis.hpp"

#include <vector>

namespace bough::solver {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

RowBasis find_row_basis(const MatrixXd& T, double size) {
  constexpr double kZero = 1e-15, kSame = 1e-14;
  const VectorXd norm = T.rowwise().norm();
  std::vector<Index> used;
  for (Index i = 0; i < T.rows(); ++i) {
    if (norm[i] > kZero * size) used.push_back(i);
  }
  RowBasis basis;
  basis.rows = MatrixXd::Zero(0, T.cols());
  basis.E = MatrixXd::Zero(0, T.rows());
  const auto num = static_cast<Index>(used.size());
  if (num == 0) return basis;
  MatrixXd scaled(T.cols(), num);
  for (Index i = 0; i < num; ++i)
    scaled.col(i) = T.row(used[static_cast<size_t>(i)]).transpose() / norm[used[static_cast<size_t>(i)]];
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(kSame);
  qr.compute(scaled);
  const Index rank = qr.rank();
  const auto row = [&](Index i) { return used[static_cast<size_t>(qr.colsPermutation().indices()[i])]; };
  MatrixXd rest = qr.matrixR().topRightCorner(rank, num - rank);
  qr.matrixR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solveInPlace(rest);
  basis.rows = MatrixXd(rank, T.cols());
  basis.E = MatrixXd::Zero(rank, T.rows());
  for (Index i = 0; i < rank; ++i) {
    basis.rows.row(i) = T.row(row(i));
    basis.E(i, row(i)) = 1;
    for (Index j = rank; j < num; ++j) basis.E(i, row(j)) = rest(i, j - rank) * norm[row(j)] / norm[row(i)];
  }
  return basis;
}

}  // namespace bough::solver
