#pragma once
/// \file Shares of the variance of a signal in an exposure of finite length.
#include <string_view>

namespace bough::statespace {

/// Parts of a signal in a window of length T: mean, smear (line through the mean by least squares), the rest.
/// Source: Lucke, Sirlin & San Martin, J. Astronaut. Sci. 40 (1992) 557; ECSS-E-ST-60-10C.
enum class ExposurePart {
  Total,     ///< 1: the whole signal, without a window
  Mean,      ///< j₀²(x): mean over the window
  Jitter,    ///< 1 - j₀²: about the mean over the window
  Smear,     ///< 3 j₁²: line about the mean
  Residual,  ///< 1 - j₀² - 3 j₁²: about that line
  Drift      ///< 4 sin²(π f τ) j₀²: difference of the means of two windows whose starts are τ apart
};

/// Word of a part in files and tables.
std::string_view get_word(ExposurePart part);

/// Weight of the one-sided spectral density at frequency f, x = π f T, j_n the spherical Bessel functions: the share
/// of the variance of a sine of random phase.
///
/// \param hz        [1/T] frequency, >= 0.
/// \param exposure  [T] length of the window, > 0 but for Total.
/// \param interval  [T] between the starts of two windows, for Drift.
/// \param is_averaged  sin² and cos² of x and π f τ are replaced by 1/2: for intervals of f longer than 1/T.
double calc_exposure_weight(ExposurePart part, double hz, double exposure, double interval = 0,
                            bool is_averaged = false);

}  // namespace bough::statespace
