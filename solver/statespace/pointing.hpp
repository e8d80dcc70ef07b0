#pragma once
/// \file Mean squares of the outputs of a linear model by disturbance source, weighted by exposures.
#include <complex>
#include <vector>

#include "formats/records/pointing_budget.hpp"
#include "solver/statespace/exposure.hpp"
#include "solver/statespace/frequency_response.hpp"
#include "solver/statespace/random_outputs.hpp"

namespace bough::statespace {

/// One weighting of spectral densities.
struct ExposureWeight {
  ExposurePart part = ExposurePart::Total;
  double exposure = 0, interval = 0;  ///< [T]
  /// Weight at a frequency; `length` [1/T] of the interval of integration.
  double calc(double hz, double length = 0) const;
};

/// Integrates w(f) G S Gᴴ for every source and weighting, over the band of `response`.
///
/// \param inputs   spectra of the sources, each of all inputs of the model.
/// \return by weighting: num_sources x num_outputs mean squares [unit²].
/// \throws ComputationError "linear.unbounded-random": an output follows poles that do not decay.
/// \note O(frequencies (n² nu + sources ny nu²)). Gauss' rule between corners at multiples of 1/T and 1/τ; beyond 256
/// of them sin² is averaged, where the weights of means are below 2e-6; drift
/// is off by up to 20 % above the 256th multiple of 1/τ.
std::vector<Eigen::MatrixXd> integrate_exposures(const records::LinearModel& model,
                                                 const std::vector<InputSpectrum>& inputs,
                                                 const records::FrequencyResponse& response,
                                                 const std::vector<ExposureWeight>& weights);

/// Computes the RMS of the outputs up to each frequency of `response`, by straight lines of the density.
///
/// \param input     spectrum of all inputs of the response.
/// \return num_frequencies x num_outputs [unit].
Eigen::MatrixXd calc_running_rms(const InputSpectrum& input, const records::FrequencyResponse& response);

/// Transfer of a radial or axial force, or of an axial moment, through the suspension of a wheel on a base at rest:
/// (ω₀² + 2iζω₀ω) / (ω₀² - ω² + 2iζω₀ω).
std::complex<double> calc_wheel_transfer(const records::WheelMode& mode, double omega);

/// Transfer of a moment that rotates with ω (below 0: against the spin) through the rocking modes of a wheel of spin Ω:
/// (ω₀² + 2iζω₀ω) / (ω₀² + ρΩω - ω² + 2iζω₀ω), θ = θ_x + iθ_y, I_t θ̈ - i I_s Ω θ̇ + c θ̇ + k θ = M exp(iωt), ρ = I_s /
/// I_t. Source: Masterson, Miller & Grogan, J. Sound Vib. 249 (2002) 575.
std::complex<double> calc_rocking_transfer(const records::WheelMode& mode, double inertia_ratio, double omega,
                                           double spin);

/// Complex amplitudes u of the inputs of a tone at angular frequency |ω|: u(t) = Re(u exp(i|ω|t)).
struct Tone {
  double omega = 0;  ///< [1/T] >= 0
  Eigen::VectorXcd amplitude;
};

/// Mean squares ½ |G(iω) u|² w(f) of the outputs, summed over the tones.
///
/// \return by weighting: num_outputs [unit²].
std::vector<Eigen::VectorXd> calc_tones(const records::LinearModel& model, const TransferMatrix& transfer,
                                        const std::vector<Tone>& tones, const std::vector<ExposureWeight>& weights);

}  // namespace bough::statespace
