#pragma once
/// \file Stress resultants of a plate per unit width: the constitutive law of a shell element.
#include <memory>

#include <Eigen/Dense>

#include "fe/sections/shell_expansion.hpp"

namespace bough::fe {

struct ShellStress;

/// [N; M] = [A B; B D] [ε; κ], Q = S γ, in the element's x-y axes about its reference surface. Voigt order xx, yy, xy.
/// (Jones, "Mechanics of composite materials", 2nd ed., eqs. 4.22-4.23.)
struct ShellSection {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();      ///< membrane, F/L
  Eigen::Matrix3d B = Eigen::Matrix3d::Zero();      ///< membrane-bending coupling, F
  Eigen::Matrix3d D = Eigen::Matrix3d::Zero();      ///< bending, F L
  Eigen::Matrix2d S = Eigen::Matrix2d::Zero();      ///< transverse shear, F/L; used when shear_flexible
  bool shear_flexible = true;                       ///< false: no transverse shear deformation (Kirchhoff)
  double mass = 0;                                  ///< per area, nonstructural mass included
  double mass_offset = 0;                           ///< centre of mass above the reference surface
  double rotary_inertia = 0;                        ///< ∫ρ z² dz about the centre of mass
  double drilling = 0;                              ///< stiffness per area against θz - ½(v,x - u,y): 1e-6 K6ROT G t
  double ge = 0;                                    ///< structural damping, of MID1 (MID2 without it) or of the PCOMP
  std::shared_ptr<const ShellExpansion> expansion;  ///< empty: no temperatures in the deck, or no expansion
  std::shared_ptr<const ShellStress> stress;        ///< where its stresses are given; empty: nowhere
};

/// Section seen from axes turned by `angle` (radians) about z from its own: the element's x-axis lies at -angle from
/// the material's.
ShellSection rotate_section(const ShellSection& section, double angle);

}  // namespace bough::fe
