#include "bough/modal/bases/fixed_interface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bough/fe/mechanism.hpp"
#include "bough/fe/statics.hpp"
#include "bough/modal/canonical.hpp"
#include "bough/modal/krylov.hpp"
#include "bough/modal/pencil.hpp"

namespace bough::modal::bases {

namespace {

/// As in eigen.cpp: below this size Krylov has nothing to offer.
constexpr int kDenseSize = 60, kDenseLimit = 4000;

[[noreturn]] void throw_mechanism(const fe::Model& model, const Partition& part, Mat K_ii) {
  const MatrixXd motions = fe::find_mechanisms(K_ii, 1);
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
  fe::PetscMat K, M, K_ii, M_ii;
  std::optional<fe::SymmetricFactor> factor;

  Impl(const fe::Model& model_in, const std::vector<int>& nodes, Diagnostics& diagnostics)
      : model(model_in),
        part(make_partition(model, nodes, diagnostics)),
        K(fe::assemble_stiffness(model, fe::DofSet::Free)),
        M(fe::assemble_mass(model, fe::DofSet::Free, model.mass_kind())) {
    if (part.interior.empty()) return;
    K_ii = calc_triple_product(K.get(), part.S_i);
    M_ii = calc_triple_product(M.get(), part.S_i);
    const auto is_sound = [&] {
      return !factor->is_singular() && fe::calc_softest_energy(K_ii.get(), *factor) >= fe::kMechanismEnergy;
    };
    factor.emplace(K_ii.get(), false);
    if (!is_sound()) throw_mechanism(model, part, K_ii.get());
  }
  MatrixXd expand(const MatrixXd& X_i) const { return model.T() * MatrixXd(part.S_i * X_i); }
  int count_below(double lambda) const {
    for (int attempt = 0; attempt < 4; ++attempt, lambda *= 1 + 1e-9) {
      const int count = detail::count_negative(K_ii.get(), -lambda, M_ii.get());
      if (count >= 0) return count;
    }
    return -1;
  }
  void solve_dense(VectorXd& lambda, MatrixXd& X) const;
  void make_canonical(VectorXd& lambda, MatrixXd& X) const;
};

FixedInterface::FixedInterface(const fe::Model& model, const std::vector<int>& nodes, Diagnostics& diagnostics)
    : impl_(std::make_unique<Impl>(model, nodes, diagnostics)) {}
FixedInterface::~FixedInterface() = default;
FixedInterface::FixedInterface(FixedInterface&&) noexcept = default;

const Partition& FixedInterface::partition() const { return impl_->part; }

MatrixXd FixedInterface::calc_constraint_modes() const {
  const auto& part = impl_->part;
  MatrixXd X = part.S_b;
  if (impl_->factor && part.num_boundary() > 0)
    X -= part.S_i * impl_->factor->solve(part.S_i.transpose() * fe::multiply(impl_->K.get(), part.S_b));
  return impl_->model.T() * X;
}

MatrixXd FixedInterface::solve(const MatrixXd& F_g) const {
  MatrixXd U = MatrixXd::Zero(F_g.rows(), F_g.cols());
  if (impl_->factor && F_g.cols() > 0)
    U = impl_->expand(impl_->factor->solve(impl_->part.S_i.transpose() * MatrixXd(impl_->model.T().transpose() * F_g)));
  if (impl_->model.omitted()) U += impl_->model.omitted()->solve(F_g);
  return U;
}

/// M x = θ K x, λ = 1/θ: massless dofs sit harmlessly at θ = 0.
void FixedInterface::Impl::solve_dense(VectorXd& lambda, MatrixXd& X) const {
  const auto n = static_cast<Eigen::Index>(part.interior.size());
  const MatrixXd identity = MatrixXd::Identity(n, n);
  MatrixXd K_dense = fe::multiply(K_ii.get(), identity), M_dense = fe::multiply(M_ii.get(), identity);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(0.5 * (M_dense + M_dense.transpose()),
                                                                  0.5 * (K_dense + K_dense.transpose()));
  const VectorXd theta = solver.eigenvalues().reverse();
  const auto rank = (theta.array() > 1e-14 * std::max(theta.maxCoeff(), 0.0)).count();
  lambda = theta.head(rank).cwiseInverse();
  X = solver.eigenvectors().rowwise().reverse().leftCols(rank) *
      theta.head(rank).cwiseSqrt().cwiseInverse().asDiagonal();
}

/// Orthonormal once more, and one basis of each repeated root.
void FixedInterface::Impl::make_canonical(VectorXd& lambda, MatrixXd& X) const {
  const MatrixXd G = X.transpose() * fe::multiply(M_ii.get(), X);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> gram(0.5 * (G + G.transpose()));
  X = X * gram.operatorInverseSqrt();
  const VectorXd weights = detail::calc_basis_weights(model);
  for (int a = 0, b = 0; a < lambda.size(); a = b) {
    b = detail::find_cluster_end(lambda, a, 1e-8, 0);
    if (b == a + 1) continue;
    const MatrixXd Y = X.middleCols(a, b - a);
    X.middleCols(a, b - a) = Y * detail::calc_cluster_rotation(weights, expand(Y));
    lambda.segment(a, b - a).setConstant(lambda.segment(a, b - a).mean());
  }
}

ModeSet FixedInterface::calc_modes(int number, std::optional<double> max_hz, Diagnostics& diagnostics) const {
  const Impl& in = *impl_;
  const auto size = static_cast<int>(in.part.interior.size());
  ModeSet set{VectorXd(0), MatrixXd(in.model.num_gdofs(), 0)};
  if (size == 0) return set;
  const int available = static_cast<int>((fe::get_diagonal(in.M_ii.get()).array() > 0).count());
  int wanted = number > 0 ? number : (max_hz ? available : 0);
  if (max_hz) {
    const double w = 2 * std::numbers::pi * *max_hz;
    const int below = w > 0 ? in.count_below(w * w) : 0;
    if (below >= 0) wanted = std::min(wanted, below);
  }
  if (wanted > available) {
    diagnostics.warning("modal.fewer-modes", {},
                        "the model has " + std::to_string(available) + " modes with its interface held, " +
                            std::to_string(wanted) + " were asked for",
                        "ask for fewer, or use a finer mesh or a consistent mass");
    wanted = available;
  }
  if (wanted == 0) return set;

  VectorXd lambda(0);
  MatrixXd X(size, 0);
  int request = wanted + std::max(4, wanted / 10), complete = -1;
  if (size <= kDenseSize || (2 * request >= available && size <= kDenseLimit)) {
    in.solve_dense(lambda, X);
    complete = static_cast<int>(lambda.size());
  }
  for (int round = 0; complete < 0 && round < 8; ++round) {
    detail::KrylovProblem problem;
    problem.A = in.K_ii.get();
    problem.B = in.M_ii.get();
    problem.max_subspace = available - static_cast<int>(lambda.size());
    if (problem.max_subspace <= 0) break;
    problem.num_wanted = std::min(request, problem.max_subspace);
    problem.deflate = X;
    problem.tolerance = 1e-12;
    problem.start = round;
    const auto found = detail::solve_krylov(problem);
    if (found.values.size() == 0) break;
    VectorXd all(lambda.size() + found.values.size());
    all << lambda, found.values;
    MatrixXd both(size, all.size());
    both << X, found.vectors;
    std::vector<int> order(static_cast<std::size_t>(all.size()));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return all(a) < all(b); });
    lambda = all(order);
    X = both(Eigen::all, order);
    // The first gap at or after the last one wanted: what lies below can be counted.
    int cut = wanted;
    while (cut < lambda.size() && lambda(cut) - lambda(cut - 1) <= 1e-6 * lambda(cut)) ++cut;
    request = 4;
    if (cut >= lambda.size() && cut < available) continue;
    const double top = lambda(cut - 1);
    const double mu = cut < lambda.size() ? std::min(0.5 * (top + lambda(cut)), 1.001 * top) : 1.001 * top;
    const int count = in.count_below(mu);
    if (count == cut) complete = cut;
    request = std::max(4, count - cut + 2);
  }
  if (complete < 0 || lambda.size() < std::min(wanted, complete))
    throw ComputationError("modal.missed-modes", {},
                           "found " + std::to_string(lambda.size()) + " modes with the interface held, not all of them",
                           "ask for more modes; look for negative springs");
  complete = std::min<int>(complete, static_cast<int>(lambda.size()));
  lambda = lambda.head(complete).eval();
  X = X.leftCols(complete).eval();
  in.make_canonical(lambda, X);
  const int kept = std::min(wanted, complete);
  set.lambda = lambda.head(kept);
  set.Phi = in.expand(X.leftCols(kept));
  detail::fix_signs(set.Phi);
  return set;
}

}  // namespace bough::modal::bases
