#include "modal/complex/quadratic_pencil.hpp"

#include "fe/statics/static_case.hpp"

namespace bough::modal::complex_modes {
namespace {

/// Round-off of assembly and of rotations into other axes.
constexpr double kSymmetryRoundoff = 1e-12;

bool is_symmetric_matrix(const ComplexSparse& A) {
  if (A.nonZeros() == 0) return true;
  const ComplexSparse difference = A - ComplexSparse(A.transpose());
  double largest = 0, unsymmetric = 0;
  for (Index row = 0; row < A.outerSize(); ++row)
    for (ComplexSparse::InnerIterator it(A, row); it; ++it) largest = std::max(largest, std::abs(it.value()));
  for (Index row = 0; row < difference.outerSize(); ++row)
    for (ComplexSparse::InnerIterator it(difference, row); it; ++it)
      unsymmetric = std::max(unsymmetric, std::abs(it.value()));
  return unsymmetric <= kSymmetryRoundoff * largest;
}

}  // namespace

ComplexSparse QuadraticPencil::calc_matrix(Complex lambda) const {
  if (lambda == 0.0) return K;
  ComplexSparse Q = K + lambda * B;
  return Q + lambda * lambda * M;
}

QuadraticPencil QuadraticPencil::transpose() const {
  return {ComplexSparse(K.transpose()), ComplexSparse(B.transpose()), ComplexSparse(M.transpose()), is_symmetric};
}

void PencilBuilder::add_term(int power, Index row, Index column, Complex value) {
  if (value != 0.0) terms_[power].emplace_back(static_cast<int>(row), static_cast<int>(column), value);
}

void PencilBuilder::add(const linear::SymmetricMatrix& A, Complex factor, int power) {
  const auto* part = A.low_rank();
  const auto rows = fe::gather_sparse(A.sparse_part());
  for (int i = 0; i < rows.num_rows; ++i)
    for (int k = rows.indptr[static_cast<std::size_t>(i)]; k < rows.indptr[static_cast<std::size_t>(i) + 1]; ++k)
      add_term(power, i, rows.indices[static_cast<std::size_t>(k)], factor * rows.data[static_cast<std::size_t>(k)]);
  if (part == nullptr) return;
  for (Index c = 0; c < part->U.outerSize(); ++c)
    for (Eigen::SparseMatrix<double>::InnerIterator it(part->U, c); it; ++it) {
      add_term(power, it.row(), n_ + c, factor * it.value());
      add_term(0, n_ + c, it.row(), power == 0 ? factor * it.value() : it.value());
    }
  for (int i = 0; i < part->rank(); ++i)
    for (int j = 0; j < part->rank(); ++j)
      add_term(0, n_ + i, n_ + j, power == 0 ? -factor * part->W_inverse(i, j) : -part->W_inverse(i, j));
  n_ += part->rank();
}

void PencilBuilder::add_projected(const Eigen::SparseMatrix<double>& N, const ComplexSparse& K, const ComplexSparse& B,
                                  const ComplexSparse& M) {
  const ComplexSparse right = N.cast<Complex>();
  const ComplexSparse left = ComplexSparse(right.transpose());
  int power = 0;
  for (const auto* A : {&K, &B, &M}) {
    const ComplexSparse projected = left * ComplexSparse(*A * right);
    for (Index row = 0; row < projected.outerSize(); ++row)
      for (ComplexSparse::InnerIterator it(projected, row); it; ++it) add_term(power, row, it.col(), it.value());
    ++power;
  }
}

void PencilBuilder::add_dense(const MatrixXcd& K, const MatrixXcd& B, const MatrixXcd& M) {
  int power = 0;
  for (const auto* A : {&K, &B, &M}) {
    for (Index j = 0; j < A->cols(); ++j)
      for (Index i = 0; i < A->rows(); ++i) add_term(power, i, j, (*A)(i, j));
    ++power;
  }
}

QuadraticPencil PencilBuilder::build() const {
  QuadraticPencil pencil;
  int power = 0;
  for (auto* A : {&pencil.K, &pencil.B, &pencil.M}) {
    A->resize(n_, n_);
    A->setFromTriplets(terms_[power].begin(), terms_[power].end());
    pencil.is_symmetric = pencil.is_symmetric && is_symmetric_matrix(*A);
    ++power;
  }
  return pencil;
}

}  // namespace bough::modal::complex_modes
