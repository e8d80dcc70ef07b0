#pragma once
/// \file Linear isotropic elasticity of a bar's material.

namespace bough::fe {

/// E, G in stress, density in mass per volume (deck units). G is independent of E and ν, as MAT1 allows.
struct Isotropic {
  double E = 0, G = 0, rho = 0;
  double alpha = 0, tref = 0;  ///< thermal expansion from tref on
  double ge = 0;               ///< structural damping
};

}  // namespace bough::fe
