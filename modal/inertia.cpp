/// \file The inertia of a shifted pencil, front by front, or by MUMPS.
#include "fe/linear/factor.hpp"
#include "fe/linear/fronts.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/sum_factor.hpp"
#include "modal/krylov.hpp"

namespace bough::modal::detail {
namespace {

using fe::check_petsc;

/// An option of PETSc while it lives.
class MumpsOption {
 public:
  MumpsOption(const char* name, const char* value) : name_(name) {
    check_petsc(PetscOptionsSetValue(nullptr, name, value));
  }
  ~MumpsOption() { PetscOptionsClearValue(nullptr, name_); }
  MumpsOption(const MumpsOption&) = delete;
  MumpsOption& operator=(const MumpsOption&) = delete;

 private:
  const char* name_;
};

}  // namespace

int count_negative(Mat A, double factor, Mat B) {
  initialize_slepc();
  fe::release_freed_memory();  // the factor and the vectors of the modes
  if (const auto count = fe::count_negative_by_fronts(A, factor, B)) return *count;
  const fe::PetscMat sum = fe::add(A, factor, B);
  const fe::LowRankPart* part = fe::find_low_rank(sum.get());
  Mat C = fe::get_sparse(sum.get());
  // Approximate minimum fill: half the time of MUMPS' own choice on plates. PETSc 3.18 loses this one unless it is an
  // option.
  const MumpsOption ordering("-mat_mumps_icntl_7", "2");
  MatFactorInfo info;
  check_petsc(MatFactorInfoInitialize(&info));
  for (PetscInt extra_percent : {60, 200, 1000}) {
    fe::PetscMat F;
    check_petsc(MatGetFactor(C, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, F.out()));
    // The inertia leaves out the root front when ScaLAPACK factors it: keep it sequential.
    check_petsc(MatMumpsSetIcntl(F.get(), 13, 1));
    check_petsc(MatMumpsSetIcntl(F.get(), 14, extra_percent));
    if (!part)
      check_petsc(MatMumpsSetIcntl(F.get(), 31, 1));  // only the signs of the pivots are wanted: the factor is not kept
    check_petsc(MatCholeskyFactorSymbolic(F.get(), C, nullptr, &info));
    check_petsc(MatCholeskyFactorNumeric(F.get(), C, &info));
    MatFactorError error = MAT_FACTOR_NOERROR;
    PetscInt status = 0, detail = 0, negative = 0;
    check_petsc(MatFactorGetError(F.get(), &error));
    check_petsc(MatMumpsGetInfog(F.get(), 1, &status));
    check_petsc(MatMumpsGetInfog(F.get(), 2, &detail));
    const auto state = fe::judge_factorization(status, detail);
    if (state == fe::FactorState::NeedsWorkspace) continue;
    if (state == fe::FactorState::Singular || error != MAT_FACTOR_NOERROR) return -1;
    check_petsc(MatGetInertia(F.get(), &negative, nullptr, nullptr));
    if (part) negative += fe::count_extra_negative(fe::make_sum_factor(std::move(F), *part).get());
    return static_cast<int>(negative);
  }
  return -1;
}

}  // namespace bough::modal::detail
