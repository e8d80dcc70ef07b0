#include "modal/bases/fixed_interface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fe/linear/blas.hpp"
#include "fe/linear/null_space.hpp"
#include "fe/linear/residual.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "fe/model/row_kinds.hpp"
#include "fe/statics/statics.hpp"
#include "modal/canonical.hpp"
#include "modal/pencil.hpp"
#include "modal/pencil_solver.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::bases {

namespace {

[[noreturn]] void throw_mechanism(const fe::Model& model, const Partition& part, const linear::SymmetricMatrix& K_ii) {
  const MatrixXd motions = linear::find_mechanisms(K_ii, fe::list_row_kinds(model, part.interior), 1);
  std::string where;
  for (Eigen::Index c = 0; c < motions.cols(); ++c) {
    Eigen::Index largest = 0;
    motions.col(c).cwiseAbs().maxCoeff(&largest);
    where += (c ? ", " : ", most at ") + detail::describe(model, part.interior[static_cast<std::size_t>(largest)]);
  }
  throw ComputationError("modal.interface-mechanism", {},
                         "with its interface nodes held the model still moves without strain" + where,
                         "tie the loose parts, or name more interface nodes");
}

}  // namespace

struct FixedInterface::Impl {
  const fe::Model& model;
  Partition part;
  linear::RowKinds kinds;  ///< of the interior
  const linear::SymmetricMatrix& K;
  linear::SymmetricMatrix K_ii, M_ii;
  std::optional<linear::SymmetricFactor> factor;

  Impl(const fe::System& system, const std::vector<int>& nodes, Diagnostics& diagnostics)
      : model(system.model),
        part(make_partition(model, nodes, diagnostics)),
        kinds(fe::list_row_kinds(model, part.interior)),
        K(system.K) {
    if (part.interior.empty()) return;
    const auto take_interior = [this](const linear::SymmetricMatrix& A) {
      return part.is_selection() ? linear::take_kept(A, part.interior) : calc_triple_product(A, part.S_i);
    };
    K_ii = take_interior(K);
    M_ii = take_interior(system.M);
    const auto is_accurate = [&] {
      return !factor->is_singular() && linear::calc_softest_energy(K_ii, kinds, *factor) >= linear::kMechanismEnergy;
    };
    factor.emplace(K_ii, false);
    if (!is_accurate()) throw_mechanism(model, part, K_ii);
  }
  /// Solution with one refinement, as in StaticSolver::solve, with a residual of more digits.
  MatrixXd solve_refined(const MatrixXd& F_i) const {
    MatrixXd X = factor->solve(F_i);
    X += factor->solve(linear::calc_residual(K_ii, X, F_i));
    Diagnostics ignored;
    linear::check_residuals(
        linear::calc_static_residuals(linear::get_diagonal(K_ii), X, linear::multiply(K_ii, X), F_i, kinds),
        "load case with the interface held", ignored);
    return X;
  }
  MatrixXd expand(const MatrixXd& X_i) const { return model.T() * MatrixXd(part.S_i * X_i); }
  int count_below(double hz) const;
  detail::RootSearchResult find_roots(int requested, detail::PencilSolver& solver, detail::Roots& roots) const;
  void make_canonical(VectorXd& lambda, MatrixXd& X) const;
};

FixedInterface::FixedInterface(const fe::System& system, const std::vector<int>& nodes, Diagnostics& diagnostics)
    : impl_(std::make_unique<Impl>(system, nodes, diagnostics)) {}
FixedInterface::~FixedInterface() = default;
FixedInterface::FixedInterface(FixedInterface&&) noexcept = default;

const Partition& FixedInterface::partition() const { return impl_->part; }

MatrixXd FixedInterface::calc_constraint_modes() const {
  const auto& part = impl_->part;
  MatrixXd X = part.S_b;
  if (impl_->factor && part.num_boundary() > 0)
    X -= part.S_i * impl_->solve_refined(part.S_i.transpose() * linear::multiply(impl_->K, part.S_b));
  return impl_->model.T() * X;
}

MatrixXd FixedInterface::solve(const MatrixXd& F_g) const {
  MatrixXd U = MatrixXd::Zero(F_g.rows(), F_g.cols());
  if (impl_->factor && F_g.cols() > 0)
    U = impl_->expand(impl_->solve_refined(impl_->part.S_i.transpose() * MatrixXd(impl_->model.T().transpose() * F_g)));
  if (impl_->model.omitted()) U += impl_->model.omitted()(F_g);
  return U;
}

/// Orthonormal again, and one basis of each repeated root.
void FixedInterface::Impl::make_canonical(VectorXd& lambda, MatrixXd& X) const {
  const MatrixXd G = linear::calc_inner_products(X, linear::multiply(M_ii, X));
  detail::orthonormalize_ascending(G, X);
  detail::make_canonical(
      detail::calc_basis_weights(model), [this](const MatrixXd& Y) { return expand(Y); }, lambda, X);
}

int FixedInterface::Impl::count_below(double hz) const {
  const double w = 2 * std::numbers::pi * hz;
  const int count = hz > 0 ? detail::count_roots_below(K_ii, M_ii, w * w) : 0;
  if (count >= 0) return count;
  throw ComputationError("modal.missed-modes", {},
                         "the modes with the interface held below " + std::to_string(hz) +
                             " Hz cannot be counted: the " + "factor of K - w^2 M has zero pivots",
                         "ask for a number of modes instead of a highest frequency");
}

detail::RootSearchResult FixedInterface::Impl::find_roots(int requested, detail::PencilSolver& solver,
                                                          detail::Roots& roots) const {
  detail::RootSearch search;
  search.requested = requested;
  search.num_available = solver.num_available();
  search.solve = [&](detail::Roots& known, int number) { solver.solve(0, number, 0, false, known); };
  search.closeness = [](const detail::Roots&, int) { return detail::kCloseness; };
  search.roundoff = [](const detail::Roots&, int) { return 0.0; };
  search.count = [&](double mu) { return detail::count_roots_below(K_ii, M_ii, mu); };
  solver.solve(0, requested + 2, 2, false, roots);
  return detail::search_roots(search, roots);
}

ModeSet FixedInterface::calc_modes(int number, std::optional<double> max_hz, Diagnostics& diagnostics,
                                   const std::string& eps_type) const {
  const Impl& in = *impl_;
  const auto size = static_cast<int>(in.part.interior.size());
  ModeSet set{VectorXd(0), MatrixXd(in.model.num_gdofs(), 0), {}};
  if (size == 0) return set;
  int requested = number > 0 ? number : (max_hz ? size : 0);
  if (max_hz) requested = std::min(requested, in.count_below(*max_hz));
  if (requested == 0) return set;

  const VectorXd K_diagonal = linear::get_diagonal(in.K_ii);
  detail::PencilProblem problem;
  problem.K = in.K_ii;
  problem.M = in.M_ii;
  problem.M_diagonal = linear::get_diagonal(in.M_ii);
  problem.kinds = in.kinds;
  problem.rigid.resize(size, 0);
  problem.factor = &*in.factor;
  problem.solver = eps_type;
  detail::PencilSolver solver(problem, requested);
  detail::Roots roots{VectorXd(0), MatrixXd(size, 0)};
  const auto result = in.find_roots(requested, solver, roots);
  detail::report_count(result, 0, "modes with the interface held", true, diagnostics);
  if (result.cut < requested)
    diagnostics.warning("modal.fewer-modes", {},
                        "the model has " + std::to_string(result.cut) + " modes with its interface held, " +
                            std::to_string(requested) + " were asked for",
                        "ask for fewer, or use a finer mesh or a consistent mass");
  roots.keep(result.cut);
  if (result.cut == 0) return set;
  in.make_canonical(roots.value, roots.X);
  roots.keep(std::min(requested, result.cut));
  const VectorXd residual = linear::calc_residuals(
      linear::calc_residual_scale(K_diagonal, problem.M_diagonal, roots.value), roots.X,
      linear::multiply(in.K_ii, roots.X), linear::multiply(in.M_ii, roots.X) * roots.value.asDiagonal(), in.kinds);
  linear::check_residuals(residual, "mode with the interface held", diagnostics);
  set.check = {result.cut, result.count, residual.maxCoeff(), solver.get_uses()};
  set.lambda = roots.value;
  set.Phi = in.expand(roots.X);
  detail::fix_signs(set.Phi);
  return set;
}

}  // namespace bough::modal::bases
