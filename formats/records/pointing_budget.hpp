#pragma once
/// \file Pointing budget: disturbance sources of a linear model and their shares of each output.
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/records/input_density.hpp"
#include "formats/records/linear_model.hpp"

namespace bough::records {

/// Tones of one frequency in several inputs, with fixed phases to each other.
struct ToneRow {
  double number = 1;  ///< frequency over that of the source; below 0: whirls against the spin
  std::vector<std::string> inputs;
  std::vector<double> amplitude, phase;  ///< of each input [unit, rad]: amplitude cos(ωt + phase)
  /// Wheels: F_r, F_a, M_r, M_a over Ω² [F T², F T², F L T², F L T²] and the phase of the moments [rad].
  double radial_force = 0, axial_force = 0, radial_moment = 0, axial_moment = 0, moment_phase = 0;
  SourceLocation at;
};

/// Suspension mode of a wheel on a base at rest.
struct WheelMode {
  double frequency_hz = 0, damping = 0;  ///< [1/T] of the wheel that does not spin; damping ratio
};

struct DisturbanceSource {
  std::string name, type;  ///< type: psd, tones, wheel
  std::vector<InputDensity> densities;
  double frequency_hz = 0;    ///< tones: of number 1 [1/T]
  std::vector<double> speed;  ///< wheel: angular speeds [1/T]
  std::vector<ToneRow> rows;  ///< tones, wheel
  /// Wheel: inputs along two directions normal to the axis and along the axis; third optional. Empty: none.
  std::vector<std::string> force, moment;
  std::optional<WheelMode> radial, axial, rocking;
  double inertia_ratio = 2;  ///< rocking: inertia about the axis over that across it
  SourceLocation at;
};

struct BudgetSpec {
  std::vector<DisturbanceSource> sources;
  std::vector<double> exposures;  ///< [T] windows
  double interval = 0;            ///< [T] between the starts of two windows; 0: no drift
};

/// RMS of every source in every output under one weighting.
struct BudgetTable {
  std::string weighting;  ///< total, jitter, smear, mean, residual, drift
  double exposure = 0;    ///< [T]; 0: total
  Eigen::MatrixXd rms;    ///< num_sources x num_outputs; wheels at the speed that is worst for the output
  Eigen::MatrixXd speed;  ///< num_sources x num_outputs: that speed [1/T]; NaN for other sources
  Eigen::VectorXd total;  ///< root of the sum of squares over sources
  /// Wheels: rms over speed, num_speeds x num_outputs; empty for other sources.
  std::vector<Eigen::MatrixXd> over_speed;
};

/// RMS of one source up to each frequency, without a window; a wheel at the speed that is worst for the output.
struct BudgetCurve {
  Eigen::MatrixXd frequency_hz;  ///< n x num_outputs [1/T], ascending in each column
  Eigen::MatrixXd rms;           ///< n x num_outputs; densities by straight lines between the frequencies
};

struct PointingBudget {
  std::vector<std::pair<std::string, std::string>> source;  ///< (file name, SHA-256)
  Signals outputs;
  double from_hz = 0, to_hz = 0;  ///< band of the spectral densities
  std::vector<std::string> sources;
  std::vector<Eigen::VectorXd> speed;  ///< of each source [1/T]; empty unless a wheel
  std::vector<BudgetTable> tables;
  std::vector<BudgetCurve> curves;  ///< of each source
};

}  // namespace bough::records
