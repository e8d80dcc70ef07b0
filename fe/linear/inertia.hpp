#pragma once
/// \file Eigenvalues counted by the signs of pivots (Sylvester's law of inertia).
#include <optional>

#include "fe/linear/symmetric_matrix.hpp"

namespace bough::linear {

/// Eigenvalues of A x = λ B x below mu: the negative ones of A - μB; B positive semidefinite. Empty if a pivot is
/// zero, so that it has no sign. Throws ComputationError "fe.out-of-memory". Collective.
std::optional<int> count_eigenvalues_below(const SymmetricMatrix& A, const SymmetricMatrix& B, double mu);

/// Negative eigenvalues of A + factor B; empty as above.
std::optional<int> count_negative_eigenvalues(const SymmetricMatrix& A, double factor, const SymmetricMatrix& B);
/// Negative eigenvalues of A; empty as above.
std::optional<int> count_negative_eigenvalues(const SymmetricMatrix& A);

}  // namespace bough::linear
