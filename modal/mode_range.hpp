#pragma once
/// \file Range of requested modes, ascending: a number, a range of frequencies, or both.
#include "modal/eigen.hpp"

namespace bough::modal::detail {

/// Converts a frequency to an eigenvalue: (2π hz)².
double calc_lambda(double hz);

/// The least and the first too large eigenvalue of a range: roots on its ends lie inside, whatever their last digits
/// and those of their copies.
double calc_lower(const EigenOptions& options);
double calc_upper(const EigenOptions& options);

/// Positions wanted, [first, last). The inertia of the factor guesses them, the roots found decide: the inertia is off
/// where parts move without strain and with negligible mass.
struct ModeRange {
  int first = 0, last = 0;

  /// Returns true if the range contains no eigenvalue.
  bool is_empty() const { return last <= first; }
  /// Adjusts both ends to the roots: `lambda`, ascending, the first `cut` of them complete, `available` exist. True
  /// when more roots have to be found first.
  bool fit(const EigenOptions& options, const VectorXd& lambda, int cut, int available);
};

}  // namespace bough::modal::detail
