#pragma once
/// \file The five mass integrals Γ0..Γ4 (docs/theory/flexible-body.md §4): momentum formulas and the exact Gram set.
#include "bough/fe/assembly.hpp"
#include "bough/formats/records/flex_body.hpp"

namespace bough::modal {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using records::MassIntegrals;

/// Momentum formulas with M of the given kind (exact for a lumped M, O(h²) for Γ2..Γ4 of a consistent one).
/// Phi: num_gdofs x n in basic; `reference` S: the integrals are taken about it, p -> p - S (report fig. 11).
MassIntegrals calc_momentum_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi,
                                      const Vector3d& reference = Vector3d::Zero());

/// From the Gram matrix of [Φ_R, e_a×φ_j, Φ] under M: exact for any M.
MassIntegrals calc_exact_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi,
                                   const Vector3d& reference = Vector3d::Zero());

}  // namespace bough::modal
