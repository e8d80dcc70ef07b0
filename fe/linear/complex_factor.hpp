#pragma once
/// \file Solutions with a complex symmetric matrix A + iB, by a real symmetric one of twice the size.
#include "fe/linear/factor.hpp"

namespace bough::linear {

/// [A -B; -B -A] with the unknowns side by side: rows 2k and 2k + 1 are the real and the imaginary part of row k, so
/// that an order of elimination that is good for A is good for it.
SymmetricMatrix make_doubled(const SymmetricMatrix& A, const SymmetricMatrix& B);

/// LDLᵀ of A + iB by MUMPS, which pivots: A need not be definite. One refinement with residuals of more digits.
class ComplexFactor {
 public:
  /// Without B A is factored alone.
  ComplexFactor(const SymmetricMatrix& A, const SymmetricMatrix& B);

  bool is_singular() const { return factor_.is_singular(); }  ///< an exact zero pivot; solve() must not be called
  /// X with (A + iB) X = F, n x m, replicated on every rank.
  Eigen::MatrixXcd solve(const Eigen::Ref<const Eigen::MatrixXcd>& F) const;

 private:
  Eigen::MatrixXd solve_real(const Eigen::Ref<const Eigen::MatrixXd>& F) const;

  bool is_real_;
  SymmetricMatrix matrix_;
  SymmetricFactor factor_;
};

}  // namespace bough::linear
