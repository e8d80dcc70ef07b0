#pragma once
/// \file Strain of modes element by element: where stiffness spans many orders, sums over the assembled K have lost the
/// soft parts (1e14 + 1 keeps no digit of 1 / 3), while each element by itself knows its own.
#include <string>

#include "fe/matrices/system.hpp"
#include "modal/eigen.hpp"

namespace bough::modal::detail {

struct ElementStrain {
  MatrixXd forces;  ///< Σ K_e u_e, num_gdofs x m
  MatrixXd energy;  ///< Σ u_eᵀ K_e u_e, m x m
  VectorXd parts;   ///< Σ diag(K_e) u_e², m: what the energies are a difference of
  VectorXd whole;   ///< part of it by elements that are not decomposed, m
};

/// Strain energies and forces of displacements X_g, num_gdofs x m; replicated. `decompose`: elements of up to 24 dofs
/// are taken apart into their principal stiffnesses K_e = Σ κ v vᵀ (v scaled by the root of the diagonal, κ below 1e-13
/// is none): the energy Σ κ (vᵀu)² loses only the square of roundoff, where uᵀ(K_e u) loses roundoff itself. Others by
/// K_e u; energy below 1e-13 of its parts is none.
ElementStrain calc_element_strain(const fe::Model& model, const MatrixXd& X_g, bool decompose);

/// Eigenvalues (returned) and vectors (V) of a symmetric positive semidefinite G by Jacobi's rotations, small ones to
/// the digits that diag(G)^-½ G diag(G)^-½ allows, however large others are (Demmel, Veselić, SIAM J. Matrix Anal.
/// Appl. 13, 1992). In the order of G's columns.
VectorXd calc_graded_eigenvalues(MatrixXd G, MatrixXd& V);

/// Modes refined by the strain of the elements.
struct Restored {
  bool is_done = false;  ///< the modes were improved
  double error = 0;      ///< relative, of the worst eigenvalue of the first `number` modes
  std::string changes;   ///< of them, in words; empty: no frequency changed by more than 1e-4
  std::string stiffest;  ///< the element that is far stiffer than others; empty: the mesh is fine, or nothing to report
};

/// Looks at the modes whose energy is below 1e-9 of its parts, zeros among them. Where the elements say otherwise than
/// K, the modes are improved by them: X - A⁻¹(K X - M X Θ), A = K + 1e-13 diag K, and Rayleigh-Ritz, until
/// η = |K⁻¹ᐟ²(K x - θ M x)| / √θ falls no more, which bounds the relative error (Knyazev, Neymeyr, Linear Algebra Appl.
/// 358, 2003); of K⁻¹ the factor of A tells but for 1 + 1e-13 parts / θ. They are better the more of the soft modes are
/// among them: what is left out mixes with them; where they do not begin with the first mode, their error is only said
/// to be 1. Exact zeros stay as they are.
Restored restore_digits(const fe::System& system, int number, bool is_from_first, EigenPairs& pairs);
/// Warning "modal.lost-digits" of what changed and how sure it is.
void warn_of_lost_digits(const Restored& restored, Diagnostics& diagnostics);

}  // namespace bough::modal::detail
