#pragma once
/// \file The transfer matrix of a linear model over frequency (docs/theory/linear.md).
#include <complex>
#include <vector>

#include "formats/records/frequency_response.hpp"

namespace bough::statespace {

/// G(s) = C (s - A)⁻¹ B + D: A balanced and brought to Hessenberg's form once, then O(n² nu) for each s (Laub, IEEE
/// Trans. AC 26 (1981) 407).
class TransferMatrix {
 public:
  TransferMatrix(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::MatrixXd& C,
                 const Eigen::MatrixXd& D);
  /// ny x nu; entries are not finite at a pole.
  Eigen::MatrixXcd calc(std::complex<double> s) const;
  /// (s - A)⁻¹ B, n x nu, in the states of the model.
  Eigen::MatrixXcd calc_states(std::complex<double> s) const;

 private:
  Eigen::MatrixXcd solve(std::complex<double> s) const;
  Eigen::MatrixXd H_, B_, C_, D_, back_;
};

/// Argument of G at a frequency: iω, for a sampled model exp(iωT).
std::complex<double> calc_argument(const records::LinearModel& model, double omega);

struct FrequencyRange {
  double from_hz = 0, to_hz = 0;   ///< 0: a decade beyond the poles, and the zeros near them
  int points = 300;                ///< even on a logarithmic scale; more where a resonance or a notch wants them
  int max_points = 6000;           ///< in all
  std::vector<double> corners_hz;  ///< more of them, of the inputs; also 0
};

/// Frequencies: even on a logarithmic scale, about the lightly damped poles, and between them until no entry changes by
/// more than a third of its size from one to the next.
records::FrequencyResponse calc_frequency_response(const records::LinearModel& model, const FrequencyRange& range = {});

/// The range, and where its ends are open as much further as |L| > 1 there at the upper end, or |L| < 1 at the lower
/// end of a loop with poles at 0: to where |L| = 1, by decades, eight at most; and to a decade beyond all finite zeros
/// that turn the phase of L.
FrequencyRange widen_for_loop(const records::LinearModel& loop, const FrequencyRange& range);

/// Margins of a loop L with one input and one output; crossings are located to round-off. Those of a lifted loop (N
/// inputs and outputs, docs/theory/linear.md, "Margins") by the eigenvalues of L. Throws nothing.
records::Margins calc_margins(const records::LinearModel& loop, const records::FrequencyResponse& response);

/// The largest singular value: of the response's frequencies first, then by eigenvalues of the Hamiltonian matrix until
/// there is no larger (Bruinsma & Steinbuch, Systems & Control Letters 14 (1990) 287; models of at most 300 states,
/// others have what the frequencies show). Poles that do not decay and are seen between inputs and outputs make it
/// infinite; those at 0 that are not seen take no part.
records::PeakGain calc_peak_gain(const records::LinearModel& model, const records::FrequencyResponse& response);

}  // namespace bough::statespace
