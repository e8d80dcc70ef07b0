/// \file The inertia of a shifted pencil: dense for few rows, front by front for many, or by MUMPS.
// First: the BLAS header needs PETSc's own names.
#include <petscsys.h>

#include <petscblaslapack.h>

#include <optional>

#include "fe/linear/dissection.hpp"
#include "fe/linear/factor.hpp"
#include "fe/linear/fronts.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/sum_factor.hpp"
#include "modal/extraction.hpp"
#include "modal/inertia.hpp"

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

/// MUMPS takes longer than this to set up for fewer rows.
constexpr PetscInt kFewRows = 160;

/// By LDLᵀ with pivots of one or two rows wherever they are (Bunch & Kaufman); empty where the matrices are of another
/// kind or have more rows.
std::optional<int> count_dense(Mat A, double factor, Mat B) {
  if (fe::initialize_petsc().size > 1 || fe::find_low_rank(A) || fe::find_low_rank(B)) return std::nullopt;
  PetscInt size = 0;
  check_petsc(MatGetSize(A, &size, nullptr));
  if (size < 1 || size > kFewRows) return std::nullopt;
  MatrixXd S = MatrixXd::Zero(size, size);  // lower triangle
  for (const auto& [matrix, scale] : {std::pair(A, 1.0), std::pair(B, factor)}) {
    PetscBool is_by_rows = PETSC_FALSE;
    check_petsc(PetscObjectBaseTypeCompare(reinterpret_cast<PetscObject>(matrix), MATSEQAIJ, &is_by_rows));
    if (!is_by_rows) return std::nullopt;
    fe::visit_rows(matrix, [&, scale = scale](const fe::MatrixRows& rows, PetscInt) {
      for (PetscInt r = 0; r < size; ++r)
        for (PetscInt k = rows.start[r]; k < rows.start[r + 1]; ++k)
          if (rows.column[k] <= r) S(r, rows.column[k]) += scale * rows.value[k];
    });
  }
  const auto n = static_cast<PetscBLASInt>(size);
  std::vector<PetscBLASInt> order(static_cast<std::size_t>(n));
  std::vector<double> work(static_cast<std::size_t>(64 * n));
  PetscBLASInt work_size = 64 * n, info = 0;
  LAPACKsytrf_("L", &n, S.data(), &n, order.data(), work.data(), &work_size, &info);
  if (info != 0) return -1;  // a pivot is zero
  int negative = 0;
  for (PetscBLASInt j = 0; j < n; ++j) {
    const bool is_pair = order[static_cast<std::size_t>(j)] < 0;  // of one positive and one negative value
    if (is_pair || S(j, j) < 0) ++negative;
    if (is_pair) ++j;
  }
  return negative;
}

}  // namespace

int count_negative(Mat A, double factor, Mat B) {
  initialize_slepc();
  fe::release_freed_memory();  // the factor and the vectors of the modes
  if (const auto count = count_dense(A, factor, B)) return *count;
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
