#include "bough/fe/assembly.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

#include "bough/fe/model/element_transform.hpp"

namespace bough::fe {
namespace {

static_assert(sizeof(PetscInt) == sizeof(int), "rows are handed to PETSc as int");

/// Adds one element's N x N matrix (basic) into zeroed storage.
using AddElementMatrix = std::function<void(const Element&, Eigen::Ref<MatrixXd>)>;

SparseRows make_identity(int size) {
  SparseRows identity(size, size);
  identity.setIdentity();
  return identity;
}

/// Rows [first, last) of the pattern of Σ T_eᵀ K_e T_e in CSR, columns ascending, diagonal always there.
struct Pattern {
  std::vector<int> start, columns;
};

Pattern calc_pattern(const Model& model, const SparseRows& T, int first, int last) {
  const auto& elements = model.elements();
  const int num_rows = last - first;
  // Each element's columns once; then, per own row, the elements that touch it.
  std::vector<int> element_start{0}, element_columns, columns;
  std::vector<int> count(num_rows + 1, 0);
  for (const auto& element : elements) {
    calc_element_columns(T, element->gdofs(), columns);
    for (int c : columns)
      if (c >= first && c < last) ++count[c - first + 1];
    element_columns.insert(element_columns.end(), columns.begin(), columns.end());
    element_start.push_back(static_cast<int>(element_columns.size()));
  }
  std::partial_sum(count.begin(), count.end(), count.begin());
  std::vector<int> touching(count.back()), next(count.begin(), count.end() - 1);
  for (int e = 0; e < static_cast<int>(elements.size()); ++e)
    for (int i = element_start[e]; i < element_start[e + 1]; ++i)
      if (const int c = element_columns[i]; c >= first && c < last) touching[next[c - first]++] = e;

  Pattern pattern;
  pattern.start.push_back(0);
  std::vector<int> mark(T.cols(), -1);
  for (int row = 0; row < num_rows; ++row) {
    const size_t begin = pattern.columns.size();
    mark[first + row] = row;
    pattern.columns.push_back(first + row);
    for (int t = count[row]; t < count[row + 1]; ++t)
      for (int i = element_start[touching[t]]; i < element_start[touching[t] + 1]; ++i)
        if (mark[element_columns[i]] != row) {
          mark[element_columns[i]] = row;
          pattern.columns.push_back(element_columns[i]);
        }
    std::sort(pattern.columns.begin() + static_cast<std::ptrdiff_t>(begin), pattern.columns.end());
    pattern.start.push_back(static_cast<int>(pattern.columns.size()));
  }
  return pattern;
}

PetscMat assemble(const Model& model, DofSet set, const AddElementMatrix& add) {
  initialize_petsc();
  const SparseRows identity = set == DofSet::Global ? make_identity(model.num_gdofs()) : SparseRows{};
  const SparseRows& T = set == DofSet::Global ? identity : model.T();
  const PetscInt size = static_cast<PetscInt>(T.cols());

  PetscMat matrix;
  check_petsc(MatCreate(PETSC_COMM_WORLD, matrix.out()));
  Mat A = matrix.get();
  check_petsc(MatSetSizes(A, PETSC_DECIDE, PETSC_DECIDE, size, size));
  check_petsc(MatSetType(A, MATAIJ));
  check_petsc(MatSetUp(A));
  PetscInt first = 0, last = 0;
  check_petsc(MatGetOwnershipRange(A, &first, &last));
  const Pattern pattern = calc_pattern(model, T, first, last);
  // Each does nothing for the other's type.
  check_petsc(MatSeqAIJSetPreallocationCSR(A, pattern.start.data(), pattern.columns.data(), nullptr));
  check_petsc(MatMPIAIJSetPreallocationCSR(A, pattern.start.data(), pattern.columns.data(), nullptr));
  check_petsc(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_TRUE));
  check_petsc(MatSetOption(A, MAT_ROW_ORIENTED, PETSC_FALSE));  // Eigen's order

  ElementTransform transform;
  MatrixXd K_e;
  const auto [begin, end] = calc_element_range(model);
  for (int e = begin; e < end; ++e) {
    const Element& element = *model.elements()[e];
    transform.set(T, element.gdofs());
    const auto& columns = transform.columns();
    if (columns.empty()) continue;
    K_e.setZero(element.num_dofs(), element.num_dofs());
    add(element, K_e);
    const MatrixXd& K_f = transform.project(K_e);
    const PetscInt num = static_cast<PetscInt>(columns.size());
    check_petsc(MatSetValues(A, num, columns.data(), num, columns.data(), K_f.data(), ADD_VALUES));
  }
  check_petsc(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  check_petsc(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  check_petsc(MatSetOption(A, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return matrix;
}

VectorXd gather_rows(const VectorXd& x, const std::vector<int>& rows) {
  VectorXd result(static_cast<int>(rows.size()));
  for (int i = 0; i < result.size(); ++i) result[i] = x[rows[i]];
  return result;
}

/// Σ_e of element matrices times X, over ranks.
MatrixXd calc_times(const Model& model, const AddElementMatrix& add, const Eigen::Ref<const MatrixXd>& X) {
  BOUGH_DEMAND(X.rows() == model.num_gdofs());
  MatrixXd Y = MatrixXd::Zero(X.rows(), X.cols());
  MatrixXd K_e, X_e, Y_e;
  const auto [begin, end] = calc_element_range(model);
  for (int e = begin; e < end; ++e) {
    const Element& element = *model.elements()[e];
    const auto& gdofs = element.gdofs();
    const int n = element.num_dofs();
    K_e.setZero(n, n);
    add(element, K_e);
    X_e.resize(n, X.cols());
    for (int i = 0; i < n; ++i) X_e.row(i) = X.row(gdofs[i]);
    Y_e.noalias() = K_e * X_e;
    for (int i = 0; i < n; ++i) Y.row(gdofs[i]) += Y_e.row(i);
  }
  sum_over_ranks(Y);
  return Y;
}

}  // namespace

PetscMat assemble_stiffness(const Model& model, DofSet set) {
  return assemble(model, set, [](const Element& e, Eigen::Ref<MatrixXd> K) { e.add_stiffness(1, K); });
}

PetscMat assemble_mass(const Model& model, DofSet set, MassKind kind) {
  const double scale = model.wtmass();
  return assemble(model, set, [kind, scale](const Element& e, Eigen::Ref<MatrixXd> M) { e.add_mass(kind, scale, M); });
}

PetscMat assemble_damping(const Model& model, DofSet set) {
  return assemble(model, set, [](const Element& e, Eigen::Ref<MatrixXd> B) { e.add_damping(1, B); });
}

PetscMat assemble_geometric_stiffness(const Model& model, DofSet set, const VectorXd& u_g) {
  BOUGH_DEMAND(u_g.size() == model.num_gdofs());
  return assemble(model, set, [&u_g](const Element& e, Eigen::Ref<MatrixXd> K_G) {
    if (e.num_internal_forces() == 0) return;
    VectorXd force = VectorXd::Zero(e.num_internal_forces());
    e.calc_internal_forces(gather_rows(u_g, e.gdofs()), force);
    e.add_geometric_stiffness(force, 1, K_G);
  });
}

MatrixXd calc_mass_times(const Model& model, MassKind kind, const Eigen::Ref<const MatrixXd>& X_g) {
  const double scale = model.wtmass();
  return calc_times(
      model, [kind, scale](const Element& e, Eigen::Ref<MatrixXd> M) { e.add_mass(kind, scale, M); }, X_g);
}

MatrixXd calc_stiffness_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g) {
  return calc_times(
      model, [](const Element& e, Eigen::Ref<MatrixXd> K) { e.add_stiffness(1, K); }, X_g);
}

MatrixXd calc_damping_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g) {
  return calc_times(
      model, [](const Element& e, Eigen::Ref<MatrixXd> B) { e.add_damping(1, B); }, X_g);
}

bool has_damping(const Model& model) {
  return std::any_of(model.elements().begin(), model.elements().end(), [](const auto& e) { return e->has_damping(); });
}

std::pair<int, int> calc_element_range(const Model& model) {
  const MpiWorld world = initialize_petsc();
  const long long num = static_cast<long long>(model.elements().size());
  return {static_cast<int>(num * world.rank / world.size), static_cast<int>(num * (world.rank + 1) / world.size)};
}

void sum_over_ranks(Eigen::Ref<MatrixXd> values) {
  if (initialize_petsc().size == 1) return;
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    MPI_Allreduce(MPI_IN_PLACE, values.col(j).data(), static_cast<int>(values.rows()), MPI_DOUBLE, MPI_SUM,
                  PETSC_COMM_WORLD);
}

VectorXd gather(Vec v) {
  PetscInt size = 0, first = 0, last = 0;
  check_petsc(VecGetSize(v, &size));
  check_petsc(VecGetOwnershipRange(v, &first, &last));
  VectorXd result = VectorXd::Zero(size);
  const PetscScalar* values = nullptr;
  check_petsc(VecGetArrayRead(v, &values));
  std::copy(values, values + (last - first), result.data() + first);
  check_petsc(VecRestoreArrayRead(v, &values));
  sum_over_ranks(result);
  return result;
}

void scatter(const Eigen::Ref<const VectorXd>& values, Vec v) {
  PetscInt size = 0, first = 0, last = 0;
  check_petsc(VecGetSize(v, &size));
  BOUGH_DEMAND(values.size() == size);
  check_petsc(VecGetOwnershipRange(v, &first, &last));
  PetscScalar* own = nullptr;
  check_petsc(VecGetArray(v, &own));
  std::copy(values.data() + first, values.data() + last, own);
  check_petsc(VecRestoreArray(v, &own));
}

}  // namespace bough::fe
