#pragma once
/// \file CBEND: a beam along a circular arc. Stiffness from the exact flexibility of the arc, as in
/// shape/beam_field.hpp for the straight beam; mass and geometric stiffness by a chain of straight beams that moves as
/// the arc does. Sources: Nastran Quick Reference Guide, CBEND and PBEND; Timoshenko, Strength of Materials II (1956),
/// §§12-14.
#include "fe/elements/beam.hpp"
#include "fe/elements/carried.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/elements/thermal_loads.hpp"

namespace bough::fe {

/// The arc from end A to end B, in basic.
struct BendGeometry {
  Vector3d centre = Vector3d::Zero();
  Vector3d radial = Vector3d::Zero();   ///< from the centre to end A
  Vector3d tangent = Vector3d::Zero();  ///< at end A towards B, as long as `radial`
  double angle = 0;                     ///< radians, 0 to 2π
};

/// Two nodes of six dofs. The section's y axis is radial, outward: I1 bends in the plane of the arc.
class Bend final : public Element, public StressState, public ThermalLoads, public OffsetMass {
 public:
  Bend(int id, std::vector<int> nodes, std::vector<int> gdofs, std::shared_ptr<const BeamProperty> property,
       const BendGeometry& geometry);

  ElementShape shape() const override { return {"line2", nodes()}; }
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  /// Consistent with the motion of the arc; lumped: half at each end, translations only.
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  const OffsetMass* offset_mass(MassKind kind) const override { return kind == MassKind::Consistent ? this : nullptr; }
  bool add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const override;
  const StressState* stress_state() const override { return this; }
  /// Section forces at ends A and B, on the face towards B, axes tangent, radial (outward), normal to the arc's plane.
  int num_internal_forces() const override { return 12; }
  std::vector<std::string> internal_force_names() const override;
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override;
  /// K_G of the forces at end B, from which the forces at end A follow.
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;

  const ThermalLoads* thermal_loads() const override { return alpha_ != 0 ? this : nullptr; }
  /// Uniform expansion by the mean temperature.
  ThermalState calc_thermal(const ElementTemperature& T) const override;

 private:
  std::vector<std::unique_ptr<const Beam>> parts_;
  std::vector<Vector3d> chain_;  ///< the chain's points
  MatrixXd motion_;           ///< 6 (parts + 1) x 12: displacements of the chain's points by those of the ends, basic
  MatrixXd sections_;         ///< 12 x 12: section forces by displacements
  MatrixXd parts_by_forces_;  ///< 8 parts x 6: internal forces of the parts by the section forces at end B
  MatrixXd K_;
  double mass_scale_ = 1;  ///< arc by chord
  double alpha_ = 0;
  std::optional<double> tref_;
  Vector3d chord_;
};

}  // namespace bough::fe
