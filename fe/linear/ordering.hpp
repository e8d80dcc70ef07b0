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
/// own choice, where A has no groups or less than `least` rows, or lives on several processes. Costs O(nonzeros) the
/// first time; A keeps it, and sums with A take it along.
std::shared_ptr<const std::vector<PetscInt>> find_elimination_order(const SymmetricMatrix& A, PetscInt least = 3000);

/// The same with the first dissection told apart, kept alike; null as find_elimination_order(), and below `least` rows.
std::shared_ptr<const TwoParts> find_two_parts(const SymmetricMatrix& A, PetscInt least);

}  // namespace bough::linear
