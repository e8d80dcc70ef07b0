#include "modal/factored_transform.hpp"

#include <slepc/private/stimpl.h>

#include "base/diagnostic.hpp"

namespace bough::modal::detail {
namespace {

using linear::check_petsc;

struct Transform {
  const FactoredOperator* op = nullptr;
  linear::PetscVec product;
  std::exception_ptr failure;
};

Transform& get(ST st) { return *static_cast<Transform*>(st->data); }

PetscErrorCode apply(ST st, Vec x, Vec y) {
  Transform& own = get(st);
  return run_guarded(own.failure, [&] {
    BOUGH_DEMAND(own.op && own.op->factor);
    const FactoredOperator& op = *own.op;
    Mat right = st->A[op.is_near_shift() ? 1 : 0];
    if (!own.product) check_petsc(MatCreateVecs(right, nullptr, own.product.out()));
    check_petsc(MatMult(right, x, own.product.get()));
    op.factor->solve_vector(own.product.get(), y);
    if (!op.deflation || op.deflation->cols() == 0) return;
    const Eigen::MatrixXd value = linear::gather(y);
    linear::scatter((value - *op.deflation * (op.deflation->transpose() * op.multiply_mass(value))).col(0), y);
  });
}

/// λ = 1/θ + σ near a shift, else θ.
PetscErrorCode transform_back(ST st, PetscInt n, PetscScalar* real, PetscScalar* imaginary) {
  if (!get(st).op || !get(st).op->is_near_shift()) return 0;
  for (PetscInt j = 0; j < n; ++j) {
    if (imaginary[j] == 0) {
      real[j] = 1 / real[j] + st->sigma;
    } else {
      const double square = real[j] * real[j] + imaginary[j] * imaginary[j];
      real[j] = real[j] / square + st->sigma;
      imaginary[j] = -imaginary[j] / square;
    }
  }
  return 0;
}

PetscErrorCode get_inner_product(ST st, Mat* B) {
  *B = st->A[1];
  return PetscObjectReference(reinterpret_cast<PetscObject>(*B));
}

PetscErrorCode view(ST st, PetscViewer viewer) {
  const auto* op = get(st).op;
  return PetscViewerASCIIPrintf(viewer, "  %s\n", op ? op->factor_name.c_str() : "no factor");
}

PetscErrorCode destroy(ST st) {
  delete &get(st);
  st->data = nullptr;
  return 0;
}

PetscErrorCode create(ST st) {
  st->data = new Transform;
  st->usesksp = PETSC_FALSE;
  st->ops->apply = apply;
  st->ops->backtransform = transform_back;
  st->ops->getbilinearform = get_inner_product;
  st->ops->view = view;
  st->ops->destroy = destroy;
  return 0;
}

bool is_factored(ST st) {
  PetscBool is = PETSC_FALSE;
  check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(st), kFactorTransform, &is));
  return is;
}

}  // namespace

void register_factored_transform() { check_petsc(STRegister(kFactorTransform, create)); }

void set_operator(ST st, const FactoredOperator& op) {
  check_petsc(STSetType(st, kFactorTransform));
  get(st).op = &op;
}

const FactoredOperator* find_operator(ST st) { return is_factored(st) ? get(st).op : nullptr; }

std::exception_ptr get_failure(ST st) { return is_factored(st) ? get(st).failure : nullptr; }

}  // namespace bough::modal::detail
