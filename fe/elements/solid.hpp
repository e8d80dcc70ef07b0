#pragma once
/// \file Solid elements with 4 to 20 nodes (CTETRA, CPYRAM, CPENTA, CHEXA), and 32 (CIHEX3): three translations per
/// node, basic axes.
///
/// Isoparametric, full quadrature. The brick of eight nodes has in addition the nine incompatible modes of Wilson in
/// the form of Taylor, Beresford & Wilson, IJNME 10 (1976) 1211-1219, so that one layer of bricks bends without locking
/// and the patch test still holds. The wedge of six nodes has the same of 1 - ζ² and of the three quadratics over its
/// triangle, so that one layer bends over its thickness; in the plane of its triangle it strains as the triangle of
/// three nodes. The tetrahedron of four nodes and the pyramid of five are plain, stiff elements. Geometric stiffness ∫
/// σ_ab u,a·u,b (Cook et al., "Concepts and applications of finite element analysis", 4th ed., eq. 18.4-10). Lumped
/// mass: the diagonal of the consistent one, scaled (Hinton, Rock & Zienkiewicz 1976). SolidScheme takes the inner
/// modes away or sets the order of the quadrature, as IN and ISOP of PSOLID do.
#include "fe/elements/element.hpp"
#include "fe/elements/spin.hpp"
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/elements/thermal_loads.hpp"
#include "fe/shape/solid_shape.hpp"

namespace bough::fe {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct SolidScheme {
  int points = 0;         ///< 2 or 3 Gauss points a direction (CHEXA; CPENTA along its axis; cubic bricks also 4, as 0)
  bool is_plain = false;  ///< isoparametric without inner modes
};

struct SolidGeometry {
  SolidKind kind = SolidKind::Hexa;
  std::vector<int>
      midside;              ///< per edge: position among the nodes, -1 when absent; empty = none; is_cubic: two an edge
  std::vector<Vector3d> x;  ///< nodes in basic
  SolidScheme scheme;
};

/// Volume (below zero: left-handed) and the smallest Jacobian determinant at the quadrature points over their mean;
/// zero or less: folded.
struct SolidQuality {
  double volume = 0, smallest_ratio = 0;
};
/// Integrates the Jacobian determinant over the points of quadrature; both numbers are 0 for an element without volume.
SolidQuality calc_quality(const SolidGeometry& geometry);

/// Reverses the node order of a left-handed solid by a mirror image in natural coordinates; reorders geometry.x and
/// `nodes`.
void turn_round(SolidGeometry& geometry, std::vector<int>& nodes);

/// Thermal expansion in basic axes, Voigt as the elasticity.
struct SolidExpansion {
  Eigen::Matrix<double, 6, 1> alpha = Eigen::Matrix<double, 6, 1>::Zero();
  std::optional<double> tref;  ///< empty: TEMPERATURE(INITIAL)
};

class Solid final : public Element, public StressState, public StressRecovery, public ThermalLoads {
 public:
  /// C_el: 6 x 6 elasticity in basic axes, Voigt xx yy zz xy yz zx with engineering shears; density per volume;
  /// expansion: empty = none.
  Solid(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, SolidGeometry geometry,
        const Matrix6d& C_el, double density, std::shared_ptr<const SolidExpansion> expansion = nullptr);

  ElementShape shape() const override;
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  /// The mass at points: those of the quadrature of the consistent mass, or the nodes for the lumped one, with the
  /// gradient of the shapes there. Without the incompatible modes, as in the mass.
  MassSamples sample_mass(MassKind kind, const SpinAxis& spin) const;
  const StressState* stress_state() const override { return this; }
  /// The six stresses at every quadrature point, in basic axes.
  int num_internal_forces() const override { return 6 * num_points_; }
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override;
  void calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const override;
  std::vector<std::string> internal_force_names() const override;
  const StressRecovery* stress_recovery() const override { return this; }
  /// The mean of the stresses over the volume, in basic axes: that at the centre where they are linear.
  std::vector<StressPoint> stress_points() const override;
  MatrixXd calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const override;
  /// Stresses at the corners (6 x corners, basic axes) of internal forces (6 points): the field that is linear along
  /// each natural coordinate through those of the quadrature points, by least squares where they are more; the mean
  /// where they are fewer than the corners.
  MatrixXd calc_corner_stresses(const Eigen::Ref<const VectorXd>& force) const override;
  /// Strains C⁻¹ σ; if C is singular, those of minimum norm.
  MatrixXd calc_strains(const Eigen::Ref<const MatrixXd>& forces) const override;
  /// Number of corners: 8, 6, 4 or 5.
  int num_corners() const { return get_num_corners(geometry_.kind); }
  /// Mechanical strains at the corners, six per corner in the order of the grids; a column per column of `forces`.
  MatrixXd calc_corner_strains(const Eigen::Ref<const MatrixXd>& forces) const;
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;
  void add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U, const Eigen::Ref<const MatrixXd>& Phi,
                                         GeometricProjection& sums) const override;

  const ThermalLoads* thermal_loads() const override { return expansion_ != nullptr ? this : nullptr; }
  /// The temperature is interpolated from the nodes with the shapes of the displacements.
  ThermalState calc_thermal(const ElementTemperature& T) const override;

  const Solid* as_solid() const override { return this; }
  /// [L³] volume by the points of quadrature.
  double calc_volume() const { return calc_quality(geometry_).volume; }

 private:
  struct Field;
  std::vector<Field> calc_fields(bool mass) const;
  /// Values at the corners (rows) per value at the quadrature points: see calc_corner_stresses().
  MatrixXd calc_corner_map() const;
  bool is_quadratic() const { return static_cast<int>(geometry_.x.size()) > get_num_corners(geometry_.kind); }
  bool has_modes() const { return num_modes() > 0; }
  int num_modes() const {
    if (geometry_.scheme.is_plain || is_quadratic()) return 0;
    return geometry_.kind == SolidKind::Hexa ? 3 : geometry_.kind == SolidKind::Penta ? 4 : 0;
  }
  MatrixXd calc_force_map(const std::vector<Field>& fields) const;  ///< internal forces per dof
  MatrixXd calc_mode_map(const std::vector<Field>& fields, MatrixXd* condensed) const;

  SolidGeometry geometry_;
  Matrix6d C_el_;
  double density_;
  std::shared_ptr<const SolidExpansion> expansion_;
  int num_points_;
};

}  // namespace bough::fe
