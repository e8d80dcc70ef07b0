#include "fe/matrices/assembly.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

#include "fe/elements/damping.hpp"
#include "fe/linear/blas.hpp"
#include "fe/linear/csr_matrix.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/threads.hpp"
#include "fe/matrices/factor_need.hpp"
#include "fe/model/element_loop.hpp"
#include "fe/model/element_transform.hpp"

namespace bough::fe {
namespace {

SparseRows make_identity(int size) {
  SparseRows identity(size, size);
  identity.setIdentity();
  return identity;
}

/// Rows [first, last) of Σ T_eᵀ K_e T_e in CSR: columns ascending, the diagonal always there. `same[i]`: row i has the
/// elements, and so the columns, of the row before.
struct Rows {
  std::vector<int> start{0}, columns;
  std::vector<char> same;
  std::vector<double> values;
  std::vector<int> elements;  ///< those that touch the rows, ascending
};

/// Terms of the sum, elements and others: their g-dofs, and the columns of T that these rows have, each once and
/// ascending.
class Parts {
 public:
  Parts(const SparseRows& T, std::vector<const std::vector<int>*> parts) : gdofs_(std::move(parts)) {
    std::vector<int> seconds;
    linear::do_halves(size(), kMinSize, [&](int from, int to) {
      std::vector<int> columns, all;
      for (int e = from; e < to; ++e) {
        calc_element_columns(T, this->gdofs(e), columns);
        sizes_[static_cast<size_t>(e)] = static_cast<int>(columns.size());
        all.insert(all.end(), columns.begin(), columns.end());
      }
      (from == 0 ? columns_ : seconds) = std::move(all);
    });
    columns_.insert(columns_.end(), seconds.begin(), seconds.end());
    std::partial_sum(sizes_.begin(), sizes_.end(), start_.begin() + 1);
  }
  int size() const { return static_cast<int>(gdofs_.size()); }
  const std::vector<int>& gdofs(int e) const { return *gdofs_[static_cast<size_t>(e)]; }
  std::span<const int> columns(int e) const {
    const auto i = static_cast<size_t>(e);
    return {columns_.data() + start_[i], columns_.data() + start_[i + 1]};
  }

 private:
  static constexpr int kMinSize = 2000;  ///< fewer are done before a thread has started
  std::vector<const std::vector<int>*> gdofs_;
  std::vector<int> sizes_ = std::vector<int>(gdofs_.size());
  std::vector<std::ptrdiff_t> start_ = std::vector<std::ptrdiff_t>(gdofs_.size() + 1);
  std::vector<int> columns_;
};

Rows calc_pattern(const Parts& parts, int num_columns, int first, int last) {
  const int num_rows = last - first;
  Rows rows;
  // Per own row, the elements that touch it.
  std::vector<int> count(num_rows + 1, 0);
  for (int e = 0; e < parts.size(); ++e) {
    bool touches = false;
    for (int c : parts.columns(e))
      if (c >= first && c < last) ++count[c - first + 1], touches = true;
    if (touches) rows.elements.push_back(e);
  }
  std::partial_sum(count.begin(), count.end(), count.begin());
  std::vector<int> touching(count.back()), next(count.begin(), count.end() - 1);
  for (const int e : rows.elements)
    for (const int c : parts.columns(e))
      if (c >= first && c < last) touching[next[c - first]++] = e;

  rows.start.reserve(num_rows + 1);
  rows.same.assign(num_rows, 0);
  std::vector<int> mark(static_cast<size_t>(num_columns), -1);
  for (int row = 0; row < num_rows; ++row) {
    const auto begin = static_cast<std::ptrdiff_t>(rows.columns.size());
    const auto own = touching.begin() + count[row], own_end = touching.begin() + count[row + 1];
    if (row > 0 && own != own_end && std::equal(touching.begin() + count[row - 1], own, own, own_end)) {
      rows.same[row] = 1;
      for (int i = rows.start[row - 1]; i < begin; ++i) rows.columns.push_back(rows.columns[i]);
    } else {
      mark[first + row] = row;
      rows.columns.push_back(first + row);
      for (auto t = own; t != own_end; ++t)
        for (const int column : parts.columns(*t))
          if (mark[column] != row) {
            mark[column] = row;
            rows.columns.push_back(column);
          }
      std::sort(rows.columns.begin() + begin, rows.columns.end());
    }
    BOUGH_DEMAND(rows.columns.size() < 2147483647u);
    rows.start.push_back(static_cast<int>(rows.columns.size()));
  }
  return rows;
}

/// Adds the rows of K_f, on the f-dofs `columns`, that lie in [first, last).
void add_rows(const MatrixXd& K_f, const std::vector<int>& columns, int first, int last, Rows& rows) {
  std::vector<int> at(columns.size());
  int known = -2;
  for (size_t i = 0; i < columns.size(); ++i) {
    const int row = columns[i] - first;
    if (row < 0 || columns[i] >= last) continue;
    const int* begin = rows.columns.data() + rows.start[row];
    if (row != known + 1 || !rows.same[row]) {
      const int* p = begin;
      for (size_t j = 0; j < columns.size(); ++j) {
        while (*p != columns[j]) ++p;
        at[j] = static_cast<int>(p - begin);
      }
    }
    known = row;
    double* values = rows.values.data() + rows.start[row];
    for (size_t j = 0; j < columns.size(); ++j) values[at[j]] += K_f(static_cast<int>(j), static_cast<int>(i));
  }
}

/// Leaves out the zeros, the diagonal apart: a flat shell in a coordinate plane couples half of its dofs only, a mass
/// fewer, and the factor's work goes with what is stored.
void drop_zeros(Rows& rows, int first) {
  int kept = 0;
  for (int row = 0; row + 1 < static_cast<int>(rows.start.size()); ++row) {
    const int begin = rows.start[row], end = rows.start[row + 1];
    rows.start[row] = kept;
    for (int i = begin; i < end; ++i)
      if (rows.values[i] != 0 || rows.columns[i] == first + row) {
        rows.values[kept] = rows.values[i];
        rows.columns[kept++] = rows.columns[i];
      }
  }
  rows.start.back() = kept;
}

void copy_rows(const Rows& rows, int row, int entry, linear::Csr& csr) {
  for (size_t i = 1; i < rows.start.size(); ++i) csr.start[row + static_cast<int>(i)] = entry + rows.start[i];
  std::copy(rows.columns.begin(), rows.columns.end(), csr.columns.get() + entry);
  std::copy(rows.values.begin(), rows.values.end(), csr.values.get() + entry);
}

/// `first` and the rows after it, from row number `begin` on.
linear::Csr join(Rows first, Rows second, int begin) {
  const int num_first = static_cast<int>(first.start.size()) - 1, entries = first.start.back();
  const size_t num_rows = first.start.size() + second.start.size() - 2;
  linear::Csr csr = linear::make_csr(num_rows, first.columns.size() + second.columns.size());
  csr.start[0] = 0;
  const auto copy_first = [&] { copy_rows(std::exchange(first, {}), 0, 0, csr); };
  const auto copy_second = [&] { copy_rows(std::exchange(second, {}), num_first, entries, csr); };
  for (const Rows* rows : {&first, &second})
    for (size_t i = 0; i < rows->same.size(); ++i)
      if (!rows->same[i]) csr.groups.push_back(begin + (rows == &second ? num_first : 0) + static_cast<int>(i));
  csr.groups.push_back(begin + static_cast<int>(num_rows));
  if (second.columns.empty()) {
    copy_first();
    copy_second();
  } else {
    linear::do_both(copy_first, copy_second);
  }
  return csr;
}

const std::vector<QuadraticForm>& get_forms(const Model& model) {
  static const std::vector<QuadraticForm> none;
  return model.prestress() ? model.prestress()->forms : none;
}

/// Fewer are done before a thread has started.
constexpr int kMinElementsOfThread = 1000;

/// Σ of element matrices times X. `energy`: ½ x_eᵀ A_e x_e, by element.
struct ProductSum {
  const AddElementMatrix& add_matrix;
  const Eigen::Ref<const MatrixXd>& X;
  MatrixXd* energy;
  MatrixXd Y = MatrixXd::Zero(X.rows(), X.cols());
  MatrixXd K_e = {}, X_e = {}, Y_e = {};

  void add(int e, const Element& element) {
    const auto& gdofs = element.gdofs();
    const int n = element.num_dofs();
    K_e.setZero(n, n);
    add_matrix(element, K_e);
    X_e.resize(n, X.cols());
    for (int d = 0; d < n; ++d) X_e.row(d) = X.row(gdofs[d]);
    Y_e.resize(n, X.cols());
    linear::multiply_dense(false, K_e, X_e, 0, Y_e);
    if (energy) energy->row(e) = 0.5 * X_e.cwiseProduct(Y_e).colwise().sum();
    for (int d = 0; d < n; ++d) Y.row(gdofs[d]) += Y_e.row(d);
  }
  void merge(const ProductSum& second) { Y += second.Y; }
};

/// Σ of this rank's element matrices times X.
MatrixXd sum_own_elements(const Model& model, const AddElementMatrix& add, const Eigen::Ref<const MatrixXd>& X,
                          MatrixXd* energy) {
  if (energy) energy->setZero(static_cast<Eigen::Index>(model.elements().size()), X.cols());
  return sum_over_elements(model, get_own_elements(model), kMinElementsOfThread,
                           [&] {
                             return ProductSum{add, X, energy};
                           })
      .Y;
}

/// Σ_e of element matrices and of forms times X, over ranks.
MatrixXd calc_times(const Model& model, const AddElementMatrix& add, const Eigen::Ref<const MatrixXd>& X,
                    const std::vector<QuadraticForm>& forms = {}, MatrixXd* energy = nullptr) {
  BOUGH_DEMAND(X.rows() == model.num_gdofs());
  if (X.cols() == 0) return MatrixXd::Zero(X.rows(), 0);
  MatrixXd Y = sum_own_elements(model, add, X, energy);
  const linear::MpiWorld world = linear::initialize_petsc();
  for (size_t k = static_cast<size_t>(world.rank); k < forms.size(); k += static_cast<size_t>(world.size))
    Y(forms[k].gdofs, Eigen::all) += calc_form(forms[k], 0) * X(forms[k].gdofs, Eigen::all);
  linear::sum_over_ranks(Y);
  return Y;
}

/// Rows [first, last) with all that is added to them.
Rows sum_some_rows(const Elements& elements, const SparseRows& T, const AddElementMatrix& add,
                   const std::vector<QuadraticForm>& forms, const Parts& parts, int first, int last) {
  const int num_elements = static_cast<int>(elements.size());
  Rows rows = calc_pattern(parts, static_cast<int>(T.cols()), first, last);
  rows.values.assign(rows.columns.size(), 0);
  ElementTransform transform;
  MatrixXd K_e;
  for (int e : rows.elements) {
    transform.set(T, parts.gdofs(e), parts.columns(e));
    if (e < num_elements) {
      const auto size = static_cast<Eigen::Index>(parts.gdofs(e).size());
      K_e.setZero(size, size);
      add(*elements[static_cast<size_t>(e)], K_e);
    } else {
      K_e = calc_form(forms[e - num_elements], 0);
    }
    add_rows(transform.project(K_e), transform.columns(), first, last, rows);
  }
  drop_zeros(rows, first);
  rows.columns.resize(static_cast<size_t>(rows.start.back()));
  rows.values.resize(rows.columns.size());
  return rows;
}

/// Fewer rows are done before a thread has started.
constexpr int kRowsOfThread = 5000;

/// A row near the middle of [first, last) that few elements have on both sides and that begins a run of rows with the
/// same elements; -1: none.
int find_cut(const Parts& parts, int first, int last) {
  constexpr int kWindow = 32;
  const int middle = first + (last - first) / 2;
  int above = 0, below = 0, both = 0;
  std::vector<std::vector<int>> touching(kWindow);  // rows from the one before the middle on
  for (int e = 0; e < parts.size(); ++e) {
    bool is_above = false, is_below = false;
    for (const int c : parts.columns(e)) {
      if (c < first || c >= last) continue;
      (c < middle ? is_above : is_below) = true;
      if (c >= middle - 1 && c < middle - 1 + kWindow) touching[static_cast<size_t>(c - middle + 1)].push_back(e);
    }
    above += is_above ? 1 : 0;
    below += is_below ? 1 : 0;
    both += is_above && is_below ? 1 : 0;
  }
  if (4 * both > std::min(above, below)) return -1;
  for (size_t i = 1; i < touching.size(); ++i)
    if (touching[i] != touching[i - 1]) return middle - 1 + static_cast<int>(i);
  return -1;
}

/// Two threads assemble one half each, like two ranks, if few elements belong to both halves.
linear::Csr sum_rows(const Elements& elements, const SparseRows& T, const AddElementMatrix& add,
                     const std::vector<QuadraticForm>& forms, const Parts& parts, int first, int last) {
  const int cut = linear::get_num_threads() > 1 && last - first > 2 * kRowsOfThread ? find_cut(parts, first, last) : -1;
  if (cut < 0) return join(sum_some_rows(elements, T, add, forms, parts, first, last), {}, first);
  Rows rows, second;
  linear::do_both([&] { rows = sum_some_rows(elements, T, add, forms, parts, first, cut); },
                  [&] { second = sum_some_rows(elements, T, add, forms, parts, cut, last); });
  return join(std::move(rows), std::move(second), first);
}

/// Rows [first, last) of TᵀAT; last < 0: all.
linear::Csr sum_rows(const Elements& elements, const SparseRows& T, const AddElementMatrix& add,
                     const std::vector<QuadraticForm>& forms, int first = 0, int last = -1,
                     const TakesElement& takes = {}) {
  static const std::vector<int> none;
  std::vector<const std::vector<int>*> gdofs;
  for (const auto& element : elements) gdofs.push_back(takes && !takes(*element) ? &none : &element->gdofs());
  for (const auto& form : forms) gdofs.push_back(&form.gdofs);
  return sum_rows(elements, T, add, forms, Parts(T, std::move(gdofs)), first,
                  last < 0 ? static_cast<int>(T.cols()) : last);
}

/// TᵀAT, sparse. Every rank adds, in the order of the deck, all elements that touch its rows: nothing is sent, and an
/// entry does not depend on the number of ranks.
linear::SymmetricMatrix assemble_sparse(const Elements& elements, const SparseRows& T, const AddElementMatrix& add,
                                        const std::vector<QuadraticForm>& forms, const TakesElement& takes = {}) {
  const PetscInt size = static_cast<PetscInt>(T.cols());
  if (linear::initialize_petsc().size == 1)
    return linear::SymmetricMatrix(sum_rows(elements, T, add, forms, 0, -1, takes), 0, size);
  const auto [first, last] = linear::split_rows(size);
  return linear::SymmetricMatrix(sum_rows(elements, T, add, forms, first, last, takes), first, size);
}

}  // namespace

linear::SymmetricMatrix assemble(const Model& model, DofSet set, MatrixKind kind, const AddElementMatrix& add,
                                 std::vector<QuadraticForm> forms) {
  linear::initialize_petsc();
  if (set == DofSet::Global) return assemble_sparse(model.elements(), make_identity(model.num_gdofs()), add, forms);
  const linear::LowRankPart of_forms = take_wide_forms(model, forms);
  const auto split = split_transform(model, kind == MatrixKind::Stiffness);
  if (!split) return assemble_sparse(model.elements(), model.T(), add, forms).with_low_rank(of_forms);
  return assemble_sparse(model.elements(), split->T, add, forms)
      .with_low_rank(join(calc_wide_part(model, *split, add, forms), 1, of_forms, 1));
}

linear::SymmetricMatrix assemble_some(const Model& model, const AddElementMatrix& add, const TakesElement& takes) {
  return assemble_sparse(model.elements(), make_identity(model.num_gdofs()), add, {}, takes);
}

SparseRows sum_elements(const Elements& elements, int num_gdofs, const AddElementMatrix& add) {
  const linear::Csr rows = sum_rows(elements, make_identity(num_gdofs), add, {});
  return Eigen::Map<const SparseRows>(num_gdofs, num_gdofs, rows.start[num_gdofs], rows.start.get(), rows.columns.get(),
                                      rows.values.get());
}

namespace {

void add_damping_of(const Element& element, Eigen::Ref<MatrixXd> B) {
  if (const Damping* damping = element.damping()) damping->add_damping(1, B);
}

AddElementMatrix add_stiffness_of(const Model& model) {
  return [&model](const Element& e, Eigen::Ref<MatrixXd> K) { model.add_stiffness(e, K); };
}

}  // namespace

linear::SymmetricMatrix assemble_stiffness(const Model& model, DofSet set) {
  if (set == DofSet::Free) require_memory_for_factor(model);
  return assemble(model, set, MatrixKind::Stiffness, add_stiffness_of(model), get_forms(model));
}

bool drop_stiffness(const linear::SymmetricMatrix& K) { return K.drop_entries(); }

void restore_stiffness(const Model& model, const linear::SymmetricMatrix& K) {
  K.fill_entries(sum_rows(model.elements(), model.T(), add_stiffness_of(model), get_forms(model)));
}

linear::SymmetricMatrix assemble_mass(const Model& model, DofSet set, MassKind kind) {
  const double scale = model.wtmass();
  return assemble(model, set, MatrixKind::Other,
                  [kind, scale](const Element& e, Eigen::Ref<MatrixXd> M) { e.add_mass(kind, scale, M); });
}

linear::SymmetricMatrix assemble_damping(const Model& model, DofSet set) {
  return assemble(model, set, MatrixKind::Other, add_damping_of);
}

MatrixXd calc_mass_times(const Model& model, MassKind kind, const Eigen::Ref<const MatrixXd>& X_g) {
  const double scale = model.wtmass();
  return calc_times(
      model, [kind, scale](const Element& e, Eigen::Ref<MatrixXd> M) { e.add_mass(kind, scale, M); }, X_g);
}

MatrixXd calc_stiffness_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g, MatrixXd* energy) {
  return calc_times(
      model, [&model](const Element& e, Eigen::Ref<MatrixXd> K) { model.add_stiffness(e, K); }, X_g, get_forms(model),
      energy);
}

MatrixXd calc_prestress_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g) {
  const auto add = [&model](const Element& e, Eigen::Ref<MatrixXd> K) {
    MatrixXd elastic = MatrixXd::Zero(K.rows(), K.cols());
    e.add_stiffness(-1, elastic);
    model.add_stiffness(e, K);
    K += elastic;
  };
  return calc_times(model, add, X_g, get_forms(model));
}

MatrixXd calc_damping_times(const Model& model, const Eigen::Ref<const MatrixXd>& X_g) {
  return calc_times(model, add_damping_of, X_g);
}

MatrixXd calc_structural_damping_times(const Model& model, double g, const Eigen::Ref<const MatrixXd>& X_g) {
  return calc_times(
      model, [g](const Element& e, Eigen::Ref<MatrixXd> K) { e.add_structural_damping(g, K); }, X_g);
}

bool has_damping(const Model& model) { return model.has_damping(); }

}  // namespace bough::fe
