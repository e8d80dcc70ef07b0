#pragma once
/// \file The equations A x = b of a symmetric positive semidefinite A, solved by least norm where A is singular.
#include <vector>

#include <Eigen/Dense>

namespace bough::solver {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Cholesky's factorization with diagonal pivoting of A scaled to a unit diagonal (Higham, "Accuracy and Stability of
/// Numerical Algorithms", 10.3): Ã = L Lᵀ, L m x rank; with L = Q R, Ã⁺ = Q R⁻ᵀ R⁻¹ Qᵀ. Rows whose pivot is no more
/// than kLeastShare of their diagonal depend on the others. Least norm and least squares are those of the scaled
/// unknowns and rows.
class SemidefiniteFactor {
 public:
  static constexpr double kLeastShare = 1e-10;

  /// For A of that size. Allocates; nothing else does.
  void resize(int size);
  /// Reads the lower triangle.
  void compute(const MatrixXd& A);
  int rank() const { return rank_; }
  int size() const { return static_cast<int>(scale_.size()); }
  /// b: size, in and out.
  void solve(Eigen::Ref<VectorXd> b);

 private:
  void orthogonalize();

  MatrixXd L_, R_;  // where the rank is not full L_ holds Q
  VectorXd scale_, x_, y_;
  std::vector<int> order_;
  int rank_ = 0;
};

}  // namespace bough::solver
