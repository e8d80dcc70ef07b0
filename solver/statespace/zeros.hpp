#pragma once
/// \file Finite transmission zeros of a linear model.
#include <Eigen/Dense>

namespace bough::statespace {

/// The s at which [A - s 1, B; C, D] loses rank (A: n x n, B: n x nu, C: ny x n, D: ny x nu), by distance from zero.
/// The pencil is first reduced to one without infinite zeros (Emami-Naeini & Van Dooren, Automatica 18 (1982) 415),
/// its finite ones then by QZ. States, inputs and outputs are scaled before ranks are judged.
Eigen::VectorXcd calc_zeros(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::MatrixXd& C,
                            const Eigen::MatrixXd& D);

}  // namespace bough::statespace
