#pragma once
/// \file Linear isotropic elasticity of a bar's material.
#include <optional>

namespace bough::fe {

/// E, G in stress, density in mass per volume (deck units). G is independent of E and ν, as MAT1 allows.
struct Isotropic {
  double E = 0, G = 0, rho = 0;
  double alpha = 0;            ///< thermal expansion
  std::optional<double> tref;  ///< from there on; empty: TEMPERATURE(INITIAL)
  double ge = 0;               ///< structural damping
};

}  // namespace bough::fe
