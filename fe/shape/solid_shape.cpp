#include "fe/shape/solid_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace bough::fe {

namespace {

constexpr double kHexaCorner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                      {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

const std::vector<std::pair<int, int>> kHexaEdges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5},
                                                     {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};
const std::vector<std::pair<int, int>> kPentaEdges = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 4},
                                                      {2, 5}, {3, 4}, {4, 5}, {5, 3}};
const std::vector<std::pair<int, int>> kPyramidEdges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};
/// The functions have no gradient at the apex: there it is that of a point next to it on the axis.
constexpr double kNextToApex = 1e-9;
const std::vector<std::pair<int, int>> kTetraEdges = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

/// A value with its gradient: products of these give every bump and its derivative.
struct Term {
  double value = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  friend Term operator*(const Term& a, const Term& b) {
    return {a.value * b.value, a.value * b.gradient + b.value * a.gradient};
  }
  friend Term operator*(double s, const Term& a) { return {s * a.value, s * a.gradient}; }
};

Term linear(double constant, double a, double b, double c, const Eigen::Vector3d& at) {
  const Eigen::Vector3d g(a, b, c);
  return {constant + g.dot(at), g};
}

struct Gauss {
  std::vector<double> x, w;
};
Gauss get_gauss(int n) {
  if (n == 2) return {{-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}, {1, 1}};
  if (n == 3) return {{-std::sqrt(0.6), 0, std::sqrt(0.6)}, {5.0 / 9, 8.0 / 9, 5.0 / 9}};
  const double a = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2)), b = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2));
  const double wa = (18 + std::sqrt(30.0)) / 36, wb = (18 - std::sqrt(30.0)) / 36;
  return {{-b, -a, a, b}, {wb, wa, wa, wb}};
}

}  // namespace

int get_num_corners(SolidKind kind) {
  switch (kind) {
    case SolidKind::Hexa:
      return 8;
    case SolidKind::Penta:
      return 6;
    case SolidKind::Tetra:
      return 4;
    case SolidKind::Pyramid:
      return 5;
  }
  return 0;
}

const std::vector<std::pair<int, int>>& get_edges(SolidKind kind) {
  if (kind == SolidKind::Pyramid) return kPyramidEdges;
  return kind == SolidKind::Hexa ? kHexaEdges : kind == SolidKind::Penta ? kPentaEdges : kTetraEdges;
}

std::vector<Eigen::Vector3d> list_nodes(SolidKind kind, const std::vector<int>& midside) {
  std::vector<Eigen::Vector3d> nodes;
  for (int i = 0; i < get_num_corners(kind); ++i) {
    if (kind == SolidKind::Hexa)
      nodes.emplace_back(kHexaCorner[i][0], kHexaCorner[i][1], kHexaCorner[i][2]);
    else if (kind == SolidKind::Penta)
      nodes.emplace_back(i % 3 == 1, i % 3 == 2, i < 3 ? -1 : 1);
    else if (kind == SolidKind::Pyramid)
      nodes.emplace_back(i < 4 ? kHexaCorner[i][0] : 0, i < 4 ? kHexaCorner[i][1] : 0, i < 4 ? 0 : 1);
    else
      nodes.emplace_back(i == 1, i == 2, i == 3);
  }
  const auto set = [&](int node, const Eigen::Vector3d& at) {
    if (node < 0) return;
    if (nodes.size() <= static_cast<std::size_t>(node)) nodes.resize(static_cast<std::size_t>(node) + 1);
    nodes[static_cast<std::size_t>(node)] = at;
  };
  const auto& edges = get_edges(kind);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Eigen::Vector3d a = nodes[static_cast<std::size_t>(edges[e].first)],
                          b = nodes[static_cast<std::size_t>(edges[e].second)];
    if (is_cubic(midside)) {
      set(midside[2 * e], (2 * a + b) / 3);
      set(midside[2 * e + 1], (a + 2 * b) / 3);
    } else if (e < midside.size()) {
      set(midside[e], (a + b) / 2);
    }
  }
  return nodes;
}

namespace {

/// Bedrosian's pyramid: corners, and bumps of the midside nodes.
class Pyramid {
 public:
  explicit Pyramid(Eigen::Vector3d at) {
    at.z() = std::min(at.z(), 1 - kNextToApex);
    const double rest = 1 - at.z();
    inverse_ = {1 / rest, Eigen::Vector3d(0, 0, 1 / (rest * rest))};
    zeta_ = linear(0, 0, 0, 1, at);
    for (int a = 0; a < 2; ++a)
      for (const int sign : {-1, 1}) side_[a][sign > 0] = linear(1, a == 0 ? sign : 0, a == 1 ? sign : 0, -1, at);
  }
  Term corner(int i) const {
    if (i == 4) return zeta_;
    return 0.25 * (get(0, kHexaCorner[i][0]) * get(1, kHexaCorner[i][1]) * inverse_);
  }
  /// 1 at the middle of edge (i, j), zero at every other node.
  Term bump(int i, int j) const {
    if (j == 4) return zeta_ * get(0, kHexaCorner[i][0]) * get(1, kHexaCorner[i][1]) * inverse_;
    const int along = kHexaCorner[i][0] == kHexaCorner[j][0] ? 1 : 0;
    return 0.5 * (get(along, -1) * get(along, 1) * get(1 - along, kHexaCorner[i][1 - along]) * inverse_);
  }

 private:
  /// 1 - ζ ± ξ or ± η.
  const Term& get(int axis, double sign) const { return side_[axis][sign > 0]; }
  Term inverse_, zeta_, side_[2][2];
};

}  // namespace

void calc_solid_shape(SolidKind kind, const std::vector<int>& midside, const Eigen::Vector3d& natural,
                      Eigen::VectorXd& shape, Eigen::Matrix3Xd& dshape) {
  const int corners = get_num_corners(kind);
  const auto& edges = get_edges(kind);
  const Term L[4] = {linear(1, -1, -1, kind == SolidKind::Tetra ? -1 : 0, natural), linear(0, 1, 0, 0, natural),
                     linear(0, 0, 1, 0, natural), linear(0, 0, 0, 1, natural)};
  const auto pyramid = kind == SolidKind::Pyramid ? std::optional<Pyramid>(natural) : std::nullopt;
  const Term below = linear(0.5, 0, 0, -0.5, natural), above = linear(0.5, 0, 0, 0.5, natural);
  auto factor = [&](int axis, double sign) {
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    g[axis] = 0.5 * sign;
    return linear(0.5, g[0], g[1], g[2], natural);
  };
  auto set = [&](int node, const Term& t) {
    shape[node] = t.value;
    dshape.col(node) = t.gradient;
  };
  auto corner = [&](int i) -> Term {
    if (kind == SolidKind::Tetra) return L[i];
    if (kind == SolidKind::Penta) return L[i % 3] * (i < 3 ? below : above);
    if (kind == SolidKind::Pyramid) return pyramid->corner(i);
    return factor(0, kHexaCorner[i][0]) * factor(1, kHexaCorner[i][1]) * factor(2, kHexaCorner[i][2]);
  };
  // One at the middle of edge (i, j), zero at every other node.
  auto bump = [&](int i, int j) -> Term {
    if (kind == SolidKind::Tetra) return 4 * (L[i] * L[j]);
    if (kind == SolidKind::Pyramid) return pyramid->bump(i, j);
    if (kind == SolidKind::Penta) {
      if (j == i + 3) return 4 * (L[i] * (below * above));
      return 4 * (L[i % 3] * L[j % 3] * (i < 3 ? below : above));
    }
    Term t{1, Eigen::Vector3d::Zero()};
    for (int a = 0; a < 3; ++a) {
      const double ci = kHexaCorner[i][a], cj = kHexaCorner[j][a];
      t = t * (ci == cj ? factor(a, ci) : 4 * (factor(a, -1) * factor(a, 1)));
    }
    return t;
  };
  for (int i = 0; i < corners; ++i) set(i, corner(i));
  if (is_cubic(midside)) {
    // Bumps at a third and two thirds of an edge from i to j; what is linear has 2/3 and 1/3 there.
    const auto cubic_bump = [&](int i, int j) -> Term {
      Term t{1, Eigen::Vector3d::Zero()};
      for (int a = 0; a < 3; ++a) {
        const double ci = kHexaCorner[i][a], cj = kHexaCorner[j][a];
        if (ci == cj) {
          t = t * factor(a, ci);
          continue;
        }
        Eigen::Vector3d g = Eigen::Vector3d::Zero();
        g[a] = 3 * ci;  // 1 at the third next to i, and 1 + 3 ξ_i ξ is 2 there
        t = t * ((9.0 / 16) * (4 * (factor(a, -1) * factor(a, 1)) * linear(1, g[0], g[1], g[2], natural)));
      }
      return t;
    };
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (const bool is_near_first : {true, false}) {
        const auto [first, second] = edges[e];
        const int near = is_near_first ? first : second, far = is_near_first ? second : first;
        const int node = midside[2 * e + (is_near_first ? 0 : 1)];
        const Term t = cubic_bump(near, far);
        set(node, t);
        shape[near] -= 2.0 / 3 * t.value;
        dshape.col(near) -= 2.0 / 3 * t.gradient;
        shape[far] -= 1.0 / 3 * t.value;
        dshape.col(far) -= 1.0 / 3 * t.gradient;
      }
    return;
  }
  for (std::size_t e = 0; e < midside.size(); ++e) {
    if (midside[e] < 0) continue;
    const Term t = bump(edges[e].first, edges[e].second);
    set(midside[e], t);
    for (int c : {edges[e].first, edges[e].second}) {
      shape[c] -= 0.5 * t.value;
      dshape.col(c) -= 0.5 * t.gradient;
    }
  }
}

std::vector<SolidPoint> calc_solid_points(SolidKind kind, bool quadratic, bool mass, int order) {
  std::vector<SolidPoint> points;
  const int along = !mass && order > 0 ? order : quadratic ? 3 : 2;
  if (kind == SolidKind::Hexa) {
    const Gauss g = get_gauss(along);
    for (std::size_t i = 0; i < g.x.size(); ++i)
      for (std::size_t j = 0; j < g.x.size(); ++j)
        for (std::size_t k = 0; k < g.x.size(); ++k)
          points.push_back({{g.x[i], g.x[j], g.x[k]}, g.w[i] * g.w[j] * g.w[k]});
    return points;
  }
  if (kind == SolidKind::Pyramid) {
    // ξ = (1 - ζ) r, η = (1 - ζ) s: polynomials in r, s and ζ for a straight pyramid over a parallelogram, and exact.
    const Gauss across = get_gauss(quadratic || mass ? 3 : 2), z = get_gauss(quadratic && mass   ? 4
                                                                             : quadratic || mass ? 3
                                                                                                 : 2);
    for (std::size_t k = 0; k < z.x.size(); ++k) {
      const double zeta = 0.5 * (1 + z.x[k]), rest = 1 - zeta;
      for (std::size_t i = 0; i < across.x.size(); ++i)
        for (std::size_t j = 0; j < across.x.size(); ++j)
          points.push_back(
              {{rest * across.x[i], rest * across.x[j], zeta}, 0.5 * z.w[k] * across.w[i] * across.w[j] * rest * rest});
    }
    return points;
  }
  if (kind == SolidKind::Tetra && !mass) {
    if (!quadratic) return {{{0.25, 0.25, 0.25}, 1.0 / 6}};
    const double a = (5 - std::sqrt(5.0)) / 20, b = 1 - 3 * a;
    for (const auto& p :
         {Eigen::Vector3d(a, a, a), Eigen::Vector3d(b, a, a), Eigen::Vector3d(a, b, a), Eigen::Vector3d(a, a, b)})
      points.push_back({p, 1.0 / 24});
    return points;
  }
  if (kind == SolidKind::Penta && !mass && order == 2) {
    const Gauss z = get_gauss(2);
    for (int t = 0; t < 3; ++t)
      for (std::size_t k = 0; k < z.x.size(); ++k)
        points.push_back({{t == 1 ? 2.0 / 3 : 1.0 / 6, t == 2 ? 2.0 / 3 : 1.0 / 6, z.x[k]}, z.w[k] / 6});
    return points;
  }
  if (kind == SolidKind::Penta && !mass && quadratic) {
    // Seven points of the triangle, exact to degree five (Radon 1948; Hammer, Marlowe & Stroud, MTAC 10 (1956) 130) and
    // the same from each corner, so a curved wedge does not depend on where its count begins.
    const Gauss z = get_gauss(along);
    const double root = std::sqrt(15.0), a = (6 - root) / 21, b = (6 + root) / 21;
    const auto add = [&](double r, double s, double weight) {
      for (std::size_t k = 0; k < z.x.size(); ++k) points.push_back({{r, s, z.x[k]}, weight * z.w[k]});
    };
    add(1.0 / 3, 1.0 / 3, 9.0 / 80);
    for (const auto& [c, weight] : {std::pair{a, (155 - root) / 2400}, std::pair{b, (155 + root) / 2400}}) {
      add(c, c, weight);
      add(1 - 2 * c, c, weight);
      add(c, 1 - 2 * c, weight);
    }
    return points;
  }
  // Products of Gauss rules on the collapsed square or cube (Stroud): exact to degree 2n-3 or better.
  const Gauss g = get_gauss(mass && quadratic ? 4 : 3);
  auto half = [](double x) { return 0.5 * (1 + x); };
  for (std::size_t i = 0; i < g.x.size(); ++i)
    for (std::size_t j = 0; j < g.x.size(); ++j) {
      const double r = half(g.x[i]), s = half(g.x[j]) * (1 - r), w = 0.25 * g.w[i] * g.w[j] * (1 - r);
      if (kind == SolidKind::Penta) {
        const Gauss z = get_gauss(along);
        for (std::size_t k = 0; k < z.x.size(); ++k) points.push_back({{r, s, z.x[k]}, w * z.w[k]});
      } else {
        for (std::size_t k = 0; k < g.x.size(); ++k)
          points.push_back({{r, s, half(g.x[k]) * (1 - r - s)}, 0.5 * w * g.w[k] * (1 - r - s)});
      }
    }
  return points;
}

}  // namespace bough::fe
