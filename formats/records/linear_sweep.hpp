#pragma once
/// \file Linear models along a parameter or along the time of a run, or modes of a deck over the speed of its rotors;
/// poles are followed from one to the next.
#include "formats/records/linear_model.hpp"

namespace bough::records {

struct LinearSweep {
  std::vector<std::pair<std::string, std::string>> source;  ///< (file name, SHA-256)
  std::string parameter;                                    ///< its name, "time", or "point" of a grid
  Eigen::VectorXd value;                                    ///< np; of a grid 1 to np
  std::vector<std::string> grid_name;                       ///< parameters of a grid, two or more; empty: no grid
  std::vector<Eigen::VectorXd> grid_value;  ///< of each; the last one changes fastest from model to model
  std::vector<LinearModel> models;          ///< np, all with the same states, inputs and outputs; none of a deck
  /// np x nx, column b the same motion all along: poles of each model in that order.
  Eigen::MatrixXd real, imag, frequency_hz, damping;
  Eigen::MatrixXd correlation;  ///< np x nx, with the motion at the value before; 1 in the first row
  /// np x nx, orbit across the axis of rotation: 1 a circle in the direction of the spin, -1 against it, 0 along a line
  /// or none; empty if not known.
  Eigen::MatrixXd whirl;
  std::vector<std::vector<std::string>> mode;  ///< np of nx: the coordinate that takes part most
};

/// "forward", "backward", or "line" below 1e-3: the word for a whirl.
inline const char* name_whirl(double whirl) { return whirl > 1e-3 ? "forward" : whirl < -1e-3 ? "backward" : "line"; }

/// z = exp(λ sample_time) of branch b at value k of a sampled sweep; 0 where it is gone.
std::complex<double> calc_z(const LinearSweep& sweep, Eigen::Index k, Eigen::Index b);
/// Value of parameter `axis` of a grid at point k.
double get_grid_value(const LinearSweep& sweep, Eigen::Index k, std::size_t axis);
/// "rate = 4", of a grid "rate = 4, fill = 0.5".
std::string describe_point(const LinearSweep& sweep, Eigen::Index k);
/// Returns true for branches of a sampled sweep at z = 0 all along: their λ is the logarithm of round-off.
bool is_gone(const LinearSweep& sweep, Eigen::Index b);

}  // namespace bough::records
