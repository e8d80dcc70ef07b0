#include "solver/bodies/soft_energy.hpp"

#include <numeric>

#include <Eigen/Cholesky>

namespace bough::solver {
namespace {

constexpr int kMax = records::kMaxLargeModes;
using Amplitudes = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMax, 1>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMax, kMax>;

std::vector<int> list_all(std::size_t n) {
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Gradients and second derivatives of V_3 and V_4.
struct Derivatives {
  Amplitudes cubic, quartic;
  Square of_cubic, of_quartic;

  Derivatives(const Polynomials& energy, const Amplitudes& eta) : cubic(eta.size()), quartic(eta.size()) {
    const Eigen::Index N = eta.size();
    Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, kMax> J(4, N);
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4 * Polynomials::kMaxScratchRows, 1> scratch(energy.scratch_size());
    double value[2];
    energy.calc(eta, J.data(), value, scratch.data());
    cubic = J.row(0).transpose();
    quartic = J.row(1).transpose();
    of_cubic.resize(N, N);
    of_quartic.resize(N, N);
    Eigen::Index pair = 0;
    for (Eigen::Index f = 0; f < N; ++f) {
      for (Eigen::Index g = f; g < N; ++g, pair += energy.stride()) {
        of_cubic(f, g) = of_cubic(g, f) = scratch[pair];
        of_quartic(f, g) = of_quartic(g, f) = scratch[pair + 1];
      }
    }
  }
};

}  // namespace

SoftEnergy::SoftEnergy(const records::NextOrder& next)
    : modes_(next.modes), energy_(static_cast<int>(modes_.size()), list_all(modes_.size()), 2) {
  const auto add = [&](int degree, int column, const VectorXd& c) {
    MatrixXd both = MatrixXd::Zero(c.size(), 2);
    both.col(column) = c;
    energy_.add(degree, list_all(modes_.size()), both);
  };
  add(3, 0, next.cubic);
  add(4, 1, next.quartic);
}

/// A body of second order in η has the load K x = (K + ⅓ V_3″(x)) η, as K_G of the load's response is ⅓ V_3″, and
/// u₂ = -⅓ K⁻¹ V_3′(η) counts in the displacement. So it is right to the square of the load.
double SoftEnergy::calc_error(const Node& node, const MatrixXd& K_all, const ConstVectorRef& eta) const {
  constexpr int kMaxSteps = 30;
  Vector3d way = Vector3d::Zero();
  for (Eigen::Index j = 0; j < eta.size(); ++j) way += node.phi.col(j) * eta[j];
  if (way.isZero(0)) return 0;
  const auto N = static_cast<Eigen::Index>(modes_.size());
  Amplitudes soft(N);
  Square K(N, N);
  for (Eigen::Index i = 0; i < N; ++i) {
    const int mode = modes_[static_cast<std::size_t>(i)];
    soft[i] = eta[mode];
    for (Eigen::Index j = 0; j < N; ++j) K(i, j) = K_all(mode, modes_[static_cast<std::size_t>(j)]);
  }
  const Amplitudes linear = K * soft;
  const Eigen::LLT<Square> factor(K);
  const Derivatives here(energy_, soft);
  const Eigen::LLT<Square> softened(Square(K - here.of_cubic / 3));
  if (factor.info() != Eigen::Success || softened.info() != Eigen::Success) return 0;
  const Amplitudes load = K * softened.solve(linear), second = soft - factor.solve(here.cubic) / 3;
  Amplitudes state = second;
  const double size = second.dot(K * second);
  for (int step = 0; step < kMaxSteps && size > 0; ++step) {
    const Derivatives at(energy_, state);
    const Eigen::LLT<Square> tangent(Square(K + at.of_cubic + at.of_quartic));
    if (tangent.info() != Eigen::Success) return 0;
    const Amplitudes change = tangent.solve(load - K * state - at.cubic - at.quartic);
    state += change;
    if (!(change.dot(K * change) < 1e-16 * size)) continue;
    Vector3d error = Vector3d::Zero();
    for (Eigen::Index i = 0; i < N; ++i)
      error += node.phi.col(modes_[static_cast<std::size_t>(i)]) * (second[i] - state[i]);
    return error.norm() / way.norm();
  }
  return 0;
}

double SoftEnergy::calc_quartic(std::size_t i) const {
  Amplitudes soft = Amplitudes::Zero(static_cast<Eigen::Index>(modes_.size()));
  soft[static_cast<Eigen::Index>(i)] = 1;
  return Derivatives(energy_, soft).quartic.dot(soft) / 4;
}

}  // namespace bough::solver
