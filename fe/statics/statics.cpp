#include "fe/statics/statics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fe/linear/null_space.hpp"
#include "fe/linear/residual.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "fe/model/row_kinds.hpp"

namespace bough::fe {
namespace {

/// "grid 5 component 4" of the largest entries, a rotation counted with the model's size as its arm.
std::string describe_motion(const Model& model, const std::vector<int>& kept, const VectorXd& x, double size) {
  std::vector<std::pair<double, int>> entries;
  for (int i = 0; i < x.size(); ++i) {
    const int component = model.describe_fdof(kept[i]).second;
    entries.emplace_back(std::abs(x[i]) * (component > 3 ? size : 1), i);
  }
  const size_t shown = std::min<size_t>(6, entries.size());
  std::partial_sort(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(shown), entries.end(),
                    [](const auto& a, const auto& b) {
                      return std::abs(a.first - b.first) > 1e-6 * a.first ? a.first > b.first : a.second < b.second;
                    });
  std::string text;
  for (size_t i = 0; i < shown && entries[i].first > 0.05 * entries[0].first; ++i) {
    const auto [node, component] = model.describe_fdof(kept[entries[i].second]);
    text += (i ? ", " : "") + std::string("grid ") + std::to_string(node) + " component " + std::to_string(component);
  }
  return text;
}

double calc_model_size(const Model& model) {
  Vector3d low = model.nodes()[0].x, high = low;
  for (const Node& node : model.nodes()) {
    low = low.cwiseMin(node.x);
    high = high.cwiseMax(node.x);
  }
  return (high - low).norm() > 0 ? (high - low).norm() : 1;
}

[[noreturn]] void throw_mechanisms(const Model& model, const std::vector<int>& kept, const MatrixXd& motions) {
  std::vector<Diagnostic> items;
  const double size = calc_model_size(model);
  for (Eigen::Index c = 0; c < motions.cols(); ++c) {
    Diagnostic item;
    item.id = "fe.mechanism";
    item.what = "the stiffness matrix is singular: mechanism " + std::to_string(c + 1) + " of " +
                std::to_string(motions.cols()) + (motions.cols() < linear::kMaxMechanisms ? "" : " or more") +
                " moves most at " + describe_motion(model, kept, motions.col(c), size);
    item.advice = "hold or stiffen these dofs (components in the displacement axes of the grids)";
    const auto& subcase = model.subcase();
    const auto num_held = model.num_fdofs() - static_cast<int>(kept.size());
    if (c == 0 && num_held > 0)
      item.advice = "the " + std::to_string(num_held) +
                    " dof(s) that SUPORT or the support of a free body holds leave " +
                    "these motions: name dofs there that hold them too";
    else if (c == 0 && subcase.spc == 0 && model.fixed_dofs().size() <= model.autospc().size())
      item.advice = (subcase.id > 0 ? "subcase " + std::to_string(subcase.id) : std::string("the case control")) +
                    " selects no SPC set and nothing is held: write SPC = n, or hold these dofs";
    items.push_back(std::move(item));
  }
  throw ComputationError(std::move(items));
}

}  // namespace

struct StaticSolver::Impl {
  SparseRows T;             ///< a copy: the model may move, or be reduced
  OmittedSolution omitted;  ///< of the model
  std::vector<int> kept;    ///< f-dofs that are not held, ascending
  std::optional<linear::SymmetricFactor> factor;
  linear::RowKinds kinds;     ///< of `kept`
  linear::SymmetricMatrix K;  ///< what was factored, for residuals
};

StaticSolver::StaticSolver(const Model& model, const linear::SymmetricMatrix& K_f, std::vector<int> held_fdofs)
    : impl_(std::make_unique<Impl>()) {
  impl_->T = model.T();
  impl_->omitted = model.omitted();
  std::sort(held_fdofs.begin(), held_fdofs.end());
  BOUGH_DEMAND(held_fdofs.empty() || (held_fdofs.front() >= 0 && held_fdofs.back() < model.num_fdofs()));
  auto& kept = impl_->kept;
  for (int f = 0; f < model.num_fdofs(); ++f)
    if (!std::binary_search(held_fdofs.begin(), held_fdofs.end(), f)) kept.push_back(f);
  if (kept.empty())
    throw ComputationError("fe.no-free-dofs", {}, "the model has no free dof left after its constraints",
                           "remove constraints or add stiffness");
  impl_->kinds = list_row_kinds(model, kept);
  const linear::SymmetricMatrix K = impl_->K = held_fdofs.empty() ? K_f : linear::take_kept(K_f, kept);

  // Null pivots are a suspicion; the energy of the motion decides. A singular matrix may also factor without one, and
  // by LLᵀ, which is quicker, always without: then it is pivoted to see how many motions there are.
  impl_->factor.emplace(K, true);
  const auto is_accurate = [&] {
    return !impl_->factor->is_singular() &&
           linear::calc_softest_energy(K, impl_->kinds, *impl_->factor) >= linear::kMechanismEnergy;
  };
  if (impl_->factor->is_definite()) {
    if (is_accurate()) return;
    impl_->factor.emplace(K, true, linear::FactorMethod::Pivoting);
  }
  const int suspects = impl_->factor->is_singular() ? 1 : impl_->factor->num_null_pivots();
  if (suspects == 0 && is_accurate()) return;
  const MatrixXd motions = linear::find_mechanisms(K, impl_->kinds, suspects);
  if (motions.cols() > 0) throw_mechanisms(model, kept, motions);
  impl_->factor.emplace(K, false, linear::FactorMethod::Pivoting);
  if (!is_accurate())
    throw ComputationError("fe.mechanism", {}, "the stiffness matrix is singular to working precision",
                           "look for very soft and very stiff parts side by side, or for values that are not numbers");
}

StaticSolver::StaticSolver(const Model& model) : impl_(std::make_unique<Impl>()) {
  BOUGH_DEMAND(model.num_fdofs() == 0);
  impl_->T = model.T();
}

StaticSolver::~StaticSolver() = default;

const linear::SymmetricFactor* StaticSolver::find_definite_factor() const {
  const bool is_whole = impl_->kept.size() == static_cast<size_t>(impl_->T.cols());
  return is_whole && impl_->factor && impl_->factor->is_definite() ? &*impl_->factor : nullptr;
}

void StaticSolver::demand_no_mechanism(const Model& model) const {
  if (impl_->kept.empty()) return;
  const MatrixXd motions = linear::find_mechanisms(impl_->K, impl_->kinds, 1, linear::kSoftMotionEnergy);
  if (motions.cols() > 0) throw_mechanisms(model, impl_->kept, motions);
}

MatrixXd StaticSolver::solve(const Eigen::Ref<const MatrixXd>& F_g, Diagnostics* diagnostics) const {
  const SparseRows& T = impl_->T;
  BOUGH_DEMAND(F_g.rows() == T.rows());
  if (impl_->kept.empty()) return MatrixXd::Zero(F_g.rows(), F_g.cols());
  const MatrixXd F_f = T.transpose() * F_g;
  MatrixXd u_f = MatrixXd::Zero(T.cols(), F_g.cols());
  const MatrixXd F_kept = F_f(impl_->kept, Eigen::all);
  MatrixXd u_kept = impl_->factor->solve(F_kept);
  // One refinement with a residual of more digits: a slender line of 1000 elements gains three (Higham, Accuracy and
  // Stability of Numerical Algorithms, 2nd ed., ch. 12).
  u_kept += impl_->factor->solve(calc_residual(impl_->K, u_kept, F_kept));
  Diagnostics ignored;
  linear::check_residuals(linear::calc_static_residuals(linear::get_diagonal(impl_->K), u_kept,
                                                        multiply(impl_->K, u_kept), F_kept, impl_->kinds),
                          "load case", diagnostics ? *diagnostics : ignored);
  u_f(impl_->kept, Eigen::all) = u_kept;
  MatrixXd u_g = T * u_f;
  if (impl_->omitted) u_g += impl_->omitted(F_g);  // K_oo^-1 P_o
  return u_g;
}

}  // namespace bough::fe
