#pragma once
/// \file Component cost for inputs with spectra in place of white noise.
#include "solver/statespace/cost.hpp"

namespace bough::statespace {

/// One-sided power spectral densities of independent inputs: the mean square of input j is ∫ density(·, j) df. Linear
/// between the frequencies, 0 outside of them.
struct Spectrum {
  Eigen::VectorXd frequency_hz;  ///< ascending, >= 0
  Eigen::MatrixXd density;       ///< a row a frequency; a column an input, or one column for all
};

/// V = ∫ Σ_j S_j |y_j|² df and V_i = ∫ Σ_j S_j Re(x_ij (Cᵀȳ_j)_i) df, Σ V_i = V: by make_quadrature with corners at the
/// frequencies given. White noise of unit intensity is a density of 2 at all frequencies. Poles at 0 take no part;
/// throws ComputationError "select.unstable" as calc_component_cost does.
ComponentCost calc_component_cost(const StateSpace& model, const Spectrum& spectrum);

/// Mean square of the difference y - y_r for inputs of the given spectrum.
double calc_mean_square_difference(const StateSpace& full, const StateSpace& reduced, const Spectrum& spectrum);

/// Both side by side: the same inputs, the difference of the outputs.
StateSpace subtract(const StateSpace& full, const StateSpace& reduced);

}  // namespace bough::statespace
