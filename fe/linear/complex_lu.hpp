#pragma once
/// \file Factors of sparse complex matrices, symmetric or not, by MUMPS in complex arithmetic.
#include <complex>
#include <memory>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

namespace bough::linear {

using ComplexSparse = Eigen::SparseMatrix<std::complex<double>, Eigen::RowMajor>;

/// LU of A, or LDLᵀ if `is_symmetric` (A = Aᵀ, not Hermitian), with pivoting. A is the same on every rank; rank 0 feeds
/// it to MUMPS, which distributes the factor.
class ComplexLu {
 public:
  /// Collective. Throws ComputationError "fe.out-of-memory" and "fe.factorization".
  ComplexLu(const ComplexSparse& A, bool is_symmetric);
  ~ComplexLu();
  ComplexLu(const ComplexLu&) = delete;
  ComplexLu& operator=(const ComplexLu&) = delete;

  bool is_singular() const;  ///< an exact zero pivot; solve() must not be called
  /// X with A X = F or, if `transposed`, Aᵀ X = F; replicated on every rank. Collective.
  Eigen::MatrixXcd solve(const Eigen::Ref<const Eigen::MatrixXcd>& F, bool transposed = false) const;
  double num_entries() const;  ///< of the factor, on all ranks

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bough::linear
