#include <algorithm>
#include <map>

#include "fe/elements/geometric_projection.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/linear/blas.hpp"
#include "fe/model/element_loop.hpp"
#include "stiffening/projected_rows.hpp"
#include "stiffening/reduce.hpp"

namespace bough::stiffening {

namespace {

/// Adds a form: one product of rows of L Φ per pair that has a weight. Phi: the rows of the form's dofs.
void add_form(const fe::QuadraticForm& form, const MatrixXd& Phi, fe::GeometricProjection& sums) {
  const MatrixXd X = (form.L * Phi).transpose();
  const auto r = static_cast<int>(form.L.rows());
  std::vector<std::pair<int, int>> pairs;
  for (int j = 0; j < r; ++j)
    for (int i = j; i < r; ++i)
      if (!form.weights.row(fe::find_weight(r, i, j)).isZero(0)) pairs.emplace_back(i, j);
  auto terms = sums.add_terms(static_cast<Eigen::Index>(pairs.size()));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const auto term = static_cast<Eigen::Index>(k);
    terms.weights.row(term) = form.weights.row(fe::find_weight(r, i, j));
    if (i == j)
      fe::add_square(X.col(i), 1, terms.products.col(term));
    else
      fe::add_cross(X.col(i), X.col(j), 1, terms.products.col(term));
  }
}

/// K_G of elements and forms, added up by rows.
class RowSums {
 public:
  RowSums(const fe::Model& model, const MatrixXd& U, const MatrixXd& Phi) : model_(model), U_(U), Phi_(Phi) {}

  /// A form that couples more dofs is a matrix of many numbers for few products.
  static bool takes(const fe::QuadraticForm& form) { return form.gdofs.size() <= 60; }
  void add(const fe::Element& element) { parts_.push_back({&element, nullptr}); }
  void add(const fe::QuadraticForm& form) { parts_.push_back({nullptr, &form}); }

  std::vector<MatrixXd> calc() {
    std::vector<int> group_of(static_cast<std::size_t>(model_.num_gdofs()));
    for (std::size_t k = 0; k < model_.nodes().size(); ++k)
      for (int d = 0; d < model_.nodes()[k].num_dofs; ++d)
        group_of[static_cast<std::size_t>(model_.nodes()[k].first_gdof + d)] = static_cast<int>(k);
    sort_parts(group_of);
    std::vector<const std::vector<int>*> dofs;
    for (const auto& part : parts_) dofs.push_back(&get_dofs(part));
    ProjectedRows rows(Phi_, U_.cols(), dofs, std::move(group_of));
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      find_entries(parts_[i], *dofs[i]);
      rows.add(i, entries_, values_);
    }
    return rows.finish();
  }

 private:
  struct Part {
    const fe::Element* element;
    const fe::QuadraticForm* form;
  };
  static const std::vector<int>& get_dofs(const Part& part) {
    return part.element ? part.element->gdofs() : part.form->gdofs;
  }

  /// Sorts each form after the last element at its grids, so that rows are soon complete.
  void sort_parts(const std::vector<int>& group_of) {
    std::vector<std::size_t> last(model_.nodes().size(), 0);
    const auto find_last = [&](const Part& part) -> std::size_t {
      std::size_t latest = 0;
      for (const int dof : get_dofs(part))
        latest = std::max(latest, last[static_cast<std::size_t>(group_of[static_cast<std::size_t>(dof)])]);
      return latest;
    };
    std::vector<std::pair<std::size_t, Part>> sorted;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!parts_[i].element) continue;
      for (const int dof : get_dofs(parts_[i]))
        last[static_cast<std::size_t>(group_of[static_cast<std::size_t>(dof)])] = i;
      sorted.emplace_back(i, parts_[i]);
    }
    for (const auto& part : parts_)
      if (part.form) sorted.emplace_back(find_last(part), part);
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    parts_.clear();
    for (const auto& entry : sorted) parts_.push_back(entry.second);
  }

  /// K_G of every load as its projection on unit vectors: as many products as it has independent numbers.
  void find_entries(const Part& part, const std::vector<int>& gdofs) {
    const auto N = static_cast<Eigen::Index>(gdofs.size());
    const MatrixXd unit = MatrixXd::Identity(N, N);
    auto& projection = by_size_.try_emplace(N, N, U_.cols()).first->second;
    if (part.element)
      part.element->stress_state()->add_projected_geometric_stiffness(U_(gdofs, Eigen::all), unit, projection);
    else
      add_form(*part.form, unit, projection);
    const auto terms = projection.last_terms();
    const VectorXd size = terms.products.cwiseAbs().rowwise().sum();
    entries_.clear();
    for (int k = 0; k < size.size(); ++k)
      if (size[k] != 0) entries_.push_back(k);
    const MatrixXd products = terms.products(entries_, Eigen::all);
    values_.resize(products.rows(), U_.cols());
    linear::multiply_dense(false, products, terms.weights, 0, values_);
    projection.drop_terms();
  }

  const fe::Model& model_;
  const MatrixXd &U_, &Phi_;
  std::vector<Part> parts_;
  std::map<Eigen::Index, fe::GeometricProjection> by_size_;
  std::vector<int> entries_;
  MatrixXd values_;
};

/// Modes from which rows of K_G take less time than products of modes: for an element of four nodes 40 n² m flops by
/// products, 12 n² m by rows plus the assembly of the rows.
constexpr Eigen::Index kMinModesForRows = 40;
/// Elements from which a second thread saves more than its start takes.
constexpr int kMinElementsOfThread = 250;

}  // namespace

std::vector<MatrixXd> calc_generalized_geometric_stiffness(const fe::Model& model, const fe::AppliedLoads& loads,
                                                           const MatrixXd& U, const MatrixXd& Phi) {
  BOUGH_DEMAND(U.rows() == model.num_gdofs() && Phi.rows() == model.num_gdofs());
  const bool by_rows = Phi.cols() >= kMinModesForRows;
  // Forms have their own split over ranks.
  const auto forms = U.cols() > 0 ? fe::calc_second_order(model, loads, U) : std::vector<fe::QuadraticForm>{};
  const linear::MpiWorld world = linear::initialize_petsc();
  const auto range = fe::get_own_elements(model);
  std::vector<MatrixXd> result, second;
  linear::do_halves(range.last - range.first, kMinElementsOfThread, [&](int from, int to) {
    fe::GeometricProjection sums(Phi.cols(), U.cols());
    RowSums rows(model, U, Phi);
    const auto add = [&](int, const fe::Element& element) {
      const fe::StressState* state = element.stress_state();
      if (!state) return;
      if (by_rows)
        rows.add(element);
      else
        state->add_projected_geometric_stiffness(U(element.gdofs(), Eigen::all), Phi(element.gdofs(), Eigen::all),
                                                 sums);
    };
    if (U.cols() > 0) fe::visit_elements(model, {range.first + from, range.first + to}, add);
    const bool with_forms = range.first + to == range.last;
    for (std::size_t i = static_cast<std::size_t>(world.rank); with_forms && i < forms.size();
         i += static_cast<std::size_t>(world.size)) {
      if (by_rows && RowSums::takes(forms[i]))
        rows.add(forms[i]);
      else
        add_form(forms[i], Phi(forms[i].gdofs, Eigen::all), sums);
    }
    auto& own = from == 0 ? result : second;
    own = sums.finish();
    if (by_rows && U.cols() > 0) {
      const auto of_rows = rows.calc();
      for (std::size_t c = 0; c < own.size(); ++c) own[c] += of_rows[c];
    }
  });
  for (std::size_t c = 0; c < second.size(); ++c) result[c] += second[c];
  for (auto& K_G : result) linear::sum_over_ranks(K_G);
  return result;
}

}  // namespace bough::stiffening
