#include "solver/bodies/next_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "solver/bodies/soft_energy.hpp"
#include "solver/bodies/third_order.hpp"

namespace bough::solver {
namespace {

/// Amplitudes on the stack.
using Amplitudes = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, records::kMaxThirdOrderModes, 1>;
/// n x N.
using Shapes =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, records::kMaxThirdOrderModes, records::kMaxLargeModes>;
/// Error of a cantilever of second order by (|u_2|/|u_1|)²: 1.03 w² and 0.6 w at a way of w lengths.
constexpr double kCantilever = 3;
/// Error of a strip that bends about both axes and twists, by the square of what calc_coupling() gives.
constexpr double kStrip = 2;
/// Square of the way of a shape of unit strain energy, of that of the softest one, that has part in a mean.
constexpr double kSoft = 0.05;
/// Share of the strain energy below which the error of small modes is not estimated: it is less.
constexpr double kSmallShare = 1e-3;

/// Displacement of the node beyond φη.
Vector3d calc_higher(const Node& node, const ConstVectorRef& eta) {
  NodeInBody at;
  const Amplitudes rest = Amplitudes::Zero(eta.size());
  calc_node_in_body(node, eta, rest, at);
  Vector3d u = at.r - node.p;
  for (Eigen::Index j = 0; j < eta.size(); ++j) u -= node.phi.col(j) * eta[j];
  return u;
}

/// Ratio of modal forces -f·∂u_2/∂η to K η, in the norm of K⁻¹, f the loads at the node (locators) that fit K η best:
/// the stress of the deflection on its own second strains, as bending of a strip about its stiff axis twists it.
double calc_coupling(const Body& body, const Node& node, const ConstVectorRef& eta, double twice_energy) {
  constexpr int kMax = records::kMaxThirdOrderModes;
  if (eta.size() > kMax || !(twice_energy > 0)) return 0;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMax, kMax>;
  using Loads = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMax, 6>;
  const Eigen::LDLT<Square> K(body.K().topLeftCorner(eta.size(), eta.size()));
  Loads phi = Loads::Zero(eta.size(), 6);
  phi.leftCols<3>() = node.phi.transpose();
  if (node.K2_theta.size() > 0) phi.rightCols<3>() = node.psi.transpose();
  const Loads flexible = K.solve(phi);
  const Matrix6d G = phi.transpose() * flexible;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(Matrix6d(0.5 * (G + G.transpose())));
  Vector6d inverse = eigen.eigenvalues();
  for (double& value : inverse) value = value > 1e-12 * eigen.eigenvalues()[5] ? 1 / value : 0;
  const Vector6d u = phi.transpose() * eta,
                 f = eigen.eigenvectors() * (inverse.asDiagonal() * (eigen.eigenvectors().transpose() * u));
  Amplitudes force(eta.size());
  for (Eigen::Index j = 0; j < eta.size(); ++j) {
    force[j] = 0;
    for (int a = 0; a < 3; ++a) {
      force[j] += f[a] * node.K2.row(a + 3 * j).dot(eta);
      if (node.K2_theta.size() > 0) force[j] += f[3 + a] * node.K2_theta.row(a + 3 * j).dot(eta);
    }
  }
  return std::sqrt(std::max(0.0, force.dot(K.solve(force))) / twice_energy);
}

/// V_3 to V_6 of a body of third order, by the values at ±η and ±½η.
std::array<double, 4> split_energy(const ThirdOrderBody& third, const ConstVectorRef& eta) {
  constexpr std::array<double, 4> shares = {1, -1, 0.5, -0.5};
  std::array<double, 4> V{};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const Amplitudes part = shares[i] * eta;
    V[i] = third.calc_energy(part);
  }
  const double even = 0.5 * (V[0] + V[1]), even_half = 0.5 * (V[2] + V[3]);  // V_4 + V_6, V_4/16 + V_6/64
  const double odd = 0.5 * (V[0] - V[1]), odd_half = 0.5 * (V[2] - V[3]);    // V_3 + V_5, V_3/8 + V_5/32
  const double V3 = (32 * odd_half - odd) / 3, V4 = (64 * even_half - even) / 3;
  return {V3, V4, odd - V3, even - V4};
}

double calc_root(double ratio, int degree) { return std::pow(ratio, 1.0 / degree); }

}  // namespace

double calc_small_error(const Body& body, const ConstVectorRef& eta) {
  const MatrixXd& K = body.K();
  const Eigen::Index n = eta.size();
  const ThirdOrderBody* third = body.third_order();
  const SoftEnergy* soft = body.soft_energy();
  if (!third && !soft) return 0;
  const auto get_mode = [&](Eigen::Index f) { return soft->modes()[static_cast<std::size_t>(f)]; };
  const auto is_soft = [&](Eigen::Index j) {
    return std::binary_search(soft->modes().begin(), soft->modes().end(), static_cast<int>(j));
  };
  double twice = 0, small = 0;
  for (Eigen::Index j = 0; j < n; ++j) twice += K.col(j).dot(eta) * eta[j];
  if (third) {
    small = third->calc_twice_small_energy(K, eta);
  } else {
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index k = 0; k < n && !is_soft(j); ++k)
        if (!is_soft(k)) small += eta[j] * K(j, k) * eta[k];
  }
  if (!(small > kSmallShare * twice)) return 0;
  const Eigen::Index N = third ? third->num_large() : static_cast<Eigen::Index>(soft->modes().size());
  Shapes shapes;  // of order 3; a body of order 2 may have more modes
  if (third) {
    shapes.resize(n, N);
    third->calc_large_shapes(K, shapes);
  }
  std::array<double, records::kMaxLargeModes> ratio{}, softness{};
  for (Eigen::Index f = 0; f < N; ++f) {
    double own = 0, common = 0;  // squares of the way of the shape, and of the deflection there
    for (const Node& node : body.nodes()) {
      if (!node.moves || !node.is_material) continue;
      Vector3d of_shape = Vector3d::Zero(), all = Vector3d::Zero();
      for (Eigen::Index j = 0; j < n; ++j) {
        all += node.phi.col(j) * eta[j];
        if (third) of_shape += node.phi.col(j) * shapes(j, f);
      }
      if (!third) of_shape = node.phi.col(get_mode(f));
      own = std::max(own, of_shape.squaredNorm());
      common = std::max(common, of_shape.squaredNorm() * all.squaredNorm());
    }
    double stiffness = third ? 0 : K(get_mode(f), get_mode(f));
    for (Eigen::Index j = 0; third && j < n; ++j) stiffness += shapes(j, f) * K.col(j).head(n).dot(shapes.col(f));
    const double quartic =
        third ? split_energy(*third, shapes.col(f))[1] : soft->calc_quartic(static_cast<std::size_t>(f));
    if (!(own > 0 && stiffness > 0)) continue;
    softness[static_cast<std::size_t>(f)] = own / stiffness;
    ratio[static_cast<std::size_t>(f)] = 4 * std::abs(quartic) / stiffness * common / (own * own);
  }
  const double softest = *std::max_element(softness.begin(), softness.end());
  double sum = 0;
  int number = 0;
  for (std::size_t f = 0; f < ratio.size(); ++f) {
    if (!(softness[f] > 0 && softness[f] >= kSoft * softest)) continue;  // rotations of grids alone
    sum += ratio[f];
    ++number;
  }
  return number > 0 ? small / twice * sum / (number + sum) : 0;
}

double calc_next_order(const Body& body, const Node& node, const ConstVectorRef& eta, double size) {
  Vector3d u1 = Vector3d::Zero();
  for (Eigen::Index j = 0; j < eta.size(); ++j) u1 += node.phi.col(j) * eta[j];
  const double first = u1.norm();
  if (!(first > 0)) return 0;
  double twice = 0;  // ηᵀKη
  for (Eigen::Index j = 0; j < eta.size(); ++j) twice += body.K().col(j).dot(eta) * eta[j];
  if (!body.third_order()) {
    double of_body = size > 0 ? first * first / (size * size) : 0;
    if (body.soft_energy()) of_body = std::max(of_body, body.soft_energy()->calc_error(node, body.K(), eta));
    if (node.K2.size() == 0) return of_body;
    double square = 0;  // |u_2|²; u_2a = -½ ηᵀK2_a η
    for (int a = 0; a < 3; ++a) {
      double twice_u2 = 0;
      for (Eigen::Index j = 0; j < eta.size(); ++j) twice_u2 += node.K2.row(a + 3 * j).dot(eta) * eta[j];
      square += 0.25 * twice_u2 * twice_u2;
    }
    const double coupling = calc_coupling(body, node, eta, twice);
    return std::max({of_body, kCantilever * square / (first * first), kStrip * coupling * coupling});
  }
  // Degrees apart by their values at ±η and ±½η.
  constexpr std::array<double, 4> shares = {1, -1, 0.5, -0.5};
  std::array<Vector3d, 4> u;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const Amplitudes part = shares[i] * eta;
    u[i] = node.higher.empty() ? Vector3d(Vector3d::Zero()) : calc_higher(node, part);
  }
  const Vector3d even = 0.5 * (u[0] + u[1]), half = 0.5 * (u[2] + u[3]);
  const Vector3d u2 = (16 * half - even) / 3, u3 = 0.5 * (u[0] - u[1]), u4 = even - u2;
  double ratio = 0;
  ratio = std::max(ratio, u2.norm() / first);
  ratio = std::max(ratio, calc_root(u3.norm() / first, 2));
  ratio = std::max(ratio, calc_root(u4.norm() / first, 3));
  if (twice > 0) {
    const std::array<double, 4> energies = split_energy(*body.third_order(), eta);
    for (int k = 3; k <= 6; ++k)
      ratio = std::max(ratio, calc_root(std::abs(energies[static_cast<std::size_t>(k - 3)]) / (0.5 * twice), k - 2));
  }
  // Small modes have no V_4: the error of their part of the load is that of order 2.
  const double small = twice > 0 ? body.third_order()->calc_twice_small_energy(body.K(), eta) / twice : 0;
  return std::max(std::pow(ratio, 4), size > 0 ? small * first * first / (size * size) : 0);
}

}  // namespace bough::solver
