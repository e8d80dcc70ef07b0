#include "fe/shape/surface_shape.hpp"

namespace bough::fe {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

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

/// One at the third of edge a -> b next to a, zero at the other grids of the edges of the square: (9/16) (1 - t²)
/// (1 + 3 t_a t) (1 + s_a s) / 2 with t along the edge.
Term calc_cubic_bump(int a, int b, double r, double s) {
  const auto sign_r = [](int k) { return k == 1 || k == 2 ? 1. : -1.; };
  const auto sign_s = [](int k) { return k >= 2 ? 1. : -1.; };
  const bool is_along_r = sign_r(a) != sign_r(b);
  const double t = is_along_r ? r : s, at = is_along_r ? sign_r(a) : sign_s(a);
  const double across = is_along_r ? s : r, side = is_along_r ? sign_s(a) : sign_r(a);
  const Vector2d along = is_along_r ? Vector2d(1, 0) : Vector2d(0, 1);
  return Term{9. / 16 * (1 - t * t), 9. / 16 * -2 * t * along} * Term{1 + 3 * at * t, 3 * at * along} *
         Term{0.5 * (1 + side * across), 0.5 * side * (Vector2d(1, 1) - along)};
}

}  // namespace

SurfaceShapes calc_surface_shapes(int n, const std::vector<char>& has_midside, double r, double s) {
  int count = n;
  for (char present : has_midside) count += present ? 1 : 0;
  SurfaceShapes result{VectorXd(n), VectorXd(count), Eigen::Matrix2Xd(2, count)};
  for (int k = 0; k < n; ++k) {
    const Term t = calc_corner(n, k, r, s);
    result.corner[k] = result.all[k] = t.value;
    result.dall.col(k) = t.gradient;
  }
  int next = n;
  if (n == 4 && has_midside.size() == 8) {
    for (int k = 0; k < 4; ++k)
      for (const bool is_near : {true, false}) {
        const int near = is_near ? k : (k + 1) % 4, far = is_near ? (k + 1) % 4 : k;
        const Term t = calc_cubic_bump(near, far, r, s);
        result.all[next] = t.value;
        result.dall.col(next++) = t.gradient;
        // Linear functions have 2/3 and 1/3 there.
        result.all[near] -= 2. / 3 * t.value;
        result.dall.col(near) -= 2. / 3 * t.gradient;
        result.all[far] -= 1. / 3 * t.value;
        result.dall.col(far) -= 1. / 3 * t.gradient;
      }
    return result;
  }
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

}  // namespace bough::fe
