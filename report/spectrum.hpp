#pragma once
/// \file Spectra of evenly sampled curves.
#include <Eigen/Dense>

namespace bough::report {

struct Spectrum {
  Eigen::VectorXd frequency;  ///< 1/T, from zero to half the rate of the samples
  Eigen::VectorXd value;
};

/// One-sided power spectral density after Welch (IEEE Trans. Audio Electroacoust. 15, 1967): segments of `segment`
/// samples that overlap by half (rounded down), each without its mean, under Hann's periodic window; squares averaged.
/// Units of y² T. The segment is cut to the samples there are. Demands two samples and step > 0.
Spectrum calc_psd(const Eigen::VectorXd& y, double step, Eigen::Index segment);

/// Spectrum of all samples minus their least-squares line, under a periodic Hann window: the amplitude of a sine with a
/// whole number of periods.
Spectrum calc_amplitudes(const Eigen::VectorXd& y, double step);

}  // namespace bough::report
