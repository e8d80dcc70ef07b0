#pragma once
/// \file Exact mass integrals of fields that strain the arms of attached masses (fe/loads/arm_strains.hpp).
#include "modal/integrals.hpp"

namespace bough::modal {

/// calc_exact_integrals about Bo; strain: 9 x n, E of each column of Phi.
MassIntegrals calc_strained_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi,
                                      const MatrixXd& strain);

}  // namespace bough::modal
