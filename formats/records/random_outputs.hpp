#pragma once
/// \file Random response of a linear model: spectral densities, RMS values and crossing rates of its outputs.
#include <string>

#include "formats/records/linear_model.hpp"

namespace bough::records {

struct RandomOutputs {
  Signals outputs;
  Eigen::VectorXd frequency_hz;      ///< nf, ascending [1/T]
  Eigen::MatrixXd psd;               ///< nf x ny, one-sided [unit² T]
  Eigen::VectorXd rms, crossing_hz;  ///< over these frequencies, by straight lines of the density
  Eigen::MatrixXd cumulative_rms;    ///< nf x ny, from the first frequency to each
  /// RMS and N0 by integration between the first and the last frequency.
  Eigen::VectorXd band_rms, band_crossing_hz;
  /// RMS and N0 of white inputs from 0 to infinity by Lyapunov's equation; infinite if the integral diverges. Empty if
  /// not computed.
  Eigen::VectorXd total_rms, total_crossing_hz;
  std::string no_total;  ///< why there is none
};

}  // namespace bough::records
