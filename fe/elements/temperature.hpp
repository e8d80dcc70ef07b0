#pragma once
/// \file Temperatures as an element sees them: Element::add_thermal.
#include <optional>

#include <Eigen/Dense>

namespace bough::fe {

/// Of the grids (TEMP, TEMPD), or of the element's own card (TEMPRB, TEMPP1).
struct ElementTemperature {
  Eigen::VectorXd node;  ///< at Element::nodes()
  /// Bars: dT/dy, dT/dz of the section at ends A and B, element axes; about the neutral axis.
  Eigen::Vector2d gradient_a = Eigen::Vector2d::Zero(), gradient_b = Eigen::Vector2d::Zero();
  double gradient_z = 0;  ///< plates: dT/dz along the normal; `node` is the temperature of the reference surface
  const ElementTemperature* initial = nullptr;  ///< what TEMPERATURE(INITIAL) says; none: zero

  /// What makes a material expand: the change from TREF on or, without one, from the initial temperature.
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

}  // namespace bough::fe
