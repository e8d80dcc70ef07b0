#pragma once
/// \file Curved shell of eight or six nodes: membrane, bending, transverse shear, drilling (CQUAD8, CTRIA6).
///
/// Six dofs per node in basic axes. Degenerated continuum (Ahmad, Irons & Zienkiewicz, IJNME 2 (1970) 419-451) in
/// stress resultants: a point is Σ N_i (x_i + z V_i) with the unit normals V_i of the surface at the nodes, its
/// displacement Σ N_i (u_i + z θ_i × V_i). Linear in z, covariant: e_ab = sym x,a·u,b, κ_ab = sym (x,a·d,b + V,a·u,b),
/// γ_a = x,a·d + V·u,a with d = Σ N_i θ_i × V_i. e and γ are interpolated from tying points (shape/shell_tying.hpp), κ
/// is not. Inner degrees of freedom, condensed: a bubble of d (both shapes; without it the thin element locks) and one
/// of u in the tangent plane (quadrilateral: then its membrane is complete to second order on every straight-sided
/// shape). An absent midside node lies midway, turns by the mean, and moves as the Hermite beam between its corners
/// does along the normal. Drilling: penalty on θ·n - ½ rot u, weight as PARAM,K6ROT. The elasticity is taken in local
/// axes at each point.
#include "fe/elements/carried.hpp"
#include "fe/elements/element.hpp"
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/elements/thermal_loads.hpp"
#include "fe/sections/shell_section.hpp"
#include "fe/shape/shell_tying.hpp"

namespace bough::fe {

struct CurvedShellGeometry {
  std::vector<Vector3d> x;       ///< 3 or 4 corners, then as many midside nodes (an absent one: anything), in basic
  std::vector<Vector3d> normal;  ///< unit normals of the surface there
  std::vector<char> is_present;  ///< per midside node
  double z_offset = 0;           ///< reference surface above the nodes, along the normals
};

/// A point of quadrature as the material sees it: x-axis along side 1-2 projected.
struct SurfaceFrame {
  Vector3d x = Vector3d::Zero();      ///< on the reference surface
  Matrix3d R = Matrix3d::Identity();  ///< columns: local axes in basic, z along the normal
  Eigen::VectorXd corner;             ///< (bi)linear shapes of the corners
  double along_r = 0;                 ///< angle from the x-axis to the line of constant s (η)
  double area = 0;                    ///< dA per natural area, negative where the surface folds over
};

class CurvedShell final : public Element,
                          public StressState,
                          public StressRecovery,
                          public ThermalLoads,
                          public OffsetMass {
 public:
  /// sections: one, or one per point of quadrature, in material axes; angle: per point, from the frame's x-axis to the
  /// material's (radians). nodes: those present, corners first.
  CurvedShell(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, CurvedShellGeometry geometry,
              std::vector<ShellSection> sections, std::vector<double> angle);

  /// The frames at the points of quadrature of a geometry: to find angles and to see that nothing folds over.
  static std::vector<SurfaceFrame> calc_frames(const CurvedShellGeometry& geometry);

  ElementShape shape() const override;
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  /// Consistent: the shapes, with rotary inertia. Lumped: its diagonal scaled to the mass (Hinton, Rock & Zienkiewicz
  /// 1976), without rotary inertia. Both at the centre of mass of the section.
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  const OffsetMass* offset_mass(MassKind kind) const override;
  bool add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const override;
  const StressState* stress_state() const override { return this; }
  /// Nx Ny Nxy Mx My Mxy Qx Qy at each point of quadrature, in its frame; then what the drilling penalty holds at each,
  /// a moment per area about the normal, which is not printed.
  int num_internal_forces() const override { return (kNumForces + 1) * num_points(); }
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override;
  void calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const override;
  std::vector<std::string> internal_force_names() const override;
  int num_printed_forces() const override { return kNumForces * num_points(); }
  const StressRecovery* stress_recovery() const override { return sections_.front().stress ? this : nullptr; }
  /// Points of the section, for the mean of N and M over the element: top and bottom in the axes of the points, or
  /// every ply in its own.
  std::vector<StressPoint> stress_points() const override;
  MatrixXd calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const override;
  /// Points for the mean of N and M likewise: those of the stresses, and the reference surface.
  std::vector<StressPoint> strain_points() const override;
  MatrixXd calc_strains(const Eigen::Ref<const MatrixXd>& forces) const override;
  /// Second order of e, κ, γ (sampled and interpolated as they are) with d_i = exp(θ_i) V_i, and of the drilling.
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;
  void add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U, const Eigen::Ref<const MatrixXd>& Phi,
                                         GeometricProjection& sums) const override;

  const ThermalLoads* thermal_loads() const override { return sections_.front().expansion != nullptr ? this : nullptr; }
  /// The temperature is interpolated from the corners and the midside nodes (the mean of its corners where one is
  /// absent).
  ThermalState calc_thermal(const ElementTemperature& T) const override;

  /// Area of the reference surface by the points of quadrature [L²].
  double calc_area() const;

  static constexpr int kNumForces = 8;

 private:
  struct Surface;  // position and director with their derivatives at a sample
  struct Operators;
  /// Masses between the nodes: ∫ (1, z, z²) ρ N_i N_j dV, z along the normals at the nodes.
  struct NodalMasses {
    MatrixXd zeroth, first, second;
    std::vector<Vector3d> normal;
  };
  NodalMasses calc_nodal_masses(MassKind kind) const;
  int num_points() const { return static_cast<int>(tying_->points.size()); }
  /// Σ over the points of quadrature of their share of the area times of(point).
  template <class Of>
  MatrixXd sum_over_points(const Of& of) const;
  /// Stresses and strains that a change of temperature adds, if the section has stresses.
  void set_thermal_strains(const VectorXd& nodal, double gradient_z, ThermalState& state) const;
  /// Temperatures of the full set of nodes: of a midside node that is absent the mean of its corners.
  VectorXd calc_nodal_temperatures(const ElementTemperature& T) const;
  double calc_temperature(const VectorXd& nodal, int point) const;
  int num_full() const { return tying_->num_nodes; }
  int num_bubbles() const { return tying_->num_corners == 4 ? 4 : 2; }
  Surface calc_surface(int sample) const;
  Operators calc_operators(bool with_drilling) const;
  ShellSection calc_section(int point) const;
  /// (u_i, d_i) of the full set of nodes on the reference surface per dof of the element.
  MatrixXd calc_map() const;
  /// Stiffness on (u_i, d_i, bubbles); drilling is added in calc_drilling().
  MatrixXd calc_full_stiffness(const Operators& operators) const;
  /// Bubbles per (u_i, d_i): rows as the bubbles.
  MatrixXd calc_bubble_map(const MatrixXd& full) const;
  /// (u_i, d_i, bubbles) per dof of the element.
  MatrixXd calc_inner_map(const Operators& operators) const;
  MatrixXd calc_force_map(const Operators& operators, const MatrixXd& inner_map) const;  ///< internal forces per dof
  /// K_G(force) on (u_i, d_i, bubbles), and what of it acts on the rotations of the element's dofs at once.
  void calc_second_order(const Operators& operators, const Eigen::Ref<const VectorXd>& force, MatrixXd& inner,
                         MatrixXd& at_nodes) const;
  int find_dof(int full_node, int component) const;

  const ShellTying* tying_;
  std::vector<Vector3d> x_, normal_;  // of the full set, on the reference surface
  std::vector<int> place_;            // of the full set among the nodes, -1 = absent
  double z_offset_ = 0;
  std::vector<ShellSection> sections_;
  std::vector<double> angle_;
  Eigen::Matrix<double, 3, 2> bubble_;  // directions of the bubbles
};

}  // namespace bough::fe
