#include "analysis/export/op4_matrices.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Sparse>

#include "analysis/export/export_matrices.hpp"

namespace bough::analysis {
namespace {

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Difference of a(i, j) and a(j, i) that is round-off of a rotation to displacement axes, over the geometric mean of
/// the largest entries of both rows.
constexpr double kSymmetryRoundoff = 1e-12;

Rows to_rows(const records::SparseMatrix& a) {
  return Eigen::Map<const Rows>(a.num_rows, a.num_cols, static_cast<int>(a.data.size()), a.indptr.data(),
                                a.indices.data(), a.data.data());
}

/// Returns true if a square matrix is symmetric but for round-off.
bool is_symmetric(const Rows& a) {
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(a.rows());
  for (int r = 0; r < a.rows(); ++r)
    for (Rows::InnerIterator entry(a, r); entry; ++entry) scale(r) = std::max(scale(r), std::abs(entry.value()));
  const Rows difference = a - Rows(a.transpose());
  for (int r = 0; r < difference.rows(); ++r)
    for (Rows::InnerIterator entry(difference, r); entry; ++entry)
      if (std::abs(entry.value()) > kSymmetryRoundoff * std::sqrt(scale(r) * scale(entry.col()))) return false;
  return true;
}

}  // namespace

void Op4Matrices::put(const std::string& name, const Eigen::MatrixXd& dense) {
  if (dense.size() == 0) return;
  records::SparseMatrix a;
  a.num_rows = static_cast<int>(dense.rows());
  a.num_cols = static_cast<int>(dense.cols());
  a.indptr.push_back(0);
  for (Eigen::Index r = 0; r < dense.rows(); ++r) {
    for (Eigen::Index c = 0; c < dense.cols(); ++c)
      if (dense(r, c) != 0) {
        a.indices.push_back(static_cast<int>(c));
        a.data.push_back(dense(r, c));
      }
    a.indptr.push_back(static_cast<int>(a.indices.size()));
  }
  put(name, a);
}

void Op4Matrices::put(const std::string& name, const records::SparseMatrix& a) {
  matrices::Matrix matrix;
  matrix.name = name;
  matrix.values = a;
  matrix.form = a.num_rows != a.num_cols   ? matrices::kRectangular
                : is_symmetric(to_rows(a)) ? matrices::kSymmetric
                                           : matrices::kSquare;
  matrices::write_op4(out_, matrix, options_);
}

}  // namespace bough::analysis
