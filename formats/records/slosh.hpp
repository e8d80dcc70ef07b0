#pragma once
/// \file First antisymmetric slosh mode of a liquid in an upright tank, as a pendulum (docs/theory/propellant.md).
#include "formats/records/system_spec.hpp"

namespace bough::records {

/// Pendulum of the first mode; heights from the bottom of a cylinder, from the centre of a sphere. ω² = g / length.
struct SloshPendulum {
  double mass = 0;    ///< M
  double length = 0;  ///< L
  double hinge = 0;   ///< L; height of the pendulum's hinge, the bob hangs `length` below
};

/// ω² = g ξ/R tanh(ξh/R), m1/m = 2 tanh(ξh/R)/(ξ h/R (ξ² - 1)), ξ = 1.84118. Source: NASA SP-106, chapter 6; Dodge,
/// The New "Dynamic Behavior of Liquids in Moving Containers" (2000), table 3.1.
/// \param depth  [L] of the liquid at rest.
SloshPendulum calc_cylinder_slosh(double radius, double depth, double density);
/// The Rayleigh-Ritz solution of the potential flow by 20 harmonic polynomials; the hinge is the centre. Relative
/// errors of ω² below 3e-4 up to 90 % of the diameter (McIver, J. Fluid Mech. 201 (1989) 243), 1e-3 at 95 %.
SloshPendulum calc_sphere_slosh(double radius, double depth, double density);
/// Depth of `mass` in a sphere.
double calc_sphere_depth(double radius, double density, double mass);

/// Adds body and hinge "NAME.slosh" of each tank that sloshes, and subtracts the mass of the pendulum from the
/// rigid part of the tank. Reports "system.bad-tank".
void add_slosh(SystemSpec& spec, Diagnostics& diagnostics);

}  // namespace bough::records
