#pragma once
/// \file Schur form of small dense complex matrices by LAPACK, with the largest eigenvalues first.
#include <vector>

#include "modal/complex/quadratic_pencil.hpp"

namespace bough::modal::complex_modes {

/// A = Z T Zᴴ, T upper triangular, |T_ii| descending.
struct SchurForm {
  MatrixXcd T, Z;
};
/// Throws ComputationError "modal.complex-convergence" if the QR iteration does not converge.
SchurForm calc_schur(MatrixXcd A);
/// Eigenvectors of T, upper triangular, of unit length: columns for its first `count` eigenvalues.
MatrixXcd calc_triangular_vectors(const MatrixXcd& T, Index count);

}  // namespace bough::modal::complex_modes
