#pragma once
/// \file Random response of a linear model: spectral densities of the inputs to those of the outputs
/// (docs/theory/random-response.md).
#include <optional>
#include <vector>

#include "formats/records/frequency_response.hpp"
#include "formats/records/random_outputs.hpp"

namespace bough::statespace {

/// Represents the Hermitian matrix S(f) of one-sided spectral densities of the inputs.
class InputSpectrum {
 public:
  /// S_ab on and above the diagonal; terms of one pair add up.
  struct Term {
    Eigen::Index a = 0, b = 0;
    Eigen::VectorXd frequency_hz;  ///< [1/T] ascending; empty: one density at all frequencies
    Eigen::VectorXcd density;
    bool is_log = false;  ///< straight lines of log S over log f
  };
  InputSpectrum(Eigen::Index num_inputs, std::vector<Term> terms) : num_inputs_(num_inputs), terms_(std::move(terms)) {}

  /// Number of inputs, rows of S.
  Eigen::Index num_inputs() const { return num_inputs_; }
  /// Computes S at a frequency [1/T]; num_inputs², Hermitian, 0 outside the tables.
  Eigen::MatrixXcd calc(double hz) const;
  /// Adds the terms of another spectrum of the same inputs.
  void append(const InputSpectrum& other);
  /// Inputs with a density, ascending.
  std::vector<Eigen::Index> list_inputs() const;
  /// Returns true if all densities are real and the same at all frequencies.
  bool is_white() const;
  /// Returns true if a table is interpolated on logarithmic scales.
  bool has_powers() const;
  /// Frequencies of the tables, ascending [1/T].
  std::vector<double> list_corners() const;
  /// Range outside of which S is 0; empty: there is none.
  std::optional<std::pair<double, double>> get_range() const;
  /// A frequency of `hz` at which S has an eigenvalue below -1e-8 of its trace; nothing: S is positive semi-definite.
  std::optional<double> find_indefinite(const std::vector<double>& hz) const;

 private:
  Eigen::Index num_inputs_;
  std::vector<Term> terms_;
};

/// Eigenvalues of the transfer matrix over s; of a model from sample to sample those next to 0 to half the sample rate.
Eigen::VectorXcd list_poles(const records::LinearModel& model);

/// Throws ComputationError "linear.unbounded-random" if an output follows poles that do not decay and that a column of
/// B drives.
void demand_decay(const records::LinearModel& model, const Eigen::MatrixXd& B);

/// S_y = G S Gᴴ, its moments by straight lines between the frequencies of `response`, by integration over the band
/// between the first and the last, and for white inputs of a continuous model by Lyapunov's equation.
///
/// \throws ComputationError "linear.unbounded-random": an output follows poles that do not decay, or poles at 0 while
/// the band begins at 0.
records::RandomOutputs calc_random_outputs(const records::LinearModel& model, const InputSpectrum& input,
                                           const records::FrequencyResponse& response);

}  // namespace bough::statespace
