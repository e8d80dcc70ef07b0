#include "formats/records/slosh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Eigenvalues>

namespace bough::records {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kXi = 1.8411837813406593;  // first zero of J1'

/// Nodes and weights of Gauss's rule with n points on (0, 1), by the Jacobi matrix (Golub & Welsch 1969).
std::pair<Eigen::VectorXd, Eigen::VectorXd> calc_gauss(int n) {
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(n, n);
  for (int i = 1; i < n; ++i) T(i, i - 1) = T(i - 1, i) = i / std::sqrt(4.0 * i * i - 1);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(T);
  return {0.5 * (eigen.eigenvalues().array() + 1), eigen.eigenvectors().row(0).array().square()};
}

constexpr int kHarmonics = 20;
using Harmonics = Eigen::Matrix<double, kHarmonics + 1, 1>;

/// W_n(s, z) of r^n P_n¹ cos φ = W_n cos φ, s the distance from the axis; ∂W_n/∂z = (n + 1) W_(n-1), ∂W_n/∂r = n W_n/r.
Harmonics calc_harmonics(double s, double z) {
  Harmonics w = Harmonics::Zero();
  w[1] = s;
  for (int n = 2; n <= kHarmonics; ++n) w[n] = ((2 * n - 1) * z * w[n - 1] - n * (s * s + z * z) * w[n - 2]) / (n - 1);
  return w;
}

/// ω²/g and m1 over the density, of radius 1 and the depth. Potential φ with λ the least of ∫∇φ·∇φ / ∫_surface φ²,
/// m1 = ρ λ (∫_surface x φ)² / ∫_surface φ².
std::pair<double, double> solve_sphere(double depth) {
  const auto [x, weight] = calc_gauss(2 * kHarmonics + 4);
  const double top = depth - 1, edge2 = depth * (2 - depth);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(kHarmonics, kHarmonics), M = K;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(kHarmonics);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double z = -1 + depth * x[i];
    const Harmonics wall = calc_harmonics(std::sqrt(std::max(0.0, 1 - z * z)), z);
    const double s = std::sqrt(edge2) * x[i], area = std::sqrt(edge2) * weight[i] * s;
    const Harmonics surface = calc_harmonics(s, top);
    for (int j = 1; j <= kHarmonics; ++j) {
      b[j - 1] += area * s * surface[j];
      for (int k = 1; k <= kHarmonics; ++k) {
        K(j - 1, k - 1) += depth * weight[i] * wall[j] * k * wall[k] + area * surface[j] * (k + 1) * surface[k - 1];
        M(j - 1, k - 1) += area * surface[j] * surface[k];
      }
    }
  }
  const Eigen::VectorXd size = K.diagonal().cwiseSqrt().cwiseInverse();
  K = (size.asDiagonal() * (0.5 * (K + K.transpose())) * size.asDiagonal()).eval();
  M = (size.asDiagonal() * M * size.asDiagonal()).eval();
  b = b.cwiseProduct(size).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> basis(K);
  int first = 0;  // directions of K that are round-off
  while (basis.eigenvalues()[first] <= 1e-13 * basis.eigenvalues()[kHarmonics - 1]) ++first;
  const int kept = kHarmonics - first;
  const Eigen::MatrixXd T =
      basis.eigenvectors().rightCols(kept) * basis.eigenvalues().tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigen::MatrixXd reduced = T.transpose() * M * T;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(reduced);
  const Eigen::VectorXd c = T * modes.eigenvectors().col(kept - 1);
  const double lambda = 1 / modes.eigenvalues()[kept - 1], along = b.dot(c);
  return {lambda, lambda * kPi * along * along / c.dot(M * c)};
}

}  // namespace

SloshPendulum calc_cylinder_slosh(double radius, double depth, double density) {
  const double x = kXi * depth / radius, arm = radius / kXi;
  SloshPendulum p;
  p.mass = density * kPi * radius * radius * radius * 2 * std::tanh(x) / (kXi * (kXi * kXi - 1));
  p.length = arm / std::tanh(x);
  p.hinge = depth - arm * (std::cosh(x) - 2) / std::sinh(x);
  if (x > 300) p.hinge = depth - arm;
  return p;
}

double calc_sphere_depth(double radius, double density, double mass) {
  const double share = std::clamp(mass / (4.0 / 3 * kPi * density * std::pow(radius, 3)), 0.0, 1.0);
  return radius * (1 + 2 * std::cos((2 * std::asin(std::sqrt(share)) + 4 * kPi) / 3));
}

SloshPendulum calc_sphere_slosh(double radius, double depth, double density) {
  const auto [lambda, volume] = solve_sphere(depth / radius);
  return {density * volume * std::pow(radius, 3), radius / lambda, 0};
}

double calc_wall_damping(double radius, double depth, double viscosity, double g) {
  const double ratio = depth / radius, x = std::min(1.84 * ratio, 300.0);
  const double bottom = 0.318 / std::sinh(x) * (1 + (1 - ratio) / std::cosh(x));
  return 0.79 * std::sqrt(viscosity) / (std::pow(radius, 0.75) * std::pow(g, 0.25)) * (1 + bottom);
}

double calc_baffle_damping(double radius, double width, double depth, double amplitude) {
  const double share = width / radius * (2 - width / radius);
  return 2.83 * std::exp(-4.60 * depth / radius) * std::pow(share, 1.5) * std::sqrt(amplitude / radius);
}

namespace {

/// Damping ratio of all causes; empty: reported by `refuse`.
template <class Refuse>
std::optional<double> calc_damping(const TankRecord& tank, double depth, double g, const Refuse& refuse) {
  const bool has_baffles = !tank.baffle_depths.empty();
  if ((has_baffles || tank.slosh_viscosity > 0) && tank.type != TankType::Cylinder) {
    refuse("has a slosh_viscosity or baffles and is no cylinder", "give its slosh_damping");
    return {};
  }
  if ((tank.slosh_damping > 0 || tank.slosh_viscosity > 0 || has_baffles || tank.slosh_model == SloshModel::Spring) &&
      !(g > 0)) {
    refuse(tank.slosh_model == SloshModel::Spring
               ? "sloshes on springs and has no acceleration that their stiffness belongs to"
               : "has a slosh_damping and no acceleration that it belongs to",
           "give slosh_acceleration");
    return {};
  }
  double damping = tank.slosh_damping;
  if (tank.slosh_viscosity > 0) damping += calc_wall_damping(tank.radius, depth, tank.slosh_viscosity, g);
  for (const double baffle : tank.baffle_depths) {
    if (!(baffle >= 0 && baffle <= depth) || !(tank.baffle_width < tank.radius)) {
      refuse("has a baffle that is above the surface, below the bottom or wider than the radius",
             "give baffle_depths from 0 to the depth of the liquid, and a baffle_width below radius");
      return {};
    }
    damping += calc_baffle_damping(tank.radius, tank.baffle_width, baffle, tank.baffle_amplitude);
  }
  return damping;
}

}  // namespace

void add_slosh(SystemSpec& spec, Diagnostics& diagnostics) {
  for (TankRecord& tank : spec.tanks) {
    if (!tank.sloshes) continue;
    const auto refuse = [&](const std::string& what, const std::string& advice) {
      diagnostics.error("system.bad-tank", tank.at, "tank '" + tank.name + "' " + what, advice);
    };
    const bool is_sphere = tank.type == TankType::Sphere;
    if (!is_sphere && tank.type != TankType::Cylinder) {
      refuse("sloshes and is neither a cylinder nor a sphere", "give the pendulum as a separate body");
      continue;
    }
    if (!tank.function.empty()) {
      refuse("sloshes and has a mass that is a function", "give it a mass");
      continue;
    }
    if (!(tank.mass > 0) || !(tank.radius > 0) || !(tank.density > 0) || !(tank.axis.norm() > 0)) continue;  // reported
    const double depth = is_sphere ? calc_sphere_depth(tank.radius, tank.density, tank.mass)
                                   : tank.mass / (tank.density * kPi * tank.radius * tank.radius);
    if (is_sphere && depth > 1.95 * tank.radius) {
      refuse("sloshes and is filled beyond 95 % of its diameter", "leave slosh out, or fill it less");
      continue;
    }
    const SloshPendulum p = is_sphere ? calc_sphere_slosh(tank.radius, depth, tank.density)
                                      : calc_cylinder_slosh(tank.radius, depth, tank.density);
    const double g = tank.slosh_acceleration > 0 ? tank.slosh_acceleration : spec.simulation.gravity.norm();
    const std::optional<double> ratio = calc_damping(tank, depth, g, refuse);
    if (!ratio) continue;
    const Vector3d e = tank.axis.normalized(), first = e.unitOrthogonal();
    BodyRecord bob;
    bob.name = tank.name + ".slosh";
    bob.at = tank.at;
    bob.mass = p.mass;
    HingeRecord hinge;
    hinge.name = bob.name;
    hinge.at = tank.at;
    hinge.parent = tank.body;
    hinge.child = bob.name;
    tank.slosh_mass = p.mass;
    tank.slosh_position = tank.position + (p.hinge - p.length) * e;
    double damping = 2 * *ratio * p.mass * std::sqrt(g / p.length);
    if (tank.slosh_model == SloshModel::Spring) {
      hinge.type = HingeType::General;
      hinge.translations = "xy";
      hinge.parent_position = tank.slosh_position;
      hinge.parent_rotation << first, e.cross(first), e;
      hinge.child_rotation = hinge.parent_rotation;
      hinge.stiffness.assign(2, p.mass * g / p.length);
    } else {
      hinge.type = HingeType::Universal;
      hinge.parent_position = tank.position + p.hinge * e;
      hinge.axis = first;
      hinge.axis2 = e.cross(first);
      bob.cg = -p.length * e;
      damping *= p.length * p.length;
    }
    if (damping > 0) hinge.damping = {damping, damping};
    spec.bodies.push_back(std::move(bob));
    spec.hinges.push_back(std::move(hinge));
  }
}

}  // namespace bough::records
