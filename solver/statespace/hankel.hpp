#pragma once
/// \file Gramians and Hankel singular values of the part of a linear model that decays.
#include "formats/records/linear_model.hpp"

namespace bough::statespace {

/// Hankel singular values of the poles with Re λ < -1e-11 |λ| and |λ| above 1e-6 of the largest; the other poles are
/// left out. Square roots of the eigenvalues of the Gramians, so that values below 1e-8 of the largest are round-off.
/// Balanced truncation to r states stays within 2 (σ_r+1 + ... ) of the model at every frequency (Glover, Int. J.
/// Control 39 (1984) 1115).
records::Hankel calc_hankel(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::MatrixXd& C);

/// 2 Σ of all values after the first `kept`.
double calc_truncation_bound(const Eigen::VectorXd& values, int kept);

}  // namespace bough::statespace
