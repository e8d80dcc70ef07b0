#include "fe/linear/complex_factor.hpp"

#include <vector>

namespace bough::linear {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

/// A row of a matrix, held until the end of the scope.
class RowOf {
 public:
  RowOf(Mat A, PetscInt row) : A_(A), row_(row) { check_petsc(MatGetRow(A_, row_, &count, &columns, &values)); }
  ~RowOf() { MatRestoreRow(A_, row_, &count, &columns, &values); }
  RowOf(const RowOf&) = delete;
  RowOf& operator=(const RowOf&) = delete;
  PetscInt count = 0;
  const PetscInt* columns = nullptr;
  const PetscScalar* values = nullptr;

 private:
  Mat A_;
  PetscInt row_;
};

PetscMat make_doubled_sparse(Mat A, Mat B) {
  PetscInt first = 0, last = 0, size = 0;
  check_petsc(MatGetOwnershipRange(A, &first, &last));
  check_petsc(MatGetSize(A, &size, nullptr));
  std::vector<PetscInt> start{0}, columns;
  std::vector<PetscScalar> values, a, b;
  std::vector<PetscInt> both;
  for (PetscInt row = first; row < last; ++row) {
    const RowOf of_A(A, row), of_B(B, row);
    both.clear();
    a.clear();
    b.clear();
    for (PetscInt i = 0, k = 0; i < of_A.count || k < of_B.count;) {
      const bool takes_A = k == of_B.count || (i < of_A.count && of_A.columns[i] <= of_B.columns[k]);
      const bool takes_B = i == of_A.count || (k < of_B.count && of_B.columns[k] <= of_A.columns[i]);
      both.push_back(takes_A ? of_A.columns[i] : of_B.columns[k]);
      a.push_back(takes_A ? of_A.values[i++] : 0);
      b.push_back(takes_B ? of_B.values[k++] : 0);
    }
    for (int half = 0; half < 2; ++half) {
      for (std::size_t i = 0; i < both.size(); ++i) {
        const double on[2] = {half == 0 ? a[i] : -b[i], half == 0 ? -b[i] : -a[i]};
        for (int other = 0; other < 2; ++other) {
          const bool is_diagonal = both[i] == row && other == half;
          if (on[other] == 0 && !is_diagonal) continue;
          columns.push_back(2 * both[i] + other);
          values.push_back(on[other]);
        }
      }
      start.push_back(static_cast<PetscInt>(columns.size()));
    }
  }
  PetscMat doubled;
  check_petsc(MatCreate(PETSC_COMM_WORLD, doubled.out()));
  Mat D = doubled.get();
  check_petsc(MatSetSizes(D, 2 * (last - first), 2 * (last - first), 2 * size, 2 * size));
  check_petsc(MatSetType(D, MATAIJ));
  check_petsc(MatSetUp(D));
  check_petsc(MatSeqAIJSetPreallocationCSR(D, start.data(), columns.data(), values.data()));
  check_petsc(MatMPIAIJSetPreallocationCSR(D, start.data(), columns.data(), values.data()));
  check_petsc(MatSetOption(D, MAT_SYMMETRIC, PETSC_TRUE));
  check_petsc(MatSetOption(D, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return doubled;
}

/// U at the real parts, then at the imaginary ones.
Eigen::SparseMatrix<double> double_rows(const Eigen::SparseMatrix<double>& U) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index c = 0; c < U.outerSize(); ++c)
    for (Eigen::SparseMatrix<double>::InnerIterator it(U, c); it; ++it)
      for (int half = 0; half < 2; ++half)
        entries.emplace_back(static_cast<int>(2 * it.row() + half), static_cast<int>(c + half * U.cols()), it.value());
  Eigen::SparseMatrix<double> both(2 * U.rows(), 2 * U.cols());
  both.setFromTriplets(entries.begin(), entries.end());
  return both;
}

/// diag(W, -W) for a real part, [0 -W; -W 0] for an imaginary part.
LowRankPart double_part(const LowRankPart& part, bool is_imaginary) {
  const Index r = part.rank();
  LowRankPart both;
  both.U = double_rows(part.U);
  both.W = both.W_inverse = MatrixXd::Zero(2 * r, 2 * r);
  for (const auto& [to, from] : {std::pair{&both.W, &part.W}, std::pair{&both.W_inverse, &part.W_inverse}}) {
    if (is_imaginary) {
      to->topRightCorner(r, r) = to->bottomLeftCorner(r, r) = -*from;
    } else {
      to->topLeftCorner(r, r) = *from;
      to->bottomRightCorner(r, r) = -*from;
    }
  }
  both.num_positive = static_cast<int>(r);
  return both;
}

}  // namespace

SymmetricMatrix make_doubled(const SymmetricMatrix& A, const SymmetricMatrix& B) {
  LowRankPart part{Eigen::SparseMatrix<double>(0, 0), MatrixXd(0, 0), MatrixXd(0, 0), 0};
  if (const auto* of_A = A.low_rank()) part = double_part(*of_A, false);
  if (const auto* of_B = B.low_rank()) part = join(part, 1, double_part(*of_B, true), 1);
  return SymmetricMatrix(make_doubled_sparse(A.sparse(), B.sparse()), std::move(part));
}

ComplexFactor::ComplexFactor(const SymmetricMatrix& A, const SymmetricMatrix& B)
    : is_real_(!B), matrix_(is_real_ ? A : make_doubled(A, B)), factor_(matrix_, false, FactorMethod::Pivoting) {}

MatrixXd ComplexFactor::solve_real(const Eigen::Ref<const MatrixXd>& F) const {
  MatrixXd X = factor_.solve(F);
  X += factor_.solve(calc_residual(matrix_, X, F));
  return X;
}

MatrixXcd ComplexFactor::solve(const Eigen::Ref<const MatrixXcd>& F) const {
  const Index n = F.rows(), m = F.cols();
  MatrixXcd X(n, m);
  if (is_real_) {
    MatrixXd parts(n, 2 * m);
    parts << F.real(), F.imag();
    parts = solve_real(parts);
    X.real() = parts.leftCols(m);
    X.imag() = parts.rightCols(m);
    return X;
  }
  MatrixXd sides(2 * n, m);
  for (Index c = 0; c < m; ++c)
    for (Index k = 0; k < n; ++k) {
      sides(2 * k, c) = F(k, c).real();
      sides(2 * k + 1, c) = -F(k, c).imag();
    }
  sides = solve_real(sides);
  for (Index c = 0; c < m; ++c)
    for (Index k = 0; k < n; ++k) X(k, c) = {sides(2 * k, c), sides(2 * k + 1, c)};
  return X;
}

}  // namespace bough::linear
