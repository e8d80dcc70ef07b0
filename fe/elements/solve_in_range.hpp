#pragma once
/// \file Small singular systems of stiffness matrices.
#include <Eigen/Dense>

namespace bough::fe {

/// X of K X = B (N x m), least squares: no motion in which K (N x N, symmetric) stores no energy. Eigenvalues of K,
/// scaled by its diagonal, below 1e-13 N of the largest are zero.
Eigen::MatrixXd solve_in_range(const Eigen::MatrixXd& K, const Eigen::MatrixXd& B);

}  // namespace bough::fe
