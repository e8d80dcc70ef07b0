/// The last step of a model that is built with a prestress: it is solved whether the structure stands.
#include <algorithm>

#include "fe/linear/factor.hpp"
#include "fe/linear/sum_factor.hpp"
#include "fe/matrices/system.hpp"
#include "fe/model/builder.hpp"
#include "fe/statics/statics.hpp"

namespace bough::fe {
namespace {

/// By the inertia of MUMPS, on several ranks.
bool has_negative_pivot(Mat whole) {
  Mat A = get_sparse(whole);
  MatFactorInfo info;
  check_petsc(MatFactorInfoInitialize(&info));
  for (const PetscInt extra_percent : {60, 200, 1000}) {
    PetscMat F;
    check_petsc(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, F.out()));
    check_petsc(MatMumpsSetIcntl(F.get(), 13, 1));  // the inertia leaves out a root front that ScaLAPACK factors
    check_petsc(MatMumpsSetIcntl(F.get(), 14, extra_percent));
    check_petsc(MatCholeskyFactorSymbolic(F.get(), A, nullptr, &info));
    check_petsc(MatCholeskyFactorNumeric(F.get(), A, &info));
    PetscInt status = 0, detail = 0, negative = 0;
    check_petsc(MatMumpsGetInfog(F.get(), 1, &status));
    check_petsc(MatMumpsGetInfog(F.get(), 2, &detail));
    const auto state = judge_factorization(status, detail);
    if (state == FactorState::NeedsWorkspace) continue;
    if (state == FactorState::Singular) return false;
    check_petsc(MatGetInertia(F.get(), &negative, nullptr, nullptr));
    if (const LowRankPart* part = find_low_rank(whole))
      negative += count_extra_negative(make_sum_factor(std::move(F), *part).get());
    return negative > 0;
  }
  return false;
}

/// Whether A, which is not positive definite, has a negative eigenvalue beyond roundoff; those of motions without
/// stiffness are none.
bool has_negative(const PetscMat& A) {
  VectorXd shift = 1e-13 * get_diagonal(A.get()).cwiseAbs();
  shift = shift.cwiseMax(1e-6 * shift.maxCoeff());
  const PetscMat shifted = add_diagonal(A.get(), shift);
  if (initialize_petsc().size == 1) return !factor_definite(shifted.get());
  return has_negative_pivot(shifted.get());
}

/// Takes out what carries the rigid motions of a free model: where those need no force, the sign of the rest stays.
PetscMat hold_support(const Model& model, const PetscMat& A) {
  std::vector<int> held, kept;
  try {
    held = choose_determinate_support(model, 0);
  } catch (const InputError&) {
    return share(A);
  }
  for (int f = 0; f < model.num_fdofs(); ++f)
    if (std::find(held.begin(), held.end(), f) == held.end()) kept.push_back(f);
  return take_kept(A.get(), kept);
}

}  // namespace

void ModelBuilder::check_prestress() {
  if (!model_.prestress_ || model_.num_fdofs() == 0) return;
  auto checked = std::make_shared<CheckedStiffness>();
  checked->K = assemble_stiffness(model_, DofSet::Free);
  checked->factor = SymmetricFactor::try_definite(checked->K.get());
  model_.checked_stiffness_ = checked;
  if (checked->factor) return;
  const PetscMat held = options_.ignore_spc ? hold_support(model_, checked->K) : PetscMat();
  if (held && factor_definite(held.get())) return;
  if (!has_negative(held ? held : checked->K)) return;
  throw ComputationError("fe.preload-buckles", model_.prestress_->at,
                         "the structure buckles under its preload, " + model_.prestress_->name +
                             ": its stiffness with that of the stress is not positive definite",
                         "lower the load below its first load factor (bough modes --buckling), or look for rods and "
                         "membranes under compression");
}

}  // namespace bough::fe
