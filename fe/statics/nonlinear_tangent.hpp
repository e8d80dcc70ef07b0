#pragma once
/// \file Tangent stiffness of nonlinear statics and its factor; limits of Newton's method (nonlinear.cpp,
/// arc_length.cpp).
#include <optional>

#include <Eigen/SparseLU>

#include "fe/linear/factor.hpp"
#include "fe/statics/nonlinear.hpp"

namespace bough::fe {

inline constexpr int kMaxHalvings = 10;  ///< of a step without equilibrium
/// Work of the last correction relative to the strain energy: the correction before it is applied as well, so that the
/// error left is of the order of its square.
inline constexpr double kWorkTolerance = 1e-20;
/// Limit of that ratio where round-off of stiff parts keeps the corrections from falling.
inline constexpr double kStagnation = 1e-10;
/// Largest angle between a node and its element's frame: far beyond what a linear element can say.
inline constexpr double kMaxTurn = 1.5;

/// Factor of a tangent stiffness; it is stable where the determinant (of the symmetric one: every pivot) is positive.
class TangentFactor {
 public:
  TangentFactor(const Eigen::SparseMatrix<double, Eigen::RowMajor>& K, bool is_symmetric) {
    if (!is_symmetric) {
      lu_.compute(Eigen::SparseMatrix<double>(K));
      is_made_ = is_lu_ = lu_.info() == Eigen::Success;
      is_stable_ = is_made_ && lu_.signDeterminant() > 0;
      return;
    }
    const linear::SymmetricMatrix matrix(K);
    symmetric_ = linear::SymmetricFactor::try_definite(matrix);
    is_made_ = is_stable_ = symmetric_.has_value();
    if (is_made_) return;
    try {
      symmetric_.emplace(matrix, false);
      is_made_ = !symmetric_->is_singular();
    } catch (const ComputationError&) {  // a step that is too long
    }
  }

  /// Returns true if there is a factor: K is not singular.
  bool is_made() const { return is_made_; }
  /// Returns true if K is positive definite; unsymmetric: has a positive determinant.
  bool is_stable() const { return is_stable_; }
  /// K⁻¹ r. \pre is_made().
  VectorXd solve(const VectorXd& r) const { return is_lu_ ? VectorXd(lu_.solve(r)) : VectorXd(symmetric_->solve(r)); }

 private:
  std::optional<linear::SymmetricFactor> symmetric_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu_;
  bool is_made_ = false, is_stable_ = false, is_lu_ = false;
};

/// Forces at a state, and stiffness by the unknowns: on the g-set, without the grids that follow others.
struct NonlinearStatics::Tangent {
  Eigen::SparseMatrix<double, Eigen::RowMajor> K;
  VectorXd residual;  ///< f - F, at the grids where they act
};

}  // namespace bough::fe
