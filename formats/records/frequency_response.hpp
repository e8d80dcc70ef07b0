#pragma once
/// \file Frequency response of a linear model: its transfer matrix, margins of a loop, its peak gain.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/linear_model.hpp"

namespace bough::records {

struct FrequencyResponse {
  std::vector<std::pair<std::string, std::string>> source;  ///< (file name, SHA-256)
  Signals inputs, outputs;
  UnitLabels units;                     ///< of the model
  Eigen::VectorXd frequency_hz;         ///< nf, ascending
  std::vector<Eigen::MatrixXcd> value;  ///< nf of ny x nu: C (jω - A)⁻¹ B + D
  Eigen::MatrixXd singular_values;      ///< nf x min(ny, nu), descending
};

/// Where a loop comes near -1: at one frequency, how far it is.
struct Crossing {
  double frequency_hz = 0;
  double margin = 0;  ///< gain: the factor that brings it to -1; phase: rad of lag that do, in (-π, π]
  double delay = 0;   ///< phase: the time that does, >= 0
};

/// Margins of the loop transfer L with negative feedback, 1 + L.
struct Margins {
  std::vector<Crossing> gain;            ///< where L is real and negative, by frequency
  std::vector<Crossing> phase;           ///< where |L| = 1
  double distance = 0, distance_hz = 0;  ///< least |1 + L| of all frequencies: 1 over the peak of the sensitivity
  bool is_stable = false;                ///< the poles with the loop closed decay, or are at 0 with the loop open too
  double largest_real = 0;               ///< of the poles with the loop closed
};

/// sup σ(G(jω)), the H∞ norm where the model is stable.
struct PeakGain {
  double value = 0, frequency_hz = 0;
  bool is_finite = true;
  bool is_certified = false;  ///< no frequency has 1 + 1e-6 times as much (Bruinsma & Steinbuch)
  std::string why;            ///< it is not finite
};

}  // namespace bough::records
