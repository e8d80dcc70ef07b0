#include <algorithm>
#include <cmath>
#include <numeric>

#include "bough/modal/canonical.hpp"
#include "bough/modal/eigen.hpp"
#include "bough/modal/krylov.hpp"
#include "bough/modal/pencil.hpp"

namespace bough::modal {

namespace {

/// -K_G φ = θ K φ by descending |θ|; λ = 1/θ.
class BucklingModes {
 public:
  BucklingModes(const fe::Model& model, const fe::AppliedLoad& load, const VectorXd& u_g, const EigenOptions& options,
                Diagnostics& diagnostics, const fe::InitialForces* initial)
      : model_(model),
        options_(options),
        diagnostics_(diagnostics),
        pencil_(model),
        K_G_(fe::assemble_geometric_stiffness(model, fe::DofSet::Free, load, u_g, initial)) {
    fe::check_petsc(MatDuplicate(K_G_.get(), MAT_COPY_VALUES, minus_K_G_.out()));
    fe::check_petsc(MatScale(minus_K_G_.get(), -1));
    X_.resize(pencil_.size(), 0);
  }
  EigenPairs solve();

 private:
  int size() const { return static_cast<int>(theta_.size()); }
  void run_krylov(int num_wanted);
  int count_within(double lambda) const;
  EigenPairs make_pairs(int cut, int num, int count);

  const fe::Model& model_;
  const EigenOptions& options_;
  Diagnostics& diagnostics_;
  detail::Pencil pencil_;
  fe::PetscMat K_G_, minus_K_G_;
  VectorXd theta_;
  MatrixXd X_;
  int round_ = 0;
};

void BucklingModes::run_krylov(int num_wanted) {
  detail::KrylovProblem problem;
  problem.A = minus_K_G_.get();
  problem.B = pencil_.K.get();
  problem.spectrum = detail::Spectrum::LargestMagnitude;
  problem.max_subspace = pencil_.size() - size();
  if (problem.max_subspace <= 0) return;
  problem.num_wanted = std::min(num_wanted, problem.max_subspace);
  problem.deflate = X_;
  problem.tolerance = options_.tolerance;
  problem.start = round_++;
  problem.progress = options_.progress;
  const auto result = detail::solve_krylov(problem);
  if (result.is_singular) detail::throw_singular(pencil_, 0);

  VectorXd all(size() + result.values.size());
  all << theta_, result.values;
  MatrixXd both(X_.rows(), all.size());
  both << X_, result.vectors;
  std::vector<int> order(all.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return std::abs(all(a)) > std::abs(all(b)); });
  // θ = 0 is the dofs that no internal force stiffens: no load buckles them.
  const double floor = all.size() ? 1e-12 * std::abs(all(order[0])) : 0;
  std::erase_if(order, [&](int i) { return std::abs(all(i)) <= floor; });
  theta_ = all(order);
  X_ = both(Eigen::all, order);
}

/// Load factors in (-lambda, lambda), by the inertia of K ± λ K_G.
int BucklingModes::count_within(double lambda) const {
  int sum = 0;
  for (const double factor : {lambda, -lambda}) {
    int count = -1;
    for (double f = factor; count < 0 && std::abs(f) < 1.001 * lambda; f *= 1 + 1e-6)
      count = detail::count_negative(pencil_.K.get(), f, K_G_.get());
    if (count < 0) detail::throw_singular(pencil_, 0);
    sum += count;
  }
  return sum;
}

EigenPairs BucklingModes::make_pairs(int cut, int num, int count) {
  VectorXd lambda = theta_.head(cut).cwiseInverse();
  MatrixXd X = X_.leftCols(cut);
  const MatrixXd KX = pencil_.calc_K_times(X);
  const VectorXd weights = detail::calc_basis_weights(model_);
  for (int a = 0, b = 0; a < cut; a = b) {
    b = detail::find_cluster_end(lambda, a, 1e-8, 0);
    const MatrixXd G = X.middleCols(a, b - a).transpose() * KX.middleCols(a, b - a);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> gram(0.5 * (G + G.transpose()));
    const MatrixXd Y = X.middleCols(a, b - a) * gram.operatorInverseSqrt();
    X.middleCols(a, b - a) = Y * detail::calc_cluster_rotation(weights, MatrixXd(model_.T() * Y));
    lambda.segment(a, b - a).setConstant(lambda.segment(a, b - a).mean());
  }
  std::vector<int> kept;
  for (int i = 0; i < num; ++i)
    if (!(options_.min_hz && lambda(i) < *options_.min_hz) && !(options_.max_hz && lambda(i) > *options_.max_hz))
      kept.push_back(i);
  EigenPairs pairs;
  pairs.lambda = lambda(kept);
  const MatrixXd Y = X(Eigen::all, kept);
  pairs.Phi = model_.T() * Y;
  detail::fix_signs(pairs.Phi);
  pairs.inertia_count = count;
  pairs.residual.resize(pairs.lambda.size());
  for (Eigen::Index j = 0; j < Y.cols(); ++j) {
    fe::PetscVec x, y;
    fe::check_petsc(MatCreateVecs(K_G_.get(), x.out(), y.out()));
    fe::scatter(Y.col(j), x.get());
    fe::check_petsc(MatMult(K_G_.get(), x.get(), y.get()));
    const VectorXd k = pencil_.calc_K_times(Y.col(j));
    pairs.residual(j) = (k + pairs.lambda(j) * fe::gather(y.get())).norm() / k.norm();
  }
  return pairs;
}

EigenPairs BucklingModes::solve() {
  const auto rigid = detail::find_rigid_motions(pencil_);
  if (rigid.modes.cols() + rigid.massless.cols() > 0)
    throw ComputationError("modal.buckling-free", {},
                           "buckling needs a supported model: " +
                               std::to_string(rigid.modes.cols() + rigid.massless.cols()) + " rigid motion(s) are free",
                           "add SPC cards and select them with SPC in the case control");
  int wanted = options_.num_modes;
  if (wanted <= 0) {
    double bound = 0;
    for (const auto& end : {options_.min_hz, options_.max_hz})
      if (end) bound = std::max(bound, std::abs(*end));
    wanted = bound > 0 ? count_within(bound) : pencil_.size();
  }
  const int asked = wanted;
  wanted = std::min(wanted, pencil_.size());
  if (wanted > 0) run_krylov(wanted + std::max(4, wanted / 10));

  int count = -1, cut = -1;
  for (int round = 0; round < 8; ++round) {
    const int before = size();
    int missing = wanted - size();
    if (missing <= 0) {
      for (cut = std::max(wanted, 0); cut < size(); ++cut)
        if (cut == 0 || std::abs(theta_(cut - 1)) - std::abs(theta_(cut)) > 1e-6 * std::abs(theta_(cut - 1))) break;
      if (cut >= size() && size() < pencil_.size()) cut = -1;
      missing = cut < 0 ? 4 : 0;
    }
    if (missing == 0 && options_.check_inertia && cut > 0) {
      const double top = 1 / std::abs(theta_(cut - 1));
      const double next = cut < size() ? 1 / std::abs(theta_(cut)) : 2 * top;
      count = count_within(top + std::min(0.5 * (next - top), 1e-3 * top));
      missing = count - cut;
    }
    if (missing == 0) return make_pairs(cut, std::min(wanted, cut), count);
    if (missing < 0) break;
    run_krylov(missing + 2);
    if (size() == before) {
      if (size() >= wanted && cut >= 0) break;
      // The solver has nothing more to give: K_G has no more rank.
      if (size() < asked && options_.num_modes > 0)
        diagnostics_.warning(
            "modal.fewer-modes", {},
            "the load has " + std::to_string(size()) + " buckling modes, " + std::to_string(asked) + " were asked for",
            "ask for fewer");
      return make_pairs(size(), std::min(wanted, size()), -1);
    }
  }
  throw ComputationError("modal.missed-modes", {},
                         "found " + std::to_string(std::max(cut, 0)) +
                             " load factors, the inertia of the factor counts " + std::to_string(count),
                         "ask for more modes");
}

}  // namespace

EigenPairs calc_buckling_modes(const fe::Model& model, const fe::AppliedLoad& load, const VectorXd& u_g,
                               const EigenOptions& options, Diagnostics& diagnostics,
                               const fe::InitialForces* initial) {
  BOUGH_DEMAND(u_g.size() == model.num_gdofs());
  if (model.num_fdofs() == 0)
    throw ComputationError("modal.no-dofs", {}, "the model has no free dof", "check its SPC sets and rigid elements");
  detail::initialize_slepc();
  return BucklingModes(model, load, u_g, options, diagnostics, initial).solve();
}

}  // namespace bough::modal
