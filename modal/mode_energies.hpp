#pragma once
/// \file Strain and kinetic energy of every element in every mode (Nastran's ESE and EKE).
#include "fe/model/model.hpp"
#include "formats/records/modes.hpp"

namespace bough::modal {

/// Phi: num_gdofs x n. Strain ½ φᵀK_eφ (K_G0 of a preload with it), kinetic ½ φᵀM_eφ with the mass kind of the model;
/// totals of K and M as assembled. Replicated.
records::ModeEnergies calc_mode_energies(const fe::Model& model, const records::Deck& deck,
                                         const Eigen::Ref<const Eigen::MatrixXd>& Phi);

}  // namespace bough::modal
