#pragma once
/// \file Quadratic eigenvalue problem (λ² M + λ B + K) x = 0 with complex, unsymmetric sparse matrices.
#include <vector>

#include "fe/linear/complex_lu.hpp"
#include "fe/linear/symmetric_matrix.hpp"

namespace bough::modal::complex_modes {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;
using linear::ComplexSparse;

/// Matrices on n unknowns, the same on every rank. Structural damping is the imaginary part of K.
struct QuadraticPencil {
  ComplexSparse K, B, M;
  bool is_symmetric = true;  ///< K = Kᵀ, B = Bᵀ, M = Mᵀ

  /// Number n of unknowns.
  Index size() const { return K.rows(); }
  ComplexSparse calc_matrix(Complex lambda) const;  ///< λ² M + λ B + K
  /// The pencil of the left eigenvectors: Kᵀ, Bᵀ, Mᵀ.
  QuadraticPencil transpose() const;
};

/// Assembles a pencil from symmetric matrices of the f-set on the first unknowns and from other terms.
class PencilBuilder {
 public:
  explicit PencilBuilder(Index num_unknowns) : n_(num_unknowns) {}

  /// Adds factor times a symmetric matrix. A part of low rank, U W Uᵀ, gets unknowns z = W Uᵀ x after the others, so
  /// that the pencil remains sparse.
  void add_stiffness(const linear::SymmetricMatrix& A, Complex factor) { add(A, factor, 0); }
  void add_damping(const linear::SymmetricMatrix& A, Complex factor) { add(A, factor, 1); }
  void add_mass(const linear::SymmetricMatrix& A, Complex factor) { add(A, factor, 2); }
  /// Adds Nᵀ A N, where N has a column for each unknown.
  void add_projected(const Eigen::SparseMatrix<double>& N, const ComplexSparse& K, const ComplexSparse& B,
                     const ComplexSparse& M);
  /// Adds dense matrices on the first unknowns.
  void add_dense(const MatrixXcd& K, const MatrixXcd& B, const MatrixXcd& M);
  /// Compresses the sums to sparse matrices.
  QuadraticPencil build() const;

 private:
  void add(const linear::SymmetricMatrix& A, Complex factor, int power);
  void add_term(int power, Index row, Index column, Complex value);

  Index n_;
  std::vector<Eigen::Triplet<Complex>> terms_[3];  ///< of K, B, M
};

}  // namespace bough::modal::complex_modes
