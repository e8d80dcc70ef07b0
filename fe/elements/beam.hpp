#pragma once
/// \file CBAR and CBEAM: one three-dimensional beam core.
///
/// Stiffness from the exact flexibility (shape/beam_field.hpp): Timoshenko with shear factors, Euler-Bernoulli without,
/// unsymmetric and tapered sections, neutral axis off the shear centre. Offsets are rigid arms, pin flags are
/// condensed. Geometric stiffness: docs/elements/beam.md. Forces: see internal_force_names().
/// Sources: Przemieniecki, Theory of Matrix Structural Analysis (1968), §5.6; Friedman & Kosmatka (1993); Yang &
/// McGuire, J. Struct. Eng. 112 (1986).
#include <memory>

#include "fe/elements/beam_field.hpp"
#include "fe/elements/carried.hpp"
#include "fe/elements/element.hpp"
#include "fe/elements/spin.hpp"
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/elements/thermal_loads.hpp"
#include "fe/sections/beam_property.hpp"

namespace bough::fe {

struct BeamGeometry {
  Matrix3d R_basic_element = Matrix3d::Identity();        ///< columns: element axes in basic, x along the shear centres
  double length = 0;                                      ///< between the offset ends
  Vector3d wa = Vector3d::Zero(), wb = Vector3d::Zero();  ///< offsets of the ends from the grids, in basic
  unsigned pin_a = 0, pin_b = 0;                          ///< released element dofs (masks), element axes
  bool is_part = false;                                   ///< of an arc: consistent mass by the field alone
};

/// Force and moment along a beam, in element axes: p1 at x1 to p2 at x2 (per length), or p1 at the point x1.
struct BeamLineLoad {
  double x1 = 0, x2 = 0;  ///< from end A
  bool is_point = false;
  Eigen::Matrix<double, 6, 1> p1 = Eigen::Matrix<double, 6, 1>::Zero(), p2 = p1;
};

class Beam final : public Element, public StressState, public StressRecovery, public ThermalLoads, public OffsetMass {
 public:
  /// \param nodes  two. \param gdofs  twelve. \pre E > 0, length > 0. \param field  of this property and length, shared
  /// with other beams; computed if null.
  Beam(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs,
       std::shared_ptr<const BeamProperty> property, const BeamGeometry& geometry,
       std::shared_ptr<const BeamField> field = nullptr);

  ElementShape shape() const override { return {"line2", nodes()}; }
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  /// Lumped: half the line's mass at each end (tapered: its first moment is kept), translations only for CBAR, with the
  /// torsional inertia of the section for CBEAM. Consistent: ∫ Dᵀ m D with the static field D; CBAR has no section
  /// inertia and Nastran's axial terms (5/12, 1/12); CBEAM has rotary and torsional inertia. NASTRAN BARMASS gives the
  /// CBAR torsional inertia in both, and consistent axial terms.
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;

  /// The mass at points: those of the quadrature of the consistent mass, or the ends for the lumped one, each with the
  /// inertia of its piece of the section that the mass matrix has. The beam turns the points around it as rigid
  /// sections. \param x  ends in basic.
  MassSamples sample_mass(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, const SpinAxis& spin) const;

  const OffsetMass* offset_mass(MassKind kind) const override;
  bool add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const override;

  const StressState* stress_state() const override { return this; }
  int num_internal_forces() const override { return 8; }
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override;
  void calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const override;
  std::vector<std::string> internal_force_names() const override;
  const StressRecovery* stress_recovery() const override { return this; }
  /// At the points of the property (C_a, D_a, ... at end A, C_b, ... at end B): of axial force and bending.
  std::vector<StressPoint> stress_points() const override;
  MatrixXd calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const override;
  MatrixXd calc_strains(const Eigen::Ref<const MatrixXd>& forces) const override;
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;
  void add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U, const Eigen::Ref<const MatrixXd>& Phi,
                                         GeometricProjection& sums) const override;

  const ThermalLoads* thermal_loads() const override { return property_->material.alpha != 0 ? this : nullptr; }
  ThermalState calc_thermal(const ElementTemperature& T) const override;

  /// Equivalent loads at the ends (12, element axes) before pins: ∫ Dᵀ p dx with the element's own field D. The nodal
  /// displacements under them are those of the loaded beam.
  Eigen::Matrix<double, 12, 1> calc_end_load(const BeamLineLoad& load) const;
  /// Equivalent loads at the grids in basic axes, pins and offsets applied.
  Eigen::Matrix<double, 12, 1> calc_grid_load(const Eigen::Matrix<double, 12, 1>& end_load) const;
  /// Corrects internal forces that calc_internal_forces gave for loads along the beam: moments at both ends, axial and
  /// shear forces and torque at end A.
  void add_load_forces(const Eigen::Matrix<double, 12, 1>& end_load, Eigen::Ref<VectorXd> force) const;

  const Beam* as_beam() const override { return this; }
  /// Length, element axes in basic, offsets and pin flags of the ends.
  const BeamGeometry& geometry() const { return geometry_; }
  /// Sections and material, shared by the beams of a property.
  const BeamProperty& property() const { return *property_; }

 private:
  VectorXd calc_thermal_strains(const ElementTemperature& change) const;
  Matrix12d calc_arm_map() const;  ///< arm tip dofs (element axes) per grid dofs (basic)
  Matrix12d calc_release() const;  ///< element end dofs per arm tip dofs: pins condensed
  Matrix12d calc_end_map() const;  ///< element end dofs per grid dofs
  bool has_arms() const { return !geometry_.wa.isZero(0) || !geometry_.wb.isZero(0); }
  bool has_pins() const { return geometry_.pin_a || geometry_.pin_b; }
  /// K += scale Tᵀ local T, T the end map.
  void add_at_grids(const Matrix12d& local, double scale, Eigen::Ref<MatrixXd> K) const;
  void add_arm_stiffness(const Eigen::Ref<const VectorXd>& force, double scale, Eigen::Ref<MatrixXd> K_G) const;
  void add_pin_stiffness(const Eigen::Ref<const VectorXd>& force, double scale, Eigen::Ref<MatrixXd> K_G) const;
  void add_lumped_mass(double scale, Eigen::Ref<MatrixXd> M) const;
  void add_consistent_mass(double scale, Eigen::Ref<MatrixXd> M) const;
  void add_lumped_bodies(const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const;
  void add_consistent_bodies(const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const;

  std::shared_ptr<const BeamProperty> property_;
  BeamGeometry geometry_;
  std::shared_ptr<const BeamField> field_;
};

}  // namespace bough::fe
