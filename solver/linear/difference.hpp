#pragma once
/// \file The derivative of a vector function of one number by central differences, extrapolated.
#include <functional>

#include <Eigen/Dense>

namespace bough::solver {

struct Difference {
  Eigen::VectorXd value;
  Eigen::VectorXd error;  ///< estimated, of each entry; an entry that is not larger is 0 for all one knows
};

/// f'(0) of f(h). Steps step, step/2, ...; Richardson's extrapolation, each entry from where its estimated error is
/// least (Ridders, "Accurate computation of F'(x) and F'(x)F''(x)", Adv. Eng. Software 4 (1982) 75). A function that is
/// quadratic gives its derivative to rounding. f may throw ComputationError, or give what is not finite, where the step
/// is too long; where no step is short enough its exception is passed on, or ComputationError "linear.no-derivative"
/// thrown.
Difference differentiate(const std::function<Eigen::VectorXd(double)>& f, double step);

}  // namespace bough::solver
