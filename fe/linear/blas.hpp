#pragma once
/// \file The dense product of the BLAS that PETSc uses: Eigen's own is three times slower where the compiler may not
/// use the processor's wide registers.
#include <Eigen/Dense>

namespace bough::linear {

/// C = op(A) B + beta C, op(A) = Aᵀ when `transposed`; column-major blocks with separate leading dimensions.
void multiply_dense(bool transposed, const Eigen::Ref<const Eigen::MatrixXd>& A,
                    const Eigen::Ref<const Eigen::MatrixXd>& B, double beta, Eigen::Ref<Eigen::MatrixXd> C);
/// Aᵀ B.
Eigen::MatrixXd calc_inner_products(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                    const Eigen::Ref<const Eigen::MatrixXd>& B);

}  // namespace bough::linear
