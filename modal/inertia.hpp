#pragma once
/// \file Inertia of a shifted pencil.
#include "fe/linear/petsc.hpp"

namespace bough::modal::detail {

/// Negative eigenvalues of A + factor B by an LDLᵀ factorization (Sylvester): for a positive semi-definite B and
/// factor = -μ the number of eigenvalues of A x = λ B x below μ. -1 when the factorization met a zero pivot.
int count_negative(Mat A, double factor, Mat B);

}  // namespace bough::modal::detail
