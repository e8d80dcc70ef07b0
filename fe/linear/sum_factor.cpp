#include "fe/linear/sum_factor.hpp"

#include <cmath>
#include <memory>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "base/diagnostic.hpp"
#include "fe/linear/factor.hpp"

namespace bough::fe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct SumFactor {
  PetscMat sparse;
  Eigen::SparseMatrix<double> U;
  MatrixXd Y;
  VectorXd unit;  ///< S is scaled by it from both sides
  Eigen::PartialPivLU<MatrixXd> S;
  int num_extra_negative = 0;
};

PetscErrorCode destroy_factor(Mat A) {
  void* context = nullptr;
  check_petsc(MatShellGetContext(A, static_cast<void*>(&context)));
  delete static_cast<SumFactor*>(context);
  return 0;
}

const SumFactor* find_factor(Mat A) { return static_cast<const SumFactor*>(find_shell_context(A, destroy_factor)); }

/// Rows and columns of S to about one.
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

PetscMat make_sum_factor(PetscMat factor, const LowRankPart& part) {
  PetscInt n = 0, local = 0;
  check_petsc(MatGetSize(factor.get(), &n, nullptr));
  check_petsc(MatGetLocalSize(factor.get(), &local, nullptr));
  auto sum = std::make_unique<SumFactor>();
  sum->U = part.U;
  sum->Y = solve_factored(factor.get(), MatrixXd(part.U));
  sum->sparse = std::move(factor);
  MatrixXd S = part.W_inverse + part.U.transpose() * sum->Y;
  S = (0.5 * (S + S.transpose())).eval();
  sum->unit = calc_units(S);
  S = (sum->unit.asDiagonal() * S * sum->unit.asDiagonal()).eval();
  sum->S.compute(S);
  const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues();
  sum->num_extra_negative = static_cast<int>((values.array() > 0).count()) - part.num_positive;
  PetscMat result;
  check_petsc(MatCreateShell(PETSC_COMM_WORLD, local, local, n, n, sum.get(), result.out()));
  check_petsc(MatShellSetOperation(result.get(), MATOP_DESTROY, reinterpret_cast<void (*)()>(destroy_factor)));
  sum.release();
  return result;
}

int count_extra_negative(Mat factor) {
  const SumFactor* sum = find_factor(factor);
  return sum ? sum->num_extra_negative : 0;
}

bool is_sum_factor(Mat factor) { return find_factor(factor) != nullptr; }

bool solve_sum(Mat factor, const Eigen::Ref<const MatrixXd>& B, MatrixXd& X) {
  const SumFactor* sum = find_factor(factor);
  if (!sum) return false;
  X = solve_factored(sum->sparse.get(), B);
  const MatrixXd t = sum->unit.asDiagonal() * (sum->U.transpose() * X);
  X.noalias() -= sum->Y * (sum->unit.asDiagonal() * sum->S.solve(t));
  return true;
}

}  // namespace bough::fe
