#pragma once
/// \file Products and diagonals of symmetric matrices, dense, sparse or with a part of low rank.
#include "fe/linear/symmetric_matrix.hpp"

namespace bough::linear {

/// A X of A and a replicated X, replicated.
Eigen::MatrixXd multiply(const SymmetricMatrix& A, const Eigen::Ref<const Eigen::MatrixXd>& X);
/// B - A X, every entry summed in extended precision before it is rounded; all replicated.
Eigen::MatrixXd calc_residual(const SymmetricMatrix& A, const Eigen::Ref<const Eigen::MatrixXd>& X,
                              const Eigen::Ref<const Eigen::MatrixXd>& B);
/// ½ (A + Aᵀ), for a square A that is symmetric up to round-off.
Eigen::MatrixXd symmetrize(const Eigen::MatrixXd& A);
/// The diagonal of A, replicated.
Eigen::VectorXd get_diagonal(const SymmetricMatrix& A);

}  // namespace bough::linear
