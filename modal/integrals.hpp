#pragma once
/// \file The five mass integrals Γ0..Γ4 (docs/theory/flexible-body.md §4): momentum formulas and the exact Gram set.
#include <functional>

#include "fe/matrices/assembly.hpp"
#include "formats/records/flex_body.hpp"
#include "modal/nodal_dofs.hpp"

namespace bough::modal {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using records::MassIntegrals;

/// Momentum formulas with M of the given kind (exact for a lumped M, O(h²) for Γ2..Γ4 of a consistent one).
/// Phi: num_gdofs x n in basic; `reference` S: the integrals are taken about it, p -> p - S (report fig. 11).
MassIntegrals calc_momentum_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi,
                                      const Vector3d& reference = Vector3d::Zero());

/// From the Gram matrix of [Φ_R, e_a×u_j, u] under the mass, u the motion of every piece of it, on arms and between
/// grids too. Masses that are not of bodies (fe/loads/inertial_loads.hpp) count as if e×φ had no rotations.
MassIntegrals calc_exact_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi,
                                   const Vector3d& reference = Vector3d::Zero());

/// Computes the set of integrals with the name `kind`: for a lumped mass, whose pieces are bodies on single grids, the
/// sum over the pieces; otherwise the momentum formulas with M of that kind.
MassIntegrals calc_named_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi);

/// X -> M X for a mass matrix known only by its products, ndof x m.
using MassTimes = std::function<MatrixXd(const MatrixXd&)>;

/// Sets of integrals for any mass matrix and dof map: the model may lack dofs at its nodes and have generalized ones
/// besides (NASA-CR-202063 4.2.2). Phi: num_dofs x n.
MassIntegrals calc_momentum_integrals(const NodalDofs& dofs, const MassTimes& mass_times, const MatrixXd& Phi,
                                      const Vector3d& reference = Vector3d::Zero());
MassIntegrals calc_exact_integrals(const NodalDofs& dofs, const MassTimes& mass_times, const MatrixXd& Phi,
                                   const Vector3d& reference = Vector3d::Zero());

}  // namespace bough::modal
