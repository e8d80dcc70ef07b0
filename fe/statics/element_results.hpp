#pragma once
/// \file Element results of static solutions and bodies: internal forces, stresses, strains, grid point forces.
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/statics/static_case.hpp"

namespace bough::fe {

/// All internal forces (s x m) of an element for the columns of U_g (num_gdofs x m).
MatrixXd calc_internal_forces(const Element& element, const Eigen::Ref<const MatrixXd>& U_g);

/// Stresses of every element that has some, with what is derived from them, by card in alphabetical order. Elements of
/// one card whose points differ are another block: "CQUAD4", "CQUAD4-2". Arguments as of calc_element_forces.
/// Replicated.
std::vector<records::ElementStresses> calc_element_stresses(const Model& model, const VectorXd& u_g,
                                                            const records::Deck& deck, int load,
                                                            const InitialForces& initial = {});

/// Strains likewise, of the displacements: those of temperatures are among them, σ = C (ε - α ΔT). Solids give those at
/// their corners too. Replicated.
std::vector<records::ElementStresses> calc_element_strains(const Model& model, const VectorXd& u_g,
                                                           const records::Deck& deck, int load,
                                                           const InitialForces& initial = {});

/// Forces on each of the grids (ids; empty: all): of every element, and LOAD, SPC, MPC (rigid elements too), INERTIA of
/// `solved`, in basic axes. Their sum is zero. Force of an element: -(K_e u - load of its temperatures).
std::vector<records::GridForce> calc_grid_forces(const Model& model, const records::StaticSubcase& solved,
                                                 const InitialForces& initial, const std::vector<int>& grids);

}  // namespace bough::fe
