#pragma once
/// \file Dense matrices of PETSc on replicated Eigen matrices.
///
/// Internal to linear.
#include "fe/linear/petsc.hpp"

namespace bough::linear {

/// A PETSc matrix on the storage of `values`, which outlives it and, if const, is not written to. One process only.
PetscMat share_dense(const Eigen::Ref<const Eigen::MatrixXd>& values);
/// This rank's rows of `values`, distributed as the rows of A.
PetscMat make_dense(Mat A, const Eigen::Ref<const Eigen::MatrixXd>& values);
/// The rows of all ranks on every rank.
Eigen::MatrixXd replicate(Mat dense);

}  // namespace bough::linear
