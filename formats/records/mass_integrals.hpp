#pragma once
/// \file The mass integrals of the modes of a body.
#include <vector>

#include <Eigen/Dense>

namespace bough::records {

using Eigen::Matrix3d;
using Eigen::MatrixXd;

/// The five mass integrals (docs/theory/flexible-body.md §4). Column j belongs to mode j.
struct MassIntegrals {
  MatrixXd gamma0;                            ///< 3 x n, Σ A^T_j
  MatrixXd gamma1;                            ///< 3 x n, Σ (A^A_j + p × A^T_j)
  std::vector<MatrixXd> gamma2;               ///< [j] 3 x n: column k is Γ2_jk = Σ A^T_j × φ_k
  std::vector<Matrix3d> gamma3;               ///< [j] 3 x 3
  std::vector<std::vector<Matrix3d>> gamma4;  ///< [j][k] 3 x 3
  /// Returns true if the set is not given; its method was not requested or the body has no modes.
  bool empty() const { return gamma0.size() == 0; }
};

}  // namespace bough::records
