#pragma once
/// \file Negative eigenvalues of a large sparse sum, counted front by front.
#include <optional>

#include "fe/linear/symmetric_matrix.hpp"

namespace bough::linear {

/// The number of negative eigenvalues of A + factor B (Sylvester's law of inertia), by a multifrontal LDLᵀ (Duff &
/// Reid, ACM TOMS 9 (1983) 302) that keeps no factor: O(n^1.5) operations and a stack of O(n log n) numbers on shells.
/// In the order of the dissection of A, its two parts at once where there are two threads and B does not couple them. A
/// front's own
/// rows are eliminated by LLᵀ where they are positive, else by LDLᵀ with pivoting among them (Bunch & Kaufman). Empty,
/// for a method that pivots freely: where that is not enough, pivots being so small that their front adds to a row more
/// than `kMaxGrowth` times what A and B have on its diagonal; matrices of less than `min_rows` rows, without row
/// groups, or with a low-rank part; several processes. Throws "fe.out-of-memory".
std::optional<int> count_negative_by_fronts(const SymmetricMatrix& A, double factor, const SymmetricMatrix& B,
                                            PetscInt min_rows = 3000);

/// Negative eigenvalues of a dense matrix, of which the lower triangle is given and lost; -1 where a pivot is zero.
int count_negative_of_dense(Eigen::MatrixXd& S);

}  // namespace bough::linear
