#pragma once
/// \file Derivative of a vector function of one number by central differences, Richardson-extrapolated.
#include <functional>

#include <Eigen/Dense>

namespace bough::solver {

struct Difference {
  Eigen::VectorXd value;
  Eigen::VectorXd error;          ///< estimated, of each entry
  Eigen::VectorXd kink;           ///< (f'(0+) - f'(0-)) / 2 of entries with a kink at 0; 0 for the others
  std::vector<char> is_roundoff;  ///< the entry is below its error, and the error is that of roundoff: it is 0

  /// The derivative, with entries that are roundoff set to 0.
  Eigen::VectorXd calc_clean() const;
};

/// Computes f'(0).
///
/// Steps step, step/2, ...; Richardson's extrapolation, each entry from where its estimated error is least (Ridders,
/// "Accurate computation of F'(x) and F'(x)F''(x)", Adv. Eng. Software 4 (1982) 75). A function that is quadratic gives
/// its derivative to roundoff. Steps shrink, to 1e-12 of the first, until two orders agree or roundoff is reached. A
/// last, much shorter step checks that all were short enough; if it disagrees, the steps begin again near that one.
/// \param has_large_terms  f is a small difference of its terms, whose roundoff is measured by eight evaluations more.
/// \throws ComputationError what f throws for every step, or "linear.no-derivative" if f is never finite. Steps at
///     which f throws or is not finite are too long and are passed over.
Difference differentiate(const std::function<Eigen::VectorXd(double)>& f, double step, bool has_large_terms = false);

}  // namespace bough::solver
