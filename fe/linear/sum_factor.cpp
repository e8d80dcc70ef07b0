#include "fe/linear/sum_factor.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

namespace bough::linear {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Scales rows and columns of S to about one.
VectorXd calc_units(const MatrixXd& S) {
  VectorXd unit = VectorXd::Ones(S.rows());
  for (int pass = 0; pass < 3; ++pass)
    for (Eigen::Index i = 0; i < S.rows(); ++i) {
      const double largest = unit(i) * S.col(i).cwiseAbs().cwiseProduct(unit).maxCoeff();
      if (largest > 0 && std::isfinite(largest)) unit(i) /= std::sqrt(largest);
    }
  return unit;
}

}  // namespace

SumSolver::SumSolver(FactorSolverHandle sparse, const LowRankPart& part)
    : sparse_(std::move(sparse)), U_(part.U), Y_(sparse_->solve(MatrixXd(part.U))) {
  MatrixXd S = part.W_inverse + part.U.transpose() * Y_;
  S = (0.5 * (S + S.transpose())).eval();
  unit_ = calc_units(S);
  S = (unit_.asDiagonal() * S * unit_.asDiagonal()).eval();
  S_.compute(S);
  const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues();
  num_extra_negative_ = static_cast<int>((values.array() > 0).count()) - part.num_positive;
}

MatrixXd SumSolver::solve(const Eigen::Ref<const MatrixXd>& B) const {
  MatrixXd X = sparse_->solve(B);
  const MatrixXd t = unit_.asDiagonal() * (U_.transpose() * X);
  X.noalias() -= Y_ * (unit_.asDiagonal() * S_.solve(t));
  return X;
}

}  // namespace bough::linear
