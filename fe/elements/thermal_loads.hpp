#pragma once
/// \file Temperatures of an element, and the loads, initial forces and free strains that they cause.
#include <optional>

#include <Eigen/Dense>

namespace bough::fe {

using Eigen::VectorXd;

/// Temperatures from the grids (TEMP, TEMPD) or from the card of the element (TEMPRB, TEMPP1).
struct ElementTemperature {
  VectorXd node;  ///< at Element::nodes()
  /// Bars: dT/dy, dT/dz of the section at ends A and B, element axes; about the neutral axis.
  Eigen::Vector2d gradient_a = Eigen::Vector2d::Zero(), gradient_b = Eigen::Vector2d::Zero();
  double gradient_z = 0;  ///< plates: dT/dz along the normal; `node` is the temperature of the reference surface
  const ElementTemperature* initial = nullptr;  ///< of TEMPERATURE(INITIAL); none: zero

  /// Change that makes a material expand: from TREF or, without one, from the initial temperature.
  ElementTemperature calc_change(const std::optional<double>& tref) const {
    ElementTemperature change = *this;
    change.initial = nullptr;
    if (tref)
      change.node.array() -= *tref;
    else if (initial) {
      change.node -= initial->node;
      change.gradient_a -= initial->gradient_a;
      change.gradient_b -= initial->gradient_b;
      change.gradient_z -= initial->gradient_z;
    }
    return change;
  }
};

/// Effect of temperatures on an element at u = 0. With them its internal forces are those of u plus `force`, its strain
/// energy is ½ uᵀKu - uᵀ load + energy. Strains and stresses: rows as those of StressRecovery; empty: none.
struct ThermalState {
  ThermalState(int num_dofs, int num_forces) : load(VectorXd::Zero(num_dofs)), force(VectorXd::Zero(num_forces)) {}

  VectorXd load;   ///< N: forces at the nodes that stretch the element as it would stretch freely
  VectorXd force;  ///< s: internal forces
  double energy = 0;
  VectorXd stress;                 ///< stresses in addition to those of `force`: between the plies of a laminate
  VectorXd strain, corner_strain;  ///< free expansion at the strain points; at the corners of solids
};

class ThermalLoads {
 public:
  /// Computes initial forces, free strains and the load of temperatures at u = 0; only for a material that expands.
  virtual ThermalState calc_thermal(const ElementTemperature& T) const = 0;

 protected:
  ~ThermalLoads() = default;
};

}  // namespace bough::fe
