#pragma once
/// \file Memory estimate of the factor of a large stiffness matrix, before the matrix is assembled.
#include "fe/model/model.hpp"

namespace bough::fe {

/// Entries of LLᵀ of the free dofs, about: those of the graph of grids that elements join, in the order of its nested
/// dissection (METIS), times the dofs of a grid each way. A tenth of the time of the factor or less.
double estimate_factor_entries(const Model& model);

/// Throws ComputationError "fe.out-of-memory" where the factor of at least `min_fdofs` equations will not fit the
/// memory, or the numbers that CHOLMOD counts with; on one process.
void require_memory_for_factor(const Model& model, int min_fdofs = 500'000);

}  // namespace bough::fe
