#include "fe/sections/thin_wall.hpp"

#include <algorithm>

#include "fe/shape/gauss.hpp"

namespace bough::fe {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

double cross(const Vector2d& p, const Vector2d& q) { return p[0] * q[1] - p[1] * q[0]; }

/// Node-by-wall incidence: +1 where the wall ends, -1 where it starts.
MatrixXd calc_incidence(const std::vector<Wall>& walls) {
  std::vector<Vector2d> nodes;
  double size = 0;
  for (const Wall& w : walls) size = std::max({size, w.a.norm(), w.b.norm()});
  const auto find = [&](const Vector2d& p) {
    const auto it =
        std::find_if(nodes.begin(), nodes.end(), [&](const Vector2d& q) { return (p - q).norm() < 1e-9 * size; });
    if (it != nodes.end()) return static_cast<int>(it - nodes.begin());
    nodes.push_back(p);
    return static_cast<int>(nodes.size()) - 1;
  };
  std::vector<std::pair<int, int>> ends;
  for (const Wall& w : walls) {
    const int a = find(w.a), b = find(w.b);
    ends.emplace_back(a, b);
  }
  MatrixXd B = MatrixXd::Zero(static_cast<int>(nodes.size()), static_cast<int>(walls.size()));
  for (int i = 0; i < B.cols(); ++i) {
    B(ends[static_cast<std::size_t>(i)].first, i) -= 1;
    B(ends[static_cast<std::size_t>(i)].second, i) += 1;
  }
  return B;
}

}  // namespace

ThinWallResult calc_thin_wall(const std::vector<Wall>& walls) {
  const int n = static_cast<int>(walls.size());
  double A = 0, I1 = 0, I2 = 0, I12 = 0;
  Vector2d c = Vector2d::Zero();
  for (const Wall& w : walls) {
    const double area = w.t * (w.b - w.a).norm();
    A += area;
    c += area * 0.5 * (w.a + w.b);
  }
  c /= A;
  for (const Wall& w : walls) {
    for (const GaussPoint& g : get_gauss_points(2)) {
      const Vector2d p = w.a + g.x * (w.b - w.a) - c;
      const double area = g.weight * w.t * (w.b - w.a).norm();
      I1 += area * p[0] * p[0];
      I2 += area * p[1] * p[1];
      I12 += area * p[0] * p[1];
    }
  }
  const MatrixXd B = calc_incidence(walls);
  Eigen::FullPivLU<MatrixXd> lu(B);
  lu.setThreshold(1e-9);
  const bool has_cells = lu.dimensionOfKernel() > 0;
  const MatrixXd Z = has_cells ? MatrixXd(lu.kernel()) : MatrixXd::Zero(n, 0);
  VectorXd length_over_t(n);
  for (int i = 0; i < n; ++i) {
    const Wall& w = walls[static_cast<std::size_t>(i)];
    length_over_t[i] = (w.b - w.a).norm() / w.t;
  }
  const MatrixXd cells = Z.transpose() * length_over_t.asDiagonal() * Z;

  // Flow along wall i: q0_i + g_i(s), g_i = -∫ t dσ/dx ds, with dσ/dx = z α - y β.
  const double det = I1 * I2 - I12 * I12;
  const auto solve_shear = [&](double Vy, double Vz, double* energy) {
    const double alpha = (I1 * Vz - I12 * Vy) / det, beta = (I12 * Vz - I2 * Vy) / det;
    const auto calc_g = [&](const Wall& w, double s) {  // s in 0..1
      const Vector2d mean = w.a + 0.5 * s * (w.b - w.a) - c;
      return -w.t * s * (w.b - w.a).norm() * (mean[1] * alpha - mean[0] * beta);
    };
    VectorXd g_end(n), g_energy(n);  // ∫ g/t ds
    for (int i = 0; i < n; ++i) {
      const Wall& w = walls[static_cast<std::size_t>(i)];
      g_end[i] = calc_g(w, 1);
      g_energy[i] = 0;
      for (const GaussPoint& p : get_gauss_points(3)) g_energy[i] += p.weight * length_over_t[i] * calc_g(w, p.x);
    }
    // Shear flow balances at each node: B q0 + (end part of B) g_end = 0.
    VectorXd q0 = lu.solve(-B.cwiseMax(0) * g_end);
    if (has_cells) q0 -= Z * cells.ldlt().solve(Z.transpose() * (length_over_t.cwiseProduct(q0) + g_energy));
    double torque = 0;
    *energy = 0;
    for (int i = 0; i < n; ++i) {
      const Wall& w = walls[static_cast<std::size_t>(i)];
      for (const GaussPoint& p : get_gauss_points(3)) {
        const double q = q0[i] + calc_g(w, p.x);
        torque += p.weight * q * cross(w.a, w.b);
        *energy += p.weight * length_over_t[i] * q * q;
      }
    }
    return torque;
  };
  ThinWallResult result;
  double energy_1 = 0, energy_2 = 0;
  const double torque_1 = solve_shear(1, 0, &energy_1), torque_2 = solve_shear(0, 1, &energy_2);
  result.shear_center = Vector2d(torque_2, -torque_1);
  result.shear_area_1 = 1 / energy_1;
  result.shear_area_2 = 1 / energy_2;
  if (has_cells) {
    VectorXd swept(n);
    for (int i = 0; i < n; ++i)
      swept[i] = cross(walls[static_cast<std::size_t>(i)].a, walls[static_cast<std::size_t>(i)].b);
    const VectorXd h = Z.transpose() * swept;
    result.J = h.dot(cells.ldlt().solve(h));
  }
  for (int i = 0; i < n; ++i) {
    const Wall& w = walls[static_cast<std::size_t>(i)];
    if (!has_cells || Z.row(i).cwiseAbs().maxCoeff() < 1e-9) result.J += (w.b - w.a).norm() * w.t * w.t * w.t / 3;
  }
  return result;
}

}  // namespace bough::fe
