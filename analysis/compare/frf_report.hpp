#pragma once
/// \file Computed frequency responses against measured functions.
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "analysis/common/events.hpp"

namespace bough::analysis {

/// A measured function and the computed curve of its point, over the measured frequencies in the computed range.
struct FrfPair {
  std::string name;  ///< of the curve: acceleration:12:3
  std::string test;  ///< identification of the function
  int reference = 0, reference_direction = 0;
  int num_points = 0;
  double frac = 0;                       ///< frequency response assurance criterion, 0 to 1
  double level_db = 0;                   ///< 20 lg of the RMS of the curve over that of the function
  double peak_hz = 0, test_peak_hz = 0;  ///< of the largest magnitudes
};

struct FrfReport {
  std::string file_a, file_b;
  int subcase = 0;
  std::vector<FrfPair> pairs;  ///< in the order of the file
  int num_unmatched = 0;       ///< functions without a curve
  double frac = 0;             ///< of all functions together
};

/// FRAC = abs(Σ H_a* H_b)² / (Σ abs(H_a)² Σ abs(H_b)²) (Heylen & Lammens, Proc. Int. Conf. Structural Dynamics
/// Modelling (1996) 177); the computed curve is interpolated by straight lines of its real and imaginary part.
///
/// \param response  file that `frequency` wrote
/// \param functions  universal file with datasets 58
/// \throws InputError cli.no-test-functions, cli.test-reference, and those of the readers. Warning: cli.test-functions.
FrfReport compare_responses(const std::string& response, const std::string& functions, Events& events);

}  // namespace bough::analysis
