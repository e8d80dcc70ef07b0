#pragma once
/// \file Plane-stress laws of ply materials and the stress-resultant law of plates and laminates.
#include <optional>

#include "fe/sections/shell_section.hpp"

namespace bough::fe {

/// A material as a plate sees it, in its own axes.
struct PlaneMaterial {
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();  ///< plane stress, xx yy xy
  Eigen::Matrix2d G = Eigen::Matrix2d::Zero();  ///< transverse shear xz, yz
  bool shear_rigid = false;                     ///< no transverse shear flexibility (MAT8 without G1Z, G2Z)
  double rho = 0;
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();  ///< thermal expansion
  std::optional<double> tref;
  double ge = 0;  ///< structural damping
};

/// Plane stress of an isotropic material: Q11 = E/(1 - ν²), Q33 = G, both transverse shear moduli G.
PlaneMaterial make_isotropic_plane(double E, double G, double nu, double rho);
/// MAT8 (Jones, "Mechanics of composite materials", 2nd ed., eq. 2.70).
PlaneMaterial make_orthotropic_plane(double E1, double E2, double nu12, double G12, double G1z, double G2z, double rho);

/// Seen from axes at -angle from the material's own.
PlaneMaterial rotate_material(const PlaneMaterial& material, double angle);

/// Seen from axes at -angle from the material's own.
Eigen::Vector3d rotate_strain(const Eigen::Vector3d& strain, double angle);

struct LaminateLayer {
  PlaneMaterial material;  ///< already in the laminate's axes
  double thickness = 0;
};

/// A, B, D of layers stacked from z0 upward (Jones, eqs. 4.22-4.23) with the transverse shear stiffness of each
/// direction from the equilibrium shear flow of cylindrical bending: 1/S = ∫ F² / G dz / (EI)² with
/// F(z) = ∫ E (z' - z̄) dz' (MSC Nastran's PCOMP; Whitney, "Shear correction factors for orthotropic laminates", 1973).
/// One homogeneous layer gives 5/6 G t.
ShellSection make_laminate_section(const std::vector<LaminateLayer>& layers, double z0);
/// The shear stresses xz and yz above each layer per unit Qx and Qy, in the laminate's axes, of the same equilibrium:
/// τ = -Q F(z) / (EI), so a parabola over the thickness of one material and zero above the last layer.
std::vector<Eigen::Vector2d> calc_interlaminar_shear(const std::vector<LaminateLayer>& layers);
/// One layer of the same thickness, stretch and free expansion in the plane as all of them, whatever their order; rigid
/// in transverse shear where one of them is.
LaminateLayer smear(const std::vector<LaminateLayer>& layers);

/// The expansion of the same stack; tref is not set.
ShellExpansion make_laminate_expansion(const std::vector<LaminateLayer>& layers, double z0);

}  // namespace bough::fe
