#pragma once
/// \file The order in which a factorization eliminates the rows of an assembled matrix.
///
/// Internal to linear.
#include <memory>
#include <vector>

#include "fe/linear/symmetric_matrix.hpp"

namespace bough::linear {

/// Copies row groups and ordering of `from` to `to`, a matrix with the same rows.
void copy_row_order(const SymmetricMatrix& from, const SymmetricMatrix& to);

/// Copies the row groups of `whole` to `part`, its rows and columns `kept` (ascending), and its ordering if nearly all
/// rows are kept.
void take_row_order(const SymmetricMatrix& whole, const std::vector<int>& kept, const SymmetricMatrix& part);

/// Nested dissection (METIS; Karypis & Kumar, SIAM J. Sci. Comput. 20 (1998) 359) of the graph of row groups, some
/// thirty times smaller than the graph of rows (Ashcraft, SIAM J. Sci. Comput. 16 (1995) 1404). Null, for the solver's
/// own choice, where A has no groups or less than `min_rows` rows, or lives on several processes. Costs O(nonzeros) the
/// first time; A keeps it, and sums with A take it along.
std::shared_ptr<const std::vector<PetscInt>> find_elimination_order(const SymmetricMatrix& A, PetscInt min_rows = 3000);

/// Elimination order with the two subdomains of the first dissection, cached as find_elimination_order() does; null in
/// its cases and below `min_rows` rows.
std::shared_ptr<const TwoParts> find_two_parts(const SymmetricMatrix& A, PetscInt min_rows);

}  // namespace bough::linear
