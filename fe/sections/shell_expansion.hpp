#pragma once
/// \file Thermal expansion of the section of a plate: included by shell_section.hpp.
#include <optional>

#include <Eigen/Dense>

namespace bough::fe {

/// Stress resultants that hold a plate whose temperature is T(z) = TREF + t + z g: N = N_t t + N_g g, M = M_t t + M_g g
/// with N_t = ∫Qα dz, M_t = N_g = ∫Qα z dz, M_g = ∫Qα z² dz (Jones, "Mechanics of composite materials", 2nd ed.,
/// eqs. 4.109-4.110); the energy per area is ½ (e_tt t² + 2 e_tg t g + e_gg g²). Axes of the section, Voigt xx yy xy.
struct ShellExpansion {
  Eigen::Vector3d N_t = Eigen::Vector3d::Zero(), M_t = Eigen::Vector3d::Zero();
  Eigen::Vector3d N_g = Eigen::Vector3d::Zero(), M_g = Eigen::Vector3d::Zero();
  double e_tt = 0, e_tg = 0, e_gg = 0;
  std::optional<double> tref;  ///< empty: TEMPERATURE(INITIAL)

  /// Membrane forces N [F/L] of the temperature t and the gradient g.
  Eigen::Vector3d calc_N(double t, double g) const { return t * N_t + g * N_g; }
  /// Moments M [F] of the temperature t and the gradient g.
  Eigen::Vector3d calc_M(double t, double g) const { return t * M_t + g * M_g; }
  /// Strain energy per area [F/L] of the hindered expansion.
  double calc_energy(double t, double g) const { return 0.5 * (e_tt * t * t + 2 * e_tg * t * g + e_gg * g * g); }
};

}  // namespace bough::fe
