#pragma once
/// \file The order in which a factorization eliminates the rows of an assembled matrix.
#include <optional>
#include <vector>

#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// IS, owning.
using PetscIs = PetscHandle<IS, ISDestroy>;

/// Tells A, on one process, that its rows fall into runs that couple alike, as the six of a grid do: run i is
/// [start[i], start[i + 1]).
void set_row_groups(Mat A, const std::vector<int>& start);
/// Gives `to`, a matrix of the same rows, the groups of `from` and the dissection that is known.
void copy_row_groups(Mat from, Mat to);

/// Gives `part`, the rows and columns `kept` (ascending) of `whole`, what is left of its groups, and of its order where
/// nearly all rows are left.
void take_row_groups(Mat whole, const std::vector<int>& kept, Mat part);

/// Nested dissection (METIS; Karypis & Kumar, SIAM J. Sci. Comput. 20 (1998) 359) of the graph of row groups, some
/// thirty times smaller than the graph of rows (Ashcraft, SIAM J. Sci. Comput. 16 (1995) 1404). Empty, for the solver's
/// own choice, where A has no groups or less than `least` rows, or lives on several processes. Costs O(nonzeros) the
/// first time; A keeps it, and copies of its groups take it along.
PetscIs find_elimination_order(Mat A, PetscInt least = 3000);

/// Rows of A, each part in the order of its elimination: no row of `first` couples to one of `second`.
struct TwoParts {
  std::vector<PetscInt> first, second, between;
};
/// The same with the first dissection told apart, kept alike; empty as find_elimination_order(), and below `least`
/// rows.
std::optional<TwoParts> find_two_parts(Mat A, PetscInt least);

}  // namespace bough::fe
