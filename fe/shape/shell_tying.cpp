#include "fe/shape/shell_tying.hpp"

#include <array>
#include <cmath>

#include "base/diagnostic.hpp"
#include "fe/shape/surface_shape.hpp"

namespace bough::fe {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Vector8d = Eigen::Matrix<double, 8, 1>;

const double kG2 = 1 / std::sqrt(3.0), kG3 = std::sqrt(0.6);

/// Lagrange polynomials over `nodes` at x.
template <std::size_t N>
std::array<double, N> calc_lagrange(double x, const std::array<double, N>& nodes) {
  std::array<double, N> h;
  h.fill(1);
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < N; ++j)
      if (i != j) h[i] *= (x - nodes[j]) / (nodes[i] - nodes[j]);
  return h;
}

class Builder {
 public:
  explicit Builder(int num_corners) {
    t_.num_corners = num_corners;
    t_.num_nodes = 2 * num_corners;
    t_.node_natural.resize(t_.num_nodes, 2);
    if (num_corners == 4)
      t_.node_natural << -1, -1, 1, -1, 1, 1, -1, 1, 0, -1, 1, 0, 0, 1, -1, 0;
    else
      t_.node_natural << 0, 0, 1, 0, 0, 1, 0.5, 0, 0.5, 0.5, 0, 0.5;
  }

  ShellTying build() {
    t_.num_corners == 4 ? build_quad() : build_tri();
    return std::move(t_);
  }

 private:
  int find_sample(double r, double s) {
    for (std::size_t k = 0; k < t_.samples.size(); ++k)
      if ((t_.samples[k].natural - Vector2d(r, s)).norm() < 1e-12) return static_cast<int>(k);
    const int n = t_.num_nodes;
    const auto shapes =
        calc_surface_shapes(t_.num_corners, std::vector<char>(static_cast<std::size_t>(t_.num_corners), 1), r, s);
    ShellSample sample{{r, s}, Eigen::VectorXd(n + 1), Eigen::Matrix2Xd(2, n + 1)};
    sample.shape.head(n) = shapes.all;
    sample.dshape.leftCols(n) = shapes.dall;
    if (t_.num_corners == 4) {
      sample.shape[n] = (1 - r * r) * (1 - s * s);
      sample.dshape.col(n) << -2 * r * (1 - s * s), -2 * s * (1 - r * r);
    } else {
      const double l = 1 - r - s;
      sample.shape[n] = 27 * l * r * s;
      sample.dshape.col(n) << 27 * s * (l - r), 27 * r * (l - s);
    }
    t_.samples.push_back(std::move(sample));
    return static_cast<int>(t_.samples.size()) - 1;
  }

  Matrix3d& membrane(ShellPoint& p, double r, double s) {
    const int k = find_sample(r, s);
    for (auto& tie : p.membrane)
      if (tie.sample == k) return tie.weight;
    p.membrane.push_back({k, Matrix3d::Zero()});
    return p.membrane.back().weight;
  }
  Matrix2d& shear(ShellPoint& p, double r, double s) {
    const int k = find_sample(r, s);
    for (auto& tie : p.shear)
      if (tie.sample == k) return tie.weight;
    p.shear.push_back({k, Matrix2d::Zero()});
    return p.shear.back().weight;
  }

  void build_quad() {
    const std::array<double, 2> two{-kG2, kG2};
    const std::array<double, 3> three{-kG3, 0, kG3}, weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const double r = three[i], s = three[j];
        ShellPoint p{find_sample(r, s), weight[i] * weight[j], {}, {}};
        const auto r2 = calc_lagrange(r, two), s2 = calc_lagrange(s, two);
        const auto r3 = calc_lagrange(r, three), s3 = calc_lagrange(s, three);
        for (std::size_t a = 0; a < 2; ++a) {
          for (std::size_t b = 0; b < 3; ++b) {
            membrane(p, two[a], three[b])(0, 0) += r2[a] * s3[b];
            membrane(p, three[b], two[a])(1, 1) += s2[a] * r3[b];
          }
          for (std::size_t b = 0; b < 2; ++b) {
            membrane(p, two[a], two[b])(2, 2) += r2[a] * s2[b];
            // Linear between the sides, and 1.5 (1 - s²) times (the mean over the element - the mean of the sides).
            const double end = b == 0 ? -1 : 1;
            shear(p, two[a], end)(0, 0) += r2[a] * (1 + end * s) / 2 - 0.375 * (1 - s * s);
            shear(p, end, two[a])(1, 1) += s2[a] * (1 + end * r) / 2 - 0.375 * (1 - r * r);
            shear(p, two[a], two[b])(0, 0) += 0.375 * (1 - s * s);
            shear(p, two[a], two[b])(1, 1) += 0.375 * (1 - r * r);
          }
        }
        t_.points.push_back(std::move(p));
      }
  }

  /// γ_r (component 0) or γ_s (1) of the triangle's shear field per its eight coefficients.
  static Vector8d calc_row(int component, double r, double s) {
    Vector8d row = Vector8d::Zero();
    if (component == 0)
      row << 1, r, s, 0, 0, 0, r * s, s * s;
    else
      row << 0, 0, 0, 1, r, s, -r * r, -r * s;
    return row;
  }

  void build_tri() {
    const double a = 0.5 - kG2 / 2, b = 0.5 + kG2 / 2, c = kG2;
    // Tying points of the strain along sides 1-2, 1-3 and 2-3.
    const Vector2d tie[3][3] = {{{a, 0}, {b, 0}, {a, c}}, {{0, a}, {0, b}, {c, a}}, {{b, a}, {a, b}, {a, a}}};
    Matrix3d from[3];  // coefficients of 1, r, s per sample
    for (int k = 0; k < 3; ++k) {
      Matrix3d at;
      for (int i = 0; i < 3; ++i) at.row(i) << 1, tie[k][i].x(), tie[k][i].y();
      from[k] = at.inverse();
    }
    // Conditions of the shear field: tangential values on the sides, means of the interior points.
    const Vector2d inner[3] = {{1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6}, {1.0 / 6, 2.0 / 3}};
    Eigen::Matrix<double, 8, 8> conditions;
    conditions.setZero();
    int row = 0;
    for (double p : {a, b}) {
      conditions.row(row++) = calc_row(0, p, 0);
      conditions.row(row++) = calc_row(1, 0, p);
      conditions.row(row++) = calc_row(1, p, 1 - p) - calc_row(0, p, 1 - p);
    }
    for (int k : {0, 1}) {
      for (const auto& x : inner) conditions.row(row) += calc_row(k, x.x(), x.y()) / 3;
      ++row;
    }
    const Eigen::Matrix<double, 8, 8> solve = conditions.inverse();

    const double ra = 0.445948490915965, rb = 0.091576213509771;
    const double wa = 0.223381589678011 / 2, wb = 0.109951743655322 / 2;
    const std::array<Vector3d, 6> rule{Vector3d(ra, ra, wa), {1 - 2 * ra, ra, wa}, {ra, 1 - 2 * ra, wa},
                                       Vector3d(rb, rb, wb), {1 - 2 * rb, rb, wb}, {rb, 1 - 2 * rb, wb}};
    for (const auto& at : rule) {
      const double r = at.x(), s = at.y();
      ShellPoint p{find_sample(r, s), at.z(), {}, {}};
      for (int i = 0; i < 3; ++i) {
        const Vector3d h(1, r, s);
        Matrix3d& along_r = membrane(p, tie[0][i].x(), tie[0][i].y());
        along_r(0, 0) += h.dot(from[0].col(i));
        along_r(2, 0) += h.dot(from[0].col(i));
        Matrix3d& along_s = membrane(p, tie[1][i].x(), tie[1][i].y());
        along_s(1, 1) += h.dot(from[1].col(i));
        along_s(2, 1) += h.dot(from[1].col(i));
        // 2 rs = rr + ss - (along side 2-3), and that is rr + ss - 2 rs at its own points.
        membrane(p, tie[2][i].x(), tie[2][i].y()).row(2) += h.dot(from[2].col(i)) * Vector3d(-1, -1, 1).transpose();
      }
      for (int k : {0, 1}) {
        const Vector8d w = solve.transpose() * calc_row(k, r, s);
        row = 0;
        for (double g : {a, b}) {
          shear(p, g, 0)(k, 0) += w[row++];
          shear(p, 0, g)(k, 1) += w[row++];
          Matrix2d& side = shear(p, g, 1 - g);
          side(k, 1) += w[row];
          side(k, 0) -= w[row++];
        }
        for (int m : {0, 1}) {
          for (const auto& x : inner) shear(p, x.x(), x.y())(k, m) += w[row] / 3;
          ++row;
        }
      }
      t_.points.push_back(std::move(p));
    }
  }

  ShellTying t_;
};

}  // namespace

const ShellTying& get_shell_tying(int num_corners) {
  BOUGH_DEMAND(num_corners == 3 || num_corners == 4);
  static const ShellTying quad = Builder(4).build(), tri = Builder(3).build();
  return num_corners == 4 ? quad : tri;
}

}  // namespace bough::fe
