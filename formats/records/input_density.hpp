#pragma once
/// \file Spectral densities of the inputs of a linear model, as a user gives them (docs/random-response.md).
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::records {

/// One-sided spectral density of an input, or the cross-spectral density S_ab = E[a b*] of inputs a and b.
struct InputDensity {
  std::string input;  ///< a name of the model, or all its components; empty: all inputs
  std::string with;   ///< b of a cross-spectral density; empty: an auto-spectral density
  /// [1/T] ascending; the density is 0 outside. Empty: one density at all frequencies.
  std::vector<double> frequency_hz;
  std::vector<double> real, imag;  ///< [unit² T]; of the a and b of a cross term [unit_a unit_b T]. imag: or empty
  bool is_log = false;             ///< straight lines of log S over log f between the frequencies
  SourceLocation at;
};

}  // namespace bough::records
