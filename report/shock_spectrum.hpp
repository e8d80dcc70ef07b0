#pragma once
/// \file Shock response spectra of evenly sampled base accelerations.
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::report {

/// Response of the oscillator z̈ + ω/Q ż + ω² z = -a, z the displacement relative to the base.
enum class ShockKind {
  AbsoluteAcceleration,  ///< z̈ + a
  StaticAcceleration,    ///< -ω² z, equivalent static acceleration
  PseudoVelocity,        ///< ω z
  RelativeVelocity,      ///< ż
  RelativeDisplacement   ///< z
};
enum class ShockPart {
  Maximax,   ///< largest magnitude
  Positive,  ///< largest value
  Negative,  ///< largest value of the negative response
  Primary,   ///< largest magnitude during the samples
  Residual   ///< largest magnitude after the last sample, where the base does not accelerate
};
/// Names of ShockKind in its order: "absolute-acceleration" and others.
const std::vector<std::string>& list_shock_kinds();
/// Names of ShockPart in its order: "maximax" and others.
const std::vector<std::string>& list_shock_parts();
/// Returns the kind of a name. \pre The name is in list_shock_kinds().
ShockKind find_shock_kind(const std::string& name);
/// Returns the part of a name. \pre The name is in list_shock_parts().
ShockPart find_shock_part(const std::string& name);

/// Spectrum at frequencies [1/T], from rest at the first sample. The acceleration is linear between the samples
/// (ramp-invariant: Smallwood, Shock and Vibration Bulletin 51 (1981) 279), the step between them exact; extremes are
/// those at the samples, after them those of the free vibration.
/// \param quality  Q = 1/2ζ, above 1/2.
Eigen::VectorXd calc_shock_spectrum(const Eigen::VectorXd& acceleration, double step, const Eigen::VectorXd& hz,
                                    double quality, ShockKind kind, ShockPart part);

}  // namespace bough::report
