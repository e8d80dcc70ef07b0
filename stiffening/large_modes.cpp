// Large modes of a body of third order: those of the body file, or the default (docs/theory/third-order.md).
#include "stiffening/large_modes.hpp"

#include <algorithm>

#include "fe/model/model_size.hpp"
#include "formats/records/third_order.hpp"

namespace bough::stiffening {
namespace {

/// Way of the reference load's work, in sizes of the model.
constexpr double kReferenceWay = 0.1;
/// A mode that the reference load moves by this share of the softest one's way, or more, is large.
constexpr double kSoft = 0.05;
/// Another mode is small if bending of the large ones moves it by more than this number of its ways under the load.
constexpr double kFollows = 2;

}  // namespace

VectorXd calc_largest_ways(const fe::Model& model, const MatrixXd& Phi, double arm) {
  VectorXd ways = VectorXd::Zero(Phi.cols());
  for (const auto& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    ways = ways.cwiseMax(Phi.middleRows<3>(node.first_gdof).colwise().norm().transpose());
    if (arm > 0) ways = ways.cwiseMax(arm * Phi.middleRows<3>(node.first_gdof + 3).colwise().norm().transpose());
  }
  return ways;
}

std::vector<int> find_named_large_modes(const BodyRequest& request, int num_modes) {
  const auto& spec = request.spec;
  std::vector<int> large;
  for (const int mode : spec.large_modes) {
    if (mode < 1 || mode > num_modes)
      request.error_at("stiffening/large", "reduce.bad-order",
                       "mode " + std::to_string(mode) + " in [body.stiffening] large does not exist: the body has " +
                           std::to_string(num_modes) + " modes",
                       "name modes from 1 to " + std::to_string(num_modes));
    large.push_back(mode - 1);
  }
  if (spec.num_large > num_modes)
    request.error_at("stiffening/large", "reduce.bad-order",
                     "[body.stiffening] large = " + std::to_string(spec.num_large) + ", but the body has " +
                         std::to_string(num_modes) + " modes",
                     "give at most " + std::to_string(num_modes));
  for (int j = 0; j < std::min(spec.num_large, num_modes); ++j) large.push_back(j);
  std::sort(large.begin(), large.end());
  if (std::adjacent_find(large.begin(), large.end()) != large.end())
    request.error_at("stiffening/large", "reduce.bad-order", "a mode occurs twice in [body.stiffening] large",
                     "name each mode once");
  if (large.size() > records::kMaxLargeModes)
    request.error_at("stiffening/large", "reduce.bad-order",
                     "[body.stiffening] large has " + std::to_string(large.size()) + " modes, at most " +
                         std::to_string(records::kMaxLargeModes) + " are possible",
                     "the tables grow with the sixth power: keep the modes that deflect most");
  if (num_modes > records::kMaxThirdOrderModes)
    request.error_at("stiffening/large", "reduce.bad-order",
                     "a body of third order has at most " + std::to_string(records::kMaxThirdOrderModes) +
                         " modes, this one has " + std::to_string(num_modes),
                     "keep fewer modes, or set order = 2");
  request.diagnostics.throw_if_errors();
  return large;
}

std::vector<int> find_default_large_modes(const fe::Model& model, const MatrixXd& Phi, const MatrixXd& gradient,
                                          std::vector<int> large, bool counts_rotations) {
  const auto n = static_cast<int>(Phi.cols());
  const double size = fe::calc_model_size(model);
  const VectorXd ways = calc_largest_ways(model, Phi, counts_rotations ? kTurnedShare * size : 0);
  const double softest = ways.size() > 0 ? ways.maxCoeff() : 0;
  if (!(softest > 0)) return large;
  const VectorXd amplitude = kReferenceWay * size / (softest * softest) * ways;
  const Eigen::MatrixXi exponents = records::list_exponents(n, 2);
  /// Static amplitude of mode j due to the quadratic terms of the other large modes.
  const auto calc_coupled = [&](int j) {
    double square = 0;
    for (Eigen::Index i = 0; i < exponents.rows(); ++i) {
      double term = gradient(j, i);
      int num_factors = 0;
      for (const int a : large)
        for (int e = 0; a != j && e < exponents(i, a); ++e, ++num_factors) term *= amplitude[a];
      if (num_factors == 2) square += term * term;
    }
    return std::sqrt(square);
  };
  for (;;) {
    double worst = kFollows;
    int stiff = -1;
    for (const int j : large) {
      if (ways[j] * ways[j] >= kSoft * softest * softest) continue;
      const double coupled = calc_coupled(j), ratio = amplitude[j] > 0 ? coupled / amplitude[j] : 2;
      if (ratio <= worst) continue;
      worst = ratio;
      stiff = j;
    }
    if (stiff < 0) break;
    large.erase(std::find(large.begin(), large.end(), stiff));
  }
  std::stable_sort(large.begin(), large.end(), [&](int a, int b) { return ways[a] > ways[b]; });
  large.resize(std::min<std::size_t>(large.size(), kDefaultLargeModes));
  std::sort(large.begin(), large.end());
  return large;
}

MatrixXd calc_compliant_directions(const fe::Model& model, const MatrixXd& Phi, const MatrixXd& K,
                                   const std::vector<int>& interface_nodes) {
  const double arm = kTurnedShare * fe::calc_model_size(model);
  const Eigen::Index n = Phi.cols();
  MatrixXd of_grids = MatrixXd::Zero(n, n), of_interface = of_grids;
  int num_grids = 0, num_interface = 0;
  for (const auto& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    const MatrixXd u = Phi.middleRows<3>(node.first_gdof), turned = arm * Phi.middleRows<3>(node.first_gdof + 3);
    const MatrixXd square = u.transpose() * u + turned.transpose() * turned;
    of_grids += square;
    ++num_grids;
    if (std::find(interface_nodes.begin(), interface_nodes.end(), node.id) == interface_nodes.end()) continue;
    of_interface += square;
    ++num_interface;
  }
  of_grids /= std::max(1, num_grids);
  if (num_interface > 0) of_grids += of_interface / num_interface;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(of_grids, K);
  MatrixXd directions = eigen.eigenvectors().rowwise().reverse();
  for (Eigen::Index j = 0; j < n; ++j) {  // a sign that does not depend on the solver
    Eigen::Index largest = 0;
    directions.col(j).cwiseAbs().maxCoeff(&largest);
    if (directions(largest, j) < 0) directions.col(j) *= -1;
  }
  return directions;
}

}  // namespace bough::stiffening
