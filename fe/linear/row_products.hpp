#pragma once
/// \file Products of the rows of a matrix on one process with many vectors.
///
/// Internal to linear.
#include "fe/linear/dissection.hpp"

namespace bough::linear {

/// A X of all rows; two halves at once where there are two threads.
Eigen::MatrixXd multiply_rows(const MatrixRows& A, const Eigen::Ref<const Eigen::MatrixXd>& X);

/// B - A X, each entry summed as if in twice the precision and rounded then (Dot2: Ogita, Rump & Oishi, SIAM J. Sci.
/// Comput. 26 (2005) 1955), or in long double where the processor is too old for it.
Eigen::MatrixXd subtract_precisely(const MatrixRows& A, const Eigen::Ref<const Eigen::MatrixXd>& X,
                                   const Eigen::Ref<const Eigen::MatrixXd>& B);

}  // namespace bough::linear
