#include "fe/linear/blas.hpp"

// First: the BLAS header needs PETSc's own names.
#include <petscsys.h>

#include <petscblaslapack.h>

#include <algorithm>

#include "base/diagnostic.hpp"

namespace bough::fe {

void multiply_dense(bool transposed, const Eigen::Ref<const Eigen::MatrixXd>& A,
                    const Eigen::Ref<const Eigen::MatrixXd>& B, double beta, Eigen::Ref<Eigen::MatrixXd> C) {
  BOUGH_DEMAND((transposed ? A.rows() : A.cols()) == B.rows() && (transposed ? A.cols() : A.rows()) == C.rows() &&
               B.cols() == C.cols());
  if (C.size() == 0) return;
  const auto as_blas = [](Eigen::Index i) { return static_cast<PetscBLASInt>(i); };
  const PetscBLASInt m = as_blas(C.rows()), n = as_blas(C.cols()), k = as_blas(B.rows());
  const PetscBLASInt lda = as_blas(std::max<Eigen::Index>(1, A.outerStride()));
  const PetscBLASInt ldb = as_blas(std::max<Eigen::Index>(1, B.outerStride()));
  const PetscBLASInt ldc = as_blas(C.outerStride());
  const double one = 1;
  BLASgemm_(transposed ? "T" : "N", "N", &m, &n, &k, &one, A.data(), &lda, B.data(), &ldb, &beta, C.data(), &ldc);
}

}  // namespace bough::fe
