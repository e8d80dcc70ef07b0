#pragma once
/// \file CROD, CONROD, CTUBE: axial force and torque only.
/// Sources: Przemieniecki, Theory of Matrix Structural Analysis (1968), §5.1 and §15.2; Argyris et al., CMAME 20
/// (1979), for the torque.
#include "fe/elements/element.hpp"
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/elements/thermal_loads.hpp"

namespace bough::fe {

struct RodProperty {
  double EA = 0, GJ = 0;          ///< for a taper: the length over the integrated compliance
  double mass_a = 0, mass_b = 0;  ///< mass per length at the ends, linear between (nsm included)
  double alpha = 0;               ///< thermal expansion
  std::optional<double> tref;     ///< from there on; empty: TEMPERATURE(INITIAL)
  double ge = 0;                  ///< structural damping
  double area = 0;                ///< the smallest, for stresses; 0: none
  double torsion = 0;             ///< largest shear stress per torque (C/J); 0: none
  double E = 0, G = 0;            ///< of the material, for strains
};

/// Rod between two grids. Mass: translations only; consistent is Nastran's: along the axis the mean of lumped and
/// ∫NᵀNμ (5/12, 1/12), lumped across it. Geometric stiffness: N/L across the axis (taut string), and the
/// torque that turns with the axis (semitangential moments).
class Rod final : public Element, public StressState, public StressRecovery, public ThermalLoads {
 public:
  Rod(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, const RodProperty& property,
      const Vector3d& a, const Vector3d& b);

  ElementShape shape() const override { return {"line2", nodes()}; }
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  const StressState* stress_state() const override { return this; }
  int num_internal_forces() const override { return 2; }
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override;
  std::vector<std::string> internal_force_names() const override { return {"axial", "torque"}; }
  const StressRecovery* stress_recovery() const override { return property_.area > 0 ? this : nullptr; }
  std::vector<StressPoint> stress_points() const override;
  MatrixXd calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const override;
  MatrixXd calc_strains(const Eigen::Ref<const MatrixXd>& forces) const override;
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;
  const ThermalLoads* thermal_loads() const override { return property_.alpha != 0 ? this : nullptr; }
  ThermalState calc_thermal(const ElementTemperature& T) const override;

 private:
  RodProperty property_;
  Vector3d axis_;
  double length_;
};

}  // namespace bough::fe
