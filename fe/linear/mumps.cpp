#include "fe/linear/mumps.hpp"

#include <optional>
#include <string>
#include <utility>

#include "base/diagnostic.hpp"
#include "fe/linear/dense_matrix.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;

class MumpsSolver final : public FactorSolver {
 public:
  explicit MumpsSolver(PetscMat factor) : factor_(std::move(factor)) {}

  MatrixXd solve(const Eigen::Ref<const MatrixXd>& B) const override {
    if (B.cols() == 0) return B;
    const PetscMat rhs = make_dense(factor_.get(), B);
    if (initialize_petsc().size == 1) {
      MatrixXd X(B.rows(), B.cols());
      check_petsc(MatMatSolve(factor_.get(), rhs.get(), share_dense(X).get()));
      return X;
    }
    PetscMat X;
    check_petsc(MatDuplicate(rhs.get(), MAT_DO_NOT_COPY_VALUES, X.out()));
    check_petsc(MatMatSolve(factor_.get(), rhs.get(), X.get()));
    return replicate(X.get());
  }
  void solve_vector(Vec b, Vec x) const override { check_petsc(MatSolve(factor_.get(), b, x)); }
  const char* name() const override { return "LDLᵀ MUMPS"; }
  double num_entries() const override {
    MatInfo info;
    check_petsc(MatGetInfo(factor_.get(), MAT_LOCAL, &info));
    return info.nz_used;
  }

 private:
  PetscMat factor_;
};

/// An option of PETSc while it lives.
class PetscOption {
 public:
  PetscOption(const char* name, const char* value) : name_(name) {
    check_petsc(PetscOptionsSetValue(nullptr, name, value));
  }
  ~PetscOption() { PetscOptionsClearValue(nullptr, name_); }
  PetscOption(const PetscOption&) = delete;
  PetscOption& operator=(const PetscOption&) = delete;

 private:
  const char* name_;
};

/// One attempt with a workspace of `extra_percent` more than MUMPS estimates.
MumpsFactor try_factor(Mat A, const MumpsOptions& options, PetscInt extra_percent) {
  PetscMat factor;
  check_petsc(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, factor.out()));
  Mat F = factor.get();
  check_petsc(MatMumpsSetIcntl(F, 14, extra_percent));
  if (options.finds_null_pivots) {
    check_petsc(MatMumpsSetIcntl(F, 24, 1));
    check_petsc(MatMumpsSetCntl(F, 3, 1e-15));
  }
  // The inertia leaves out the root front when ScaLAPACK factors it: keep it sequential.
  if (options.counts_negative) check_petsc(MatMumpsSetIcntl(F, 13, 1));
  if (!options.keeps_factor) check_petsc(MatMumpsSetIcntl(F, 31, 1));
  MatFactorInfo info;
  check_petsc(MatFactorInfoInitialize(&info));
  check_petsc(MatCholeskyFactorSymbolic(F, A, nullptr, &info));
  check_petsc(MatCholeskyFactorNumeric(F, A, &info));
  MatFactorError error = MAT_FACTOR_NOERROR;
  PetscInt status = 0, detail = 0, number = 0;
  check_petsc(MatFactorGetError(F, &error));
  check_petsc(MatMumpsGetInfog(F, 1, &status));
  check_petsc(MatMumpsGetInfog(F, 2, &detail));
  MumpsFactor result;
  result.state = judge_factorization(status, detail);
  if (result.state == FactorState::Done && error != MAT_FACTOR_NOERROR) result.state = FactorState::Singular;
  if (result.state != FactorState::Done) return result;
  if (options.finds_null_pivots) {
    check_petsc(MatMumpsGetInfog(F, 28, &number));
    result.num_null_pivots = static_cast<int>(number);
  }
  if (options.counts_negative) {
    check_petsc(MatGetInertia(F, &number, nullptr, nullptr));
    result.num_negative = static_cast<int>(number);
  }
  if (options.keeps_factor) result.solver = std::make_unique<MumpsSolver>(std::move(factor));
  return result;
}

}  // namespace

FactorState judge_factorization(int status, int detail) {
  if (status >= 0) return FactorState::Done;
  if (status == -8 || status == -9) return FactorState::NeedsWorkspace;
  if (status == -10) return FactorState::Singular;
  const bool is_memory = status == -13 || status == -7 || status == -19 || status == -22;
  const std::string own = "code " + std::to_string(status) + " (" + std::to_string(detail) + ") of MUMPS";
  if (is_memory)
    throw ComputationError("fe.out-of-memory", {}, "the factor of the stiffness matrix does not fit the memory, " + own,
                           "use a coarser mesh, or run on more processes of a larger machine (mpirun -n 2 bough ...)");
  throw ComputationError("fe.factorization", {}, "the stiffness matrix cannot be factored, " + own,
                         "look for values that are no numbers or of extreme size in properties, materials and grids");
}

MumpsFactor factor_by_mumps(Mat A, const MumpsOptions& options) {
  // PETSc 3.18 loses ICNTL(7) unless it is an option. To count, approximate minimum fill: half the time of MUMPS' own
  // choice on plates.
  constexpr const char* kOrdering = "-mat_mumps_icntl_7";
  PetscBool is_chosen = PETSC_FALSE;
  check_petsc(PetscOptionsHasName(nullptr, nullptr, kOrdering, &is_chosen));
  std::optional<PetscOption> ordering;
  if (!is_chosen && options.counts_negative) ordering.emplace(kOrdering, "2");
  MumpsFactor result;
  for (const PetscInt extra_percent : {options.counts_negative ? 60 : 50, 200, 1000}) {
    result = try_factor(A, options, extra_percent);
    if (result.state != FactorState::NeedsWorkspace) break;
  }
  return result;
}

}  // namespace bough::linear
