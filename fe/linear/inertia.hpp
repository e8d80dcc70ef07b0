#pragma once
/// \file Eigenvalues counted by the signs of pivots (Sylvester's law of inertia).
#include <optional>

#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// Eigenvalues of A x = λ B x below mu: the negative ones of A - μB; B positive semidefinite. Empty where a pivot is
/// zero, so that it has no sign. Throws ComputationError "fe.out-of-memory". Collective.
std::optional<int> count_eigenvalues_below(Mat A, Mat B, double mu);

/// Negative eigenvalues of A + factor B, of A alone by default; empty as above.
std::optional<int> count_negative_eigenvalues(Mat A, double factor = 0, Mat B = nullptr);

}  // namespace bough::fe
