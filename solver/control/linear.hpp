#pragma once
/// \file Rational functions of s (or z) as state space.
#include <Eigen/Dense>

namespace bough::solver {

struct StateSpace {
  Eigen::MatrixXd A, B, C, D;
};

/// Controllable canonical form of num / den, both by falling powers; den is of no lower degree, its first not zero.
StateSpace make_canonical_form(const Eigen::VectorXd& num, const Eigen::VectorXd& den);
/// Tustin's bilinear transform, s = 2 (z - 1) / (T (z + 1)).
StateSpace discretize_bilinear(const StateSpace& continuous, double sample_time);
/// n equal blocks in parallel: one per component of a vector.
StateSpace repeat(const StateSpace& one, int n);

}  // namespace bough::solver
