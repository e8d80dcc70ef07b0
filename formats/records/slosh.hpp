#pragma once
/// \file First antisymmetric slosh mode of a liquid in an upright tank, as a pendulum or a mass on springs
/// (docs/theory/propellant.md).
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

/// Damping ratio of the first mode in a smooth cylinder: 0.79 √ν R^-¾ g^-¼ [1 + 0.318/sinh x (1 + (1 - h/R)/cosh x)],
/// x = 1.84 h/R. Source: NASA SP-106, chapter 4; NASA TN D-1367 (Stephens, Leonard & Perry 1962).
/// \param viscosity  kinematic, L²/T.  \param g  acceleration along the axis, L/T².
double calc_wall_damping(double radius, double depth, double viscosity, double g);
/// Damping ratio that a ring baffle adds in a cylinder: 2.83 exp(-4.60 d/R) α^1.5 √(η/R), α = w/R (2 - w/R) the share
/// of the cross-section that it covers. Source: Miles, J. Appl. Mech. 25 (1958) 274; NASA SP-106, chapter 4; NASA
/// SP-8031. \param width  w, L.  \param depth  d of the ring below the free surface, L.  \param amplitude  η of the
/// wave at the wall, L.
double calc_baffle_damping(double radius, double width, double depth, double amplitude);

/// Adds body and hinge "NAME.slosh" of each tank that sloshes, a pendulum or a mass on springs at the rest position of
/// its bob, and subtracts its mass from the rigid part of the tank. Reports "system.bad-tank".
void add_slosh(SystemSpec& spec, Diagnostics& diagnostics);

}  // namespace bough::records
