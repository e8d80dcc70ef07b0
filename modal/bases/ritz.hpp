#pragma once
/// \file Small dense steps of every basis: Rayleigh-Ritz, removal of rigid motions and of dependent vectors, residual
/// vectors.
#include <functional>

#include "modal/bases/fixed_interface.hpp"

namespace bough::modal::bases {

/// K N = M N D of m x m matrices, ascending, NᵀMN = 1. Directions whose share of M is below 1e-12 are no motion of
/// their own, so N may have fewer than m columns: dependent vectors go, massless ones follow the others statically
/// (Guyan). Solved as M x = θ K x where K is definite: the lowest values keep their digits next to values many orders
/// larger.
struct RitzPairs {
  VectorXd lambda;
  MatrixXd N;
  MatrixXd massless = {};  ///< m x k, those that strain and have no mass, xᵀKx = 1
};
/// Solves the dense problem; M and K are symmetric, M positive semidefinite.
RitzPairs calc_ritz_pairs(const MatrixXd& M, const MatrixXd& K);

/// Loads F [num_gdofs x m] in equilibrium with the inertia of the body: F - M R RᵀF, R = `rigid`, M-orthonormal. Twice:
/// next to a mass of 1e8 the first pass leaves the round-off of F itself, which drives the body and strains it.
MatrixXd equilibrate(const fe::Model& model, const MatrixXd& rigid, MatrixXd F);

/// u_g for loads F_g (num_gdofs x m) on some support.
using StaticSolve = std::function<MatrixXd(const MatrixXd& F_g)>;

struct ResidualVectors {
  ModeSet modes;            ///< pseudo-modes: unit generalized mass, orthogonal to `rigid` and `kept`
  MatrixXd share;           ///< m x n: part of mode j that load i brought, columns sum to one
  std::vector<int> unused;  ///< loads whose static solution the kept modes and the loads before hold already
  /// Loads without a vector whose static solution moves negligible mass and is held by nothing: the part that is lost,
  /// by flexibility (0 to 1).
  std::vector<std::pair<int, double>> massless;
};

/// The part of the static solutions for F that the kept modes leave out: X = K⁻¹F - ΦΛ⁻¹ΦᵀF, and for a free body
/// X = PᵀGPF with P = 1 - MΦ_rΦ_rᵀ, G the flexibility on any determinate support; M-orthogonal to `rigid` and `kept` in
/// two passes, dropped below 1e-6 of the norm of the static solution, then Rayleigh-Ritz (Dickens, Nakagawa &
/// Wittbrodt, Comput. Struct. 62 (1997) 985). `rigid`, `kept`: M-orthonormal, num_gdofs x k.
ResidualVectors calc_residual_vectors(const fe::Model& model, const StaticSolve& solve, const MatrixXd& rigid,
                                      const MatrixXd& kept, const MatrixXd& F);

}  // namespace bough::modal::bases
