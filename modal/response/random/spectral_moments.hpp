#pragma once
/// \file Integrals of a spectral density that is given at frequencies.
#include <Eigen/Dense>

namespace bough::modal::response {

/// Per column of the spectral density S: m0 = ∫S df, m2 = ∫f²S df. RMS = √m0, N0 = √(m2/m0).
struct SpectralMoments {
  Eigen::VectorXd m0, m2;
};

/// Exact integrals of S as straight lines between the frequencies, as MSC Nastran; `is_loglog`: straight lines of log S
/// over log f where both ends of a piece are positive.
SpectralMoments calc_moments(const Eigen::VectorXd& hz, const Eigen::MatrixXd& psd, bool is_loglog);

/// R(τ) = ∫S cos 2πfτ df per lag (row) and column; exact for straight lines.
Eigen::MatrixXd calc_autocorrelation(const Eigen::VectorXd& hz, const Eigen::MatrixXd& psd,
                                     const Eigen::VectorXd& lags);

/// R_ab(τ) = Re ∫S_ab exp(2πifτ) df per lag; exact for straight lines of the real and the imaginary part.
Eigen::VectorXd calc_correlation(const Eigen::VectorXd& hz, const Eigen::VectorXcd& psd, const Eigen::VectorXd& lags);

}  // namespace bough::modal::response
