#pragma once
/// \file The embedded pairs of Dormand and Prince that `rk` steps with.
#include <Eigen/Dense>

namespace bough::solver {

/// Coefficients of an explicit embedded pair in Butcher's notation: k_i = f(t + c_i h, y + h Σ A_ij k_j), the solution
/// y + h Σ b_i k_i of order q, the one it is compared with y + h Σ d_i k_i of order q - 1.
struct ButcherTable {
  int stages = 0, q = 0;
  Eigen::MatrixXd A;  ///< stages x stages, strictly lower triangular
  Eigen::VectorXd b, c, d;
};

/// 7 stages, orders 5 and 4; the last is the first of the next step.
ButcherTable make_dormand_prince_54();
/// 13 stages, orders 8 and 7; c1 = 0, c12 = c13 = 1.
ButcherTable make_dormand_prince_87();

}  // namespace bough::solver
