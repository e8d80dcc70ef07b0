#pragma once
/// \file Flat three- and four-node shells: membrane, bending, transverse shear, drilling (CTRIA3, CQUAD4, CTRIAR,
/// CQUADR).
///
/// Dofs per node: u v w θx θy θz in basic axes. Inside, element axes: x along side 1-2, z normal, the reference surface
/// at offset d_i above node i (ZOFFS and the warp of a quadrilateral, carried by rigid arms). Bending and shear:
/// discrete Kirchhoff-Mindlin, Katili, "A new discrete Kirchhoff-Mindlin element based on Mindlin-Reissner plate theory
/// and assumed shear strain fields", Parts I (DKMT) and II (DKMQ), IJNME 36 (1993) 1859-1908: β = Σ N_i β_i + Σ P_k
/// Δβ_k s_k, with Δβ_k from the constant shear of side k. Membrane: four nodes with the incompatible modes of Taylor,
/// Beresford & Wilson, IJNME 10 (1976) 1211-1219 (QM6), which pass the patch test; three nodes with constant strain;
/// with drilling rotations as shell_membrane.cpp says. Mass: bilinear (linear) in the translations, with rotary
/// inertia, at the centre of mass of the section; lumped: its row sums, without rotary inertia. Drilling of the plain
/// membranes: penalty on θz - ½(v,x - u,y) (Hughes & Brezzi, CMAME 72 (1989) 105-121), weight as PARAM,K6ROT.
/// Quadrature: 2 x 2 Gauss, or three interior points. K_G: docs/elements/shell.md.
#include <array>

#include "fe/elements/carried.hpp"
#include "fe/elements/element.hpp"
#include "fe/elements/shell_fields.hpp"
#include "fe/elements/spin.hpp"
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/elements/thermal_loads.hpp"

namespace bough::fe {

struct ShellGeometry {
  std::vector<Vector3d> x;  ///< nodes in basic
  double z_offset = 0;      ///< reference surface above the nodes, along the element normal
  /// Unit normals of the whole surface at the nodes (PARAM,SNORM); empty = the element's own normal everywhere.
  /// Rotation about them does no bending, so that a curved surface does not lean on the drilling stiffness.
  std::vector<Vector3d> normals;
};

class Shell final : public Element, public StressState, public StressRecovery, public ThermalLoads, public OffsetMass {
 public:
  /// section: in element axes (x along side 1-2). Geometry must not be degenerate (no area, an angle of 180 degrees or
  /// more).
  Shell(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, const ShellGeometry& geometry,
        const ShellSection& section, shell::MembraneKind kind = shell::MembraneKind::Plain);

  ElementShape shape() const override;
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  /// The mass at points: those of the quadrature of the consistent mass, in halves at both sides of the middle for the
  /// rotary inertia, or the corners for the lumped mass. \param x  corners in basic.
  MassSamples sample_mass(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, const SpinAxis& spin) const;
  const OffsetMass* offset_mass(MassKind kind) const override;
  bool add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const override;
  const StressState* stress_state() const override { return this; }
  /// Nx Ny Nxy Mx My Mxy Qx Qy at each quadrature point, in element axes: M = ∫σ z dz, Q = ∫τ dz. Then, not printed,
  /// what the drilling penalty holds at each, a moment per area about the normal; of a membrane with drilling rotations
  /// the moment about the normal of each corner.
  int num_internal_forces() const override { return (kNumForces + 1) * num_points(); }
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override;
  void calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const override;
  std::vector<std::string> internal_force_names() const override;
  int num_printed_forces() const override { return kNumForces * num_points(); }
  const StressRecovery* stress_recovery() const override { return section_.stress ? this : nullptr; }
  /// Points of the section, for the mean of N and M over the element: top and bottom in its axes, or every ply in its
  /// own.
  std::vector<StressPoint> stress_points() const override;
  MatrixXd calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const override;
  /// Stresses of the resultants at the corners, the field through those of the quadrature points.
  MatrixXd calc_corner_stresses(const Eigen::Ref<const VectorXd>& force) const override;
  /// Points for the mean of N and M likewise: those of the stresses, and the reference surface.
  std::vector<StressPoint> strain_points() const override;
  MatrixXd calc_strains(const Eigen::Ref<const MatrixXd>& forces) const override;
  /// Second order of the element's strains under N, M, Q, of its drilling and of its rigid arms
  /// (docs/elements/shell.md).
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;
  void add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U, const Eigen::Ref<const MatrixXd>& Phi,
                                         GeometricProjection& sums) const override;

  const ThermalLoads* thermal_loads() const override { return section_.expansion != nullptr ? this : nullptr; }
  /// The temperature is interpolated between the corners.
  ThermalState calc_thermal(const ElementTemperature& T) const override;

  /// [L²] area between the corners, projected along the normal.
  double area() const { return area_; }
  const Matrix3d& R_basic_element() const { return R_; }  ///< columns: element axes in basic

  static constexpr int kNumForces = 8;  ///< per point

 private:
  template <int N>
  using Square = Eigen::Matrix<double, 6 * N, 6 * N>;
  template <int N>
  using ForceMap = Eigen::Matrix<double, 9 * N, 6 * N>;
  int num_nodes() const { return num_nodes_; }
  int num_points() const { return num_nodes_; }
  /// Share of each point of quadrature in the area; their sum is one.
  std::vector<double> calc_shares() const;
  /// Mean over the area of what is linear between the corners.
  double calc_mean(const Eigen::Ref<const VectorXd>& corner) const;
  template <int N>
  shell::Corners<N> get_corners() const {
    return xy_.leftCols<N>();
  }
  template <int N>
  void add_stiffness_of(double scale, Eigen::Ref<MatrixXd> K) const;
  /// ∫ N_i N_j dA, or its row sums.
  template <int N>
  Eigen::Matrix<double, N, N> calc_mass_areas_of(MassKind kind) const;
  MatrixXd calc_mass_areas(MassKind kind) const;
  template <int N>
  MassSamples sample_mass_of(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, const SpinAxis& spin) const;
  template <int N>
  void add_mass_of(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const;
  template <int N>
  void add_thermal_of(const ElementTemperature& change, ThermalState& state) const;
  template <int N>
  shell::ShellFields<N> calc_fields() const;
  /// Internal forces per dof of the element, basic axes.
  template <int N>
  ForceMap<N> calc_force_map(const shell::ShellFields<N>& fields) const;
  template <int N>
  struct SecondOrder;
  template <int N>
  SecondOrder<N> calc_second_order(const shell::ShellFields<N>& fields, const double* force) const;
  template <int N>
  void add_geometric_stiffness_of(const Eigen::Ref<const VectorXd>& force, double scale,
                                  Eigen::Ref<MatrixXd> K_G) const;
  template <int N>
  void add_projected_of(const Eigen::Ref<const MatrixXd>& U, const Eigen::Ref<const MatrixXd>& Phi,
                        GeometricProjection& sums) const;
  /// Columns (rows) of the dofs of the surface become those of the nodes, all in element axes: arms, leaning normals.
  template <int N, class Columns>
  void to_nodes(Columns&& local) const;
  /// Dofs of the surface per dof of the nodes, in element axes.
  template <int N>
  Square<N> calc_surface_map() const;
  /// out += scale R (local symmetric, element axes at the nodes) Rᵀ.
  template <int N>
  void add_turned(const Square<N>& local, double scale, Eigen::Ref<MatrixXd> out) const;

  int num_nodes_ = 0;
  shell::MembraneKind kind_;
  bool has_arms_ = false, has_lean_ = false;
  Eigen::Matrix<double, 2, 4> xy_;
  std::array<double, 4> arm_{};
  std::array<Vector3d, 4> normal_;  // at the nodes, in element axes
  Matrix3d R_;
  double z_offset_ = 0, area_ = 0;
  ShellSection section_;
};

}  // namespace bough::fe
