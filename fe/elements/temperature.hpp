#pragma once
/// \file Temperatures as an element sees them: Element::add_thermal.
#include <Eigen/Dense>

namespace bough::fe {

/// Of the grids (TEMP, TEMPD), or of the element's own card (TEMPRB, TEMPP1).
struct ElementTemperature {
  Eigen::VectorXd node;  ///< at Element::nodes()
  /// Bars: dT/dy, dT/dz of the section at ends A and B, element axes; about the neutral axis.
  Eigen::Vector2d gradient_a = Eigen::Vector2d::Zero(), gradient_b = Eigen::Vector2d::Zero();
  double gradient_z = 0;  ///< plates: dT/dz along the normal; `node` is the temperature of the reference surface
};

}  // namespace bough::fe
