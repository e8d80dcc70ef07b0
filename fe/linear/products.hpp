#pragma once
/// \file Products and diagonals of symmetric matrices, sparse or with a part of low rank.
#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// A X of a distributed A and a replicated X, replicated.
Eigen::MatrixXd multiply(Mat A, const Eigen::Ref<const Eigen::MatrixXd>& X);
/// B - A X, every entry summed in extended precision before it is rounded; all replicated.
Eigen::MatrixXd calc_residual(Mat A, const Eigen::Ref<const Eigen::MatrixXd>& X,
                              const Eigen::Ref<const Eigen::MatrixXd>& B);
/// The diagonal of A, replicated.
Eigen::VectorXd get_diagonal(Mat A);

}  // namespace bough::fe
