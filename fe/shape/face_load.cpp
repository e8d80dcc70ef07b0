#include "bough/fe/shape/face_load.hpp"

#include "bough/base/diagnostic.hpp"
#include "bough/fe/shape/gauss.hpp"

namespace bough::fe {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

/// Shape functions and their derivatives by (r, s) at one point.
struct Shapes {
  VectorXd corner, all;
  Eigen::Matrix2Xd dall;
};

/// A product of two linear functions with its gradient.
struct Term {
  double value;
  Vector2d gradient;
  friend Term operator*(const Term& a, const Term& b) {
    return {a.value * b.value, a.value * b.gradient + b.value * a.gradient};
  }
};

/// Corner k of the square [-1, 1]² or of the triangle r, s ≥ 0, r + s ≤ 1.
Term calc_corner(int num_corners, int k, double r, double s) {
  if (num_corners == 3) {
    if (k == 0) return {1 - r - s, {-1, -1}};
    return k == 1 ? Term{r, {1, 0}} : Term{s, {0, 1}};
  }
  const double a = k == 1 || k == 2 ? 1 : -1, b = k >= 2 ? 1 : -1;
  return Term{0.5 * (1 + a * r), {0.5 * a, 0}} * Term{0.5 * (1 + b * s), {0, 0.5 * b}};
}

/// One at the middle of edge k -> k+1, zero at the corners and on the other edges.
Term calc_bump(int num_corners, int k, double r, double s) {
  if (num_corners == 3) {
    const Term t = calc_corner(3, k, r, s) * calc_corner(3, (k + 1) % 3, r, s);
    return {4 * t.value, 4 * t.gradient};
  }
  const double b = k == 0 ? -1 : 1, a = k == 3 ? -1 : 1;
  if (k == 0 || k == 2) return Term{1 - r * r, {-2 * r, 0}} * Term{0.5 * (1 + b * s), {0, 0.5 * b}};
  return Term{0.5 * (1 + a * r), {0.5 * a, 0}} * Term{1 - s * s, {0, -2 * s}};
}

Shapes calc_shapes(int n, const std::vector<char>& has_midside, double r, double s) {
  int count = n;
  for (char present : has_midside) count += present ? 1 : 0;
  Shapes result{VectorXd(n), VectorXd(count), Eigen::Matrix2Xd(2, count)};
  for (int k = 0; k < n; ++k) {
    const Term t = calc_corner(n, k, r, s);
    result.corner[k] = result.all[k] = t.value;
    result.dall.col(k) = t.gradient;
  }
  int next = n;
  for (int k = 0; k < static_cast<int>(has_midside.size()); ++k) {
    if (!has_midside[static_cast<std::size_t>(k)]) continue;
    const Term t = calc_bump(n, k, r, s);
    result.all[next] = t.value;
    result.dall.col(next++) = t.gradient;
    for (const int c : {k, (k + 1) % n}) {
      result.all[c] -= 0.5 * t.value;
      result.dall.col(c) -= 0.5 * t.gradient;
    }
  }
  return result;
}

}  // namespace

Eigen::Matrix3Xd calc_face_load(const std::vector<Eigen::Vector3d>& corners,
                                const std::vector<Eigen::Vector3d>& midside, const std::vector<char>& has_midside,
                                const std::vector<double>& p, const Traction& traction) {
  const int n = static_cast<int>(corners.size());
  BOUGH_DEMAND((n == 3 || n == 4) && p.size() == corners.size() && midside.size() == has_midside.size());
  std::vector<Eigen::Vector3d> x = corners;
  for (std::size_t k = 0; k < midside.size(); ++k)
    if (has_midside[k]) x.push_back(midside[k]);
  Eigen::Matrix3Xd F = Eigen::Matrix3Xd::Zero(3, static_cast<int>(x.size()));
  // The integrand of a serendipity face is of degree 8 in a direction: five points are exact.
  const auto points = get_gauss_points(x.size() == corners.size() ? 3 : 5);
  for (const auto& a : points)
    for (const auto& b : points) {
      // The triangle is the square with one side drawn to a point.
      const double r = n == 4 ? 2 * a.x - 1 : a.x, s = n == 4 ? 2 * b.x - 1 : b.x * (1 - a.x);
      const double weight = a.weight * b.weight * (n == 4 ? 4 : 1 - a.x);
      const Shapes shapes = calc_shapes(n, has_midside, r, s);
      Eigen::Vector3d at = Eigen::Vector3d::Zero(), dr = at, ds = at;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto c = static_cast<Eigen::Index>(i);
        at += shapes.all[c] * x[i];
        dr += shapes.dall(0, c) * x[i];
        ds += shapes.dall(1, c) * x[i];
      }
      double intensity = 0;
      for (int k = 0; k < n; ++k) intensity += shapes.corner[k] * p[static_cast<std::size_t>(k)];
      const Eigen::Vector3d area = dr.cross(ds);
      const double size = area.norm();
      if (size == 0) continue;
      const Eigen::Vector3d t = weight * size * traction(intensity, at, area / size);
      F += t * shapes.all.transpose();
    }
  return F;
}

}  // namespace bough::fe
