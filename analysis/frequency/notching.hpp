#pragma once
/// \file Notching: the input of a frequency response is lowered where a response would exceed its limit.
#include <limits>
#include <string>
#include <vector>

#include "formats/records/deck_response.hpp"

namespace bough::analysis {

/// Limit of one output between two frequencies.
struct NotchLimit {
  std::string name;  ///< acceleration:12:3, CBAR:7:axial, as in the columns of CSV
  double value = 0;  ///< magnitude [unit], or spectral density [unit²/Hz]
  double min_hz = 0, max_hz = std::numeric_limits<double>::infinity();
  bool is_density = false;
};

/// Factor of the input between two frequencies.
struct NotchBand {
  double min_hz = 0, max_hz = 0, factor = 1;
};

struct NotchRequest {
  std::vector<NotchLimit> limits;
  std::vector<NotchBand> bands;

  /// Returns true if the input is not changed.
  bool empty() const { return limits.empty() && bands.empty(); }
  /// Returns true if a limit is one of spectral densities.
  bool has_densities() const;
};

/// Reads "NAME=VALUE" or "NAME=VALUE@MIN:MAX". Throws InputError cli.bad-notch.
NotchLimit read_notch_limit(const std::string& text, bool is_density);
/// Reads "MIN:MAX=FACTOR". Throws InputError cli.bad-notch.
NotchBand read_notch_band(const std::string& text);

/// Factor of the input of a subcase.
struct Notch {
  int subcase = 0;
  Eigen::VectorXd hz, factor;   ///< per frequency; 1: full input
  std::vector<std::string> by;  ///< the limit that is met, "band", or empty
};

/// Notches of full inputs, one per subcase of a frequency response, factor 1.
std::vector<Notch> make_notches(const std::vector<records::ResponseSubcase>& subcases);

/// Manual notches, then response-limited ones: factor n(f) = min(1, limit/|y(f)|) over the limits of magnitudes.
/// Multiplies the curves of each subcase by it. Throws InputError cli.bad-notch if no subcase has an output of the
/// name.
void notch_magnitudes(const NotchRequest& request, std::vector<records::ResponseSubcase>& subcases,
                      std::vector<Notch>& notches);

/// Response-limited notches of the spectral density of the input, S n²: n² = min(1, limit/S_y(f)). `random`: the random
/// responses of `subcases`; all subcases of a set get one factor. Throws as notch_magnitudes.
void notch_densities(const NotchRequest& request, const std::vector<records::RandomResponse>& random,
                     std::vector<records::ResponseSubcase>& subcases, std::vector<Notch>& notches);

}  // namespace bough::analysis
