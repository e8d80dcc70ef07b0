#include "solver/linear/gradient_flow.hpp"

#include <algorithm>

namespace bough::solver {
namespace {

constexpr int kMaxFlowSteps = 300;
constexpr double kLongest = 5;         // steps of the plant: half a radian
constexpr double kShort = 1e-6;        // from there on it is for Newton's method
constexpr double kMaxDeflection = 40;  // steps of a modal coordinate: twice the size of the bodies, or 2 rad

/// ∂u̇ with both sides in steps.
MatrixXd calc_slope(const EquilibriumResidual& at) {
  const auto m = static_cast<Eigen::Index>(at.free().size());
  MatrixXd slope(m, m);
  for (Eigen::Index j = 0; j < m; ++j)
    slope.row(j) = at.rate_jacobian().row(at.free()[static_cast<size_t>(j)]) / at.step(static_cast<int>(j));
  return slope;
}

VectorXd calc_pull(const EquilibriumResidual& at) {
  VectorXd pull(static_cast<Eigen::Index>(at.free().size()));
  for (Eigen::Index j = 0; j < pull.size(); ++j)
    pull[j] = at.rates()[at.free()[static_cast<size_t>(j)]] / at.step(static_cast<int>(j));
  return pull;
}

double calc_growth(const MatrixXd& slope) {
  return slope.size() > 0 ? Eigen::EigenSolver<MatrixXd>(slope, false).eigenvalues().real().maxCoeff() : 0;
}

/// Row of a modal coordinate that has travelled beyond kMaxDeflection; -1: none.
int find_diverged(const EquilibriumResidual& at) {
  for (size_t j = 0; j < at.free().size(); ++j) {
    const int row = at.free()[j];
    if (row < at.plant().num_dofs() && at.plant().is_mode(row) &&
        std::abs(at.travel()[static_cast<Eigen::Index>(j)]) > kMaxDeflection)
      return row;
  }
  return -1;
}

}  // namespace

bool is_stable_rest(const EquilibriumResidual& at) {
  const MatrixXd slope = calc_slope(at);
  return slope.size() == 0 || calc_growth(slope) <= 1e-7 * slope.cwiseAbs().maxCoeff();
}

GradientFlow follow_gradient_flow(EquilibriumResidual from) {
  EquilibriumResidual at = std::move(from);
  for (int k = 0; k < kMaxFlowSteps; ++k) {
    at.linearize();
    const MatrixXd slope = calc_slope(at);
    const VectorXd pull = calc_pull(at);
    const double largest = pull.size() > 0 ? pull.cwiseAbs().maxCoeff() : 0;
    if (largest == 0) break;
    double sigma = std::max({1.5 * calc_growth(slope), 1e-8 * slope.cwiseAbs().maxCoeff(), 1e-3 * largest / kLongest});
    bool has_moved = false;
    for (int tries = 0; tries < 60 && !has_moved; ++tries, sigma *= 4) {
      const VectorXd step = (sigma * MatrixXd::Identity(slope.rows(), slope.cols()) - slope).partialPivLu().solve(pull);
      if (!step.allFinite() || step.cwiseAbs().maxCoeff() > kLongest) continue;
      if (step.cwiseAbs().maxCoeff() < kShort) return {std::move(at)};
      try {
        EquilibriumResidual moved = at.move(step);
        // Past the bottom the pull turns round.
        if (!moved.residual().allFinite() || calc_pull(moved).dot(step) < -0.5 * pull.dot(step)) continue;
        at = std::move(moved);
        has_moved = true;
      } catch (const ComputationError&) {
        // Too far: the equations have no solution there.
      }
    }
    if (!has_moved) break;
    if (const int diverged = find_diverged(at); diverged >= 0) return {std::move(at), diverged};
  }
  return {std::move(at)};
}

}  // namespace bough::solver
