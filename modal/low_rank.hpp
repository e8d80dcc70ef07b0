#pragma once
/// \file The rank of a mass matrix where it is low: a few point masses on a massless structure.
#include <optional>

#include <Eigen/SparseCore>

#include "fe/linear/petsc.hpp"

namespace bough::modal::detail {

/// C, n x r, with M = C Cᵀ where the rank r of M (positive semi-definite, its diagonal given) is max_rank at most;
/// nothing where it is higher or M is indefinite. Cholesky of the matrix scaled to a unit diagonal, pivots from the
/// largest decade down; what is left below 3e-12 is roundoff of masses that dependent dofs shared out (Higham, Accuracy
/// and Stability of Numerical Algorithms, 2nd ed., 10.3). Touches no more than max_rank columns.
std::optional<Eigen::SparseMatrix<double>> factor_low_rank(Mat M, const Eigen::VectorXd& diagonal, int max_rank);

}  // namespace bough::modal::detail
