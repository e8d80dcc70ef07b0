#pragma once
/// \file Sections and material of a bar or beam, as the element core wants them.
#include <vector>

#include <Eigen/Dense>

#include "fe/sections/isotropic.hpp"

namespace bough::fe {

/// Section at one station. y, z are the element axes with origin at the shear centre. Second moments are about the
/// neutral axis: I1 = ∫y² (bending in plane 1, about z), I2 = ∫z², I12 = ∫yz; n is the neutral axis, (y, z).
struct BeamSection {
  double x_over_L = 0;
  double A = 0, I1 = 0, I2 = 0, I12 = 0, J = 0;
  double nsm = 0;  ///< nonstructural mass per length, at m
  double nsi = 0;  ///< nonstructural polar inertia per length about m
  Eigen::Vector2d n = Eigen::Vector2d::Zero();
  Eigen::Vector2d m = Eigen::Vector2d::Zero();
};

struct BeamProperty {
  Isotropic material;
  double k1 = 0, k2 = 0;               ///< shear factors of planes 1 and 2; 0: no shear flexibility
  std::vector<BeamSection> stations;   ///< one (uniform), or sorted from 0 to 1
  bool has_section_inertia = false;    ///< mass carries the inertia of the section (CBEAM), not CBAR
  bool has_torsional_inertia = false;  ///< CBAR with NASTRAN BARMASS: ρ (I1 + I2) about the axis

  /// Where stresses are given at ends A and B, (y, z) from the shear centre, as many at both; empty: on the axis.
  std::vector<Eigen::Vector2d> points_a, points_b;

  /// Returns true if one station describes the whole length.
  bool is_uniform() const { return stations.size() == 1; }
  /// Linear between stations (as PBEAM defines it).
  BeamSection calc_section(double x_over_L) const;
};

/// Mass per length of a section about its shear centre, for the motion [u v w θx θy θz]: 6 x 6.
/// bending: with the rotary inertia of the section about its y and z axes.
Eigen::Matrix<double, 6, 6> calc_section_mass(const BeamProperty& property, const BeamSection& s, bool bending);

}  // namespace bough::fe
