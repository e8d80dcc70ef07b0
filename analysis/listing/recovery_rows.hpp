#pragma once
/// \file Rows of element forces and stresses of given motions, in the columns of Nastran's tables.
#include <functional>
#include <vector>

#include "fe/model/model.hpp"
#include "formats/records/deck.hpp"

namespace bough::analysis {

/// Makes the tables MEF1 (forces) and MES1 (stresses) of the elements that `wants_force` and `wants_stress` select: one
/// column per motion.
/// \param U  num_gdofs x n motions, basic; L and rad.
/// \param loads  LOAD set of each motion, whose loads along beams are in the forces, 0: none; empty: none.
/// \return without tables that have no element. Stresses of laminates and corner stresses are left out.
/// \note Collective.
std::vector<records::RecoveryTable> make_recovery_rows(const fe::Model& model, const records::Deck& deck,
                                                       const Eigen::MatrixXd& U, const std::vector<int>& loads,
                                                       const std::function<bool(int)>& wants_force,
                                                       const std::function<bool(int)>& wants_stress);

}  // namespace bough::analysis
