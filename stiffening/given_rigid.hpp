#pragma once
/// \file Rigid-body motions of a given stiffness matrix: judged by their Rayleigh quotients, free of round-off.
#include <string>

#include "stiffening/given_elements.hpp"

namespace bough::stiffening {

/// Rayleigh quotients of the six geometric rigid-body motions under a given K and M.
struct RigidMotionCheck {
  bool is_exact = false;  ///< K R = 0 to round-off in every row: nothing to do
  bool is_free =
      false;           ///< the six are rigid, though not exactly: |ρ| below kMaxRigidQuotient of the first elastic one
  double elastic = 0;  ///< first elastic eigenvalue [1/T²], by inertia relief; 0: unknown, as are the following members
  double worst = 0;    ///< largest |ρ| [1/T²]
  int num_rigid = 0;
  int num_mechanisms = 0;  ///< other motions, orthogonal to R, with quotients below kMaxRigidQuotient; 4 are looked for
  SparseRows K;            ///< if is_free: K with K R = 0 to round-off
};

/// Largest Rayleigh quotient of a rigid-body motion, of the first elastic eigenvalue. Condensation in double precision
/// leaves 1e-13 to 1e-7 (the stiffness of one element over that of the whole structure, times ε), nine digits of a
/// DMIG card as much.
inline constexpr double kMaxRigidQuotient = 1e-6;

/// Checks and restores the rigid-body motions R of a free body in its given stiffness matrix.
///
/// A statically determinate support s is chosen, K_oo is the rest; the restored matrix is the one with K_oo whose
/// columns s follow from equilibrium: K_os = -K_oo R_o R_s⁻¹, K_ss = R_s⁻ᵀ R_oᵀ K_oo R_o R_s⁻¹ (the flexible part of a
/// free body is known by its supported stiffness: Craig and Bampton, AIAA J. 6 (1968) 1313). The first elastic
/// eigenvalue is that of the inertia-relief flexibility Pᵀ K_oo⁻¹ P, P = 1 - M R (RᵀMR)⁻¹ Rᵀ, by subspace iteration. A
/// motion without mass is rigid if its energy is below 1e-10 of that of diag K.
///
/// \param K, M  [num_gdofs x num_gdofs], symmetric, basic axes. A free body with springs to ground, or a matrix that is
///     not a stiffness matrix, returns is_exact = is_free = false.
RigidMotionCheck check_rigid_motions(const PointTable& points, const SparseRows& K, const SparseRows& M);

/// "up to 0.0012 Hz, the first elastic mode has 1.35 Hz", for messages.
std::string describe(const RigidMotionCheck& check);

/// Restores the rigid-body motions in the stiffness matrices that a deck selects by K2GG, all together, with the mass
/// of `direct` and `others`; note reduce.rigid-roundoff. No effect where they have them to round-off, or have none.
void restore_direct_stiffness(const records::Deck& deck, const Eigen::Vector3d& origin, const fe::Elements& others,
                              fe::ElementList& direct, Diagnostics& diagnostics);

}  // namespace bough::stiffening
