#pragma once
/// \file Stresses and strains in a plate's section from its stress resultants: the two surfaces of a PSHELL, every ply
/// of a PCOMP.
#include "fe/sections/shell_section.hpp"
#include "fe/sections/stress.hpp"

namespace bough::fe {

/// Homogeneous: N/t + z M/I at z1 and z2, the linear distribution that has the resultants N and M. Laminate: strains
/// [ε; κ] of the resultants by the section's stiffness, in the middle of each ply, in its axes 1 and 2 (Jones,
/// "Mechanics of composite materials", 2nd ed., 4.2); between plies the shear that keeps them in equilibrium.
struct ShellStress {
  struct Layer {
    double z = 0;                                 ///< of its middle, above the reference surface
    double angle = 0;                             ///< from the x-axis of the section to its 1-axis
    Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();  ///< in its own axes
    Eigen::Vector3d alpha = Eigen::Vector3d::Zero();
    FailureTheory theory = FailureTheory::None;
    records::PlyStrength strength;
    /// Shear stresses xz, yz above it, in the axes of the laminate, per [Qx; Qy] in those of the section.
    Eigen::Matrix2d shear = Eigen::Matrix2d::Zero();
  };
  double t = 0;        ///< homogeneous: N/t; 0: no membrane
  double inertia = 0;  ///< I per width; 0: no bending
  double z1 = 0, z2 = 0;
  std::vector<Layer> layers;  ///< from the bottom up; empty: homogeneous
  bool has_shear = false;     ///< between the layers: not without bending
  double bond = 0;            ///< shear strength between them; 0: none
};

/// "bottom" and "top" in the axes of the section, or "ply1", "ply2", ..., then "bond1", ... between those; none without
/// section.stress.
std::vector<StressPoint> list_stress_points(const ShellSection& section);
/// Stresses there per [N; M; Q], rows as list_stress_names().
Eigen::Matrix<double, Eigen::Dynamic, 8> calc_stress_map(const ShellSection& section);
/// Thermal strains of the plies by the temperature t + z g; empty for one material.
Eigen::VectorXd calc_ply_expansion(const ShellSection& section, double t, double g);

/// Points of strain output: those of stresses but the bonds, and the reference surface, "mid": its strains and
/// curvatures.
std::vector<StressPoint> list_strain_points(const ShellSection& section);
/// Mechanical strains there per [N; M]: ε + z κ of [ε; κ] = [A B; B D]⁻¹ [N; M]. Without membrane (bending) stiffness
/// the section has no strain of that kind.
Eigen::Matrix<double, Eigen::Dynamic, 6> calc_strain_map(const ShellSection& section);
/// Thermal strains by the temperature t + z g: the free expansion of the section as a whole.
Eigen::VectorXd calc_section_expansion(const ShellSection& section, double t, double g);

}  // namespace bough::fe
