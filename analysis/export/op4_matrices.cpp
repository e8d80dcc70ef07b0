#include "analysis/export/op4_matrices.hpp"

#include <algorithm>

#include "analysis/export/export_matrices.hpp"

namespace bough::analysis {
namespace {

/// Compressed rows of a symmetric matrix hold (j, i) for every (i, j).
bool is_symmetric(const records::SparseMatrix& a) {
  if (a.num_rows != a.num_cols) return false;
  const auto find = [&](int row, int column) {
    const auto begin = a.indices.begin() + a.indptr[to_size(row)], end = a.indices.begin() + a.indptr[to_size(row) + 1];
    const auto at = std::lower_bound(begin, end, column);
    return at == end || *at != column ? 0.0 : a.data[to_size(at - a.indices.begin())];
  };
  for (int r = 0; r < a.num_rows; ++r)
    for (int k = a.indptr[to_size(r)]; k < a.indptr[to_size(r) + 1]; ++k)
      if (a.data[to_size(k)] != find(a.indices[to_size(k)], r)) return false;
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
  matrix.form = a.num_rows != a.num_cols ? matrices::kRectangular
                : is_symmetric(a)        ? matrices::kSymmetric
                                         : matrices::kSquare;
  matrix.values = a;
  matrices::write_op4(out_, matrix, options_);
}

}  // namespace bough::analysis
