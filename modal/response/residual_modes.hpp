#pragma once
/// \file RESVEC of normal modes: residual vectors of the deck's loads after its modes.
#include <string>

#include "fe/matrices/system.hpp"
#include "formats/records/deck_dynamics.hpp"
#include "modal/eigen.hpp"

namespace bough::modal::response {

struct ResidualLoads {
  MatrixXd F;                     ///< num_gdofs x m, basic
  std::vector<std::string> name;  ///< "LOAD 2", "DLOAD 5", "grid 12 component 3"
};

/// RESVEC of the subcase, else PARAM,RESVEC; not asked for without either.
bool asks_residual_vectors(const records::Deck& deck, const records::DynamicSelection& selection);

/// Unit forces at the dofs of USETi U6 and RVDOFi. Reports modal.residual-dof (warning) for dofs that nothing moves.
ResidualLoads collect_unit_loads(const fe::Model& model, const records::DynamicDeck& deck, Diagnostics& diagnostics);

/// LOAD of the subcase, the forces of its DLOAD (over frequency or time), unit forces of
/// collect_unit_loads. Reports what is wrong with them.
ResidualLoads collect_residual_loads(const fe::Model& model, const records::DynamicDeck& deck,
                                     const records::DynamicSubcase& subcase, Diagnostics& diagnostics);

/// Appends to `pairs` (φᵀMφ = 1) the residual vectors of bases::calc_residual_vectors: M-orthonormal among themselves
/// and to the modes; their `residual` is zero, they solve no eigenproblem. Returns the loads that brought none: the
/// modes hold their static answers.
std::vector<std::string> append_residual_vectors(const fe::System& system, const ResidualLoads& loads,
                                                 EigenPairs& pairs);

}  // namespace bough::modal::response
