#pragma once
/// \file Eigen's decompositions of the matrices that Bough decomposes, compiled once (base/instances) and not once a
/// source: a symmetric eigenproblem alone costs 6 s. Part of the precompiled headers; nothing needs to include it.
#include <Eigen/Dense>

#include "base/products.hpp"

#ifndef BOUGH_INSTANCE  // base/instances define it as nothing
#define BOUGH_INSTANCE extern
#endif

namespace Eigen {

#if !defined(BOUGH_INSTANCES_OF) || BOUGH_INSTANCES_OF == 1
BOUGH_INSTANCE template class SelfAdjointEigenSolver<MatrixXd>;
BOUGH_INSTANCE template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);
BOUGH_INSTANCE template class SelfAdjointEigenSolver<Matrix3d>;
BOUGH_INSTANCE template SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
BOUGH_INSTANCE template class SelfAdjointEigenSolver<Matrix<double, 6, 6>>;
BOUGH_INSTANCE template SelfAdjointEigenSolver<Matrix<double, 6, 6>>&
SelfAdjointEigenSolver<Matrix<double, 6, 6>>::compute(const EigenBase<Matrix<double, 6, 6>>&, int);
BOUGH_INSTANCE template class SelfAdjointEigenSolver<MatrixXcd>;
BOUGH_INSTANCE template SelfAdjointEigenSolver<MatrixXcd>& SelfAdjointEigenSolver<MatrixXcd>::compute(
    const EigenBase<MatrixXcd>&, int);
BOUGH_INSTANCE template class GeneralizedSelfAdjointEigenSolver<MatrixXd>;
BOUGH_INSTANCE template class LLT<MatrixXd>;
BOUGH_INSTANCE template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
BOUGH_INSTANCE template class LDLT<MatrixXd>;
BOUGH_INSTANCE template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
#endif

#if !defined(BOUGH_INSTANCES_OF) || BOUGH_INSTANCES_OF == 2
BOUGH_INSTANCE template class EigenSolver<MatrixXd>;
BOUGH_INSTANCE template EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute(const EigenBase<MatrixXd>&, bool);
BOUGH_INSTANCE template class ComplexSchur<MatrixXd>;
BOUGH_INSTANCE template ComplexSchur<MatrixXd>& ComplexSchur<MatrixXd>::compute(const EigenBase<MatrixXd>&, bool);
BOUGH_INSTANCE template class JacobiSVD<MatrixXd>;
BOUGH_INSTANCE template class JacobiSVD<MatrixXcd>;
#endif

#if !defined(BOUGH_INSTANCES_OF) || BOUGH_INSTANCES_OF == 3
BOUGH_INSTANCE template class PartialPivLU<MatrixXd>;
BOUGH_INSTANCE template class PartialPivLU<MatrixXcd>;
BOUGH_INSTANCE template class FullPivLU<MatrixXd>;
BOUGH_INSTANCE template void FullPivLU<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;
BOUGH_INSTANCE template void FullPivLU<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
BOUGH_INSTANCE template class HouseholderQR<MatrixXd>;
BOUGH_INSTANCE template void HouseholderQR<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;
BOUGH_INSTANCE template void HouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
BOUGH_INSTANCE template class ColPivHouseholderQR<MatrixXd>;
BOUGH_INSTANCE template void ColPivHouseholderQR<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;
BOUGH_INSTANCE template void ColPivHouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
BOUGH_INSTANCE template class CompleteOrthogonalDecomposition<MatrixXd>;
BOUGH_INSTANCE template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;
BOUGH_INSTANCE template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
#endif

}  // namespace Eigen
