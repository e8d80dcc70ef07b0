#include <Eigen/Cholesky>
#include <cmath>

#include "fe/elements/shell_fields.hpp"

namespace bough::fe::shell {
namespace {

// Sides in the direction of growing ξ or η (quadrilateral) or around (triangle).
template <int N>
constexpr auto kSides = [] {
  if constexpr (N == 4)
    return std::array<std::array<int, 2>, 4>{{{0, 1}, {1, 2}, {3, 2}, {0, 3}}};
  else
    return std::array<std::array<int, 2>, 3>{{{0, 1}, {1, 2}, {2, 0}}};
}();

template <int N>
Point<N> calc_point(const Corners<N>& xy, double r, double s, double quadrature) {
  Point<N> p;
  p.r = r, p.s = s;
  Eigen::Matrix<double, 2, N> d;
  if constexpr (N == 4) {
    p.shape << (1 - r) * (1 - s) / 4, (1 + r) * (1 - s) / 4, (1 + r) * (1 + s) / 4, (1 - r) * (1 + s) / 4;
    d << -(1 - s) / 4, (1 - s) / 4, (1 + s) / 4, -(1 + s) / 4, -(1 - r) / 4, -(1 + r) / 4, (1 + r) / 4, (1 - r) / 4;
  } else {
    p.shape << 1 - r - s, r, s;
    d << -1, 1, 0, -1, 0, 1;
  }
  const Eigen::Matrix2d J = d * xy.transpose();  // rows: d(x,y)/dr, d(x,y)/ds
  p.J = J.determinant();
  p.J_inv = J.inverse();
  p.dshape = p.J_inv * d;
  p.weight = quadrature * p.J;
  return p;
}

/// Side functions P_k (0 at the corners, 1 or its linear fade at the middle of side k) and their slopes by x, y.
template <int N>
void calc_bumps(const Point<N>& p, Eigen::Matrix<double, N, 1>& bump, Eigen::Matrix<double, 2, N>& dbump) {
  const double r = p.r, s = p.s;
  Eigen::Matrix<double, 2, N> d;
  if constexpr (N == 4) {
    bump << (1 - r * r) * (1 - s) / 2, (1 + r) * (1 - s * s) / 2, (1 - r * r) * (1 + s) / 2, (1 - r) * (1 - s * s) / 2;
    d << -r * (1 - s), (1 - s * s) / 2, -r * (1 + s), -(1 - s * s) / 2, -(1 - r * r) / 2, -s * (1 + r), (1 - r * r) / 2,
        -s * (1 - r);
  } else {
    const double l = 1 - r - s;
    bump << 4 * l * r, 4 * r * s, 4 * s * l;
    d << 4 * (l - r), 4 * s, -4 * s, -4 * r, 4 * r, 4 * (l - s);
  }
  dbump = p.J_inv * d;
}

/// Column k: the vector that a unit component along side k gives at the point (the other sides zero).
template <int N>
Eigen::Matrix<double, 2, N> calc_side_vectors(const Plate<N>& plate, const Point<N>& p) {
  Eigen::Matrix<double, 2, N> columns = Eigen::Matrix<double, 2, N>::Zero();
  if constexpr (N == 4) {
    // Covariant components, linear between opposite sides.
    const double end[4] = {(1 - p.s) / 2, (1 + p.r) / 2, (1 + p.s) / 2, (1 - p.r) / 2};
    for (int k = 0; k < 4; ++k) columns.col(k) = p.J_inv.col(k % 2) * (end[k] * 0.5 * plate.sides[k].length);
  } else {
    // Each corner sees its two sides; linear in between (Katili, Part I, eqs. 21-23).
    for (int i = 0; i < 3; ++i) {
      const int ka = i, kb = (i + 2) % 3;
      Eigen::Matrix2d t;
      t << plate.sides[ka].t.transpose(), plate.sides[kb].t.transpose();
      const Eigen::Matrix2d inverse = p.shape[i] * t.inverse();
      columns.col(ka) += inverse.col(0);
      columns.col(kb) += inverse.col(1);
    }
  }
  return columns;
}

}  // namespace

Eigen::Matrix3d calc_stretch_of_curvature(const ShellSection& section) {
  const Eigen::LLT<Eigen::Matrix3d> A(section.A);
  if (section.B.isZero(0) || A.info() != Eigen::Success) return Eigen::Matrix3d::Zero();
  return -A.solve(section.B);
}

template <int N>
Points<N> calc_points(const Corners<N>& xy) {
  Points<N> points;
  const double g = 1 / std::sqrt(3.0);
  for (int q = 0; q < N; ++q)
    points[q] = N == 4 ? calc_point<N>(xy, q == 0 || q == 3 ? -g : g, q < 2 ? -g : g, 1)
                       : calc_point<N>(xy, q == 1 ? 2.0 / 3 : 1.0 / 6, q == 2 ? 2.0 / 3 : 1.0 / 6, 1.0 / 6);
  return points;
}

template <int N>
Point<N> calc_centre(const Corners<N>& xy) {
  return N == 4 ? calc_point<N>(xy, 0, 0, 4) : calc_point<N>(xy, 1.0 / 3, 1.0 / 3, 0.5);
}

template <int N>
Plate<N> calc_plate(const Corners<N>& xy, const Points<N>& points, const ShellSection& section) {
  Plate<N> plate;
  double side_force[N];  // Q_s per mean
  const Eigen::Matrix3d law = section.D + section.B.transpose() * calc_stretch_of_curvature(section);
  for (int k = 0; k < N; ++k) {
    auto& side = plate.sides[k];
    side.i = kSides<N>[k][0], side.j = kSides<N>[k][1];
    const Eigen::Vector2d d = xy.col(side.j) - xy.col(side.i);
    side.length = d.norm();
    side.t = d / side.length;
    const double L = side.length, cs = side.t.x(), sn = side.t.y();
    // Bending and shear stiffness along the side (Katili, Part I, eq. 16 for an isotropic plate).
    const Eigen::Vector3d e(cs * cs, sn * sn, 2 * cs * sn);
    const double rigid_force = 12 * e.dot(law * e) / (L * L);
    side.phi = section.shear_flexible ? rigid_force / side.t.dot(section.S * side.t) : 0;
    side_force[k] = rigid_force;
    side.mean.setZero();
    side.mean[3 * side.i] = -1 / L;
    side.mean[3 * side.j] = 1 / L;
    for (int m : {side.i, side.j}) {
      side.mean[3 * m + 1] = -0.5 * sn;  // β = (θy, -θx)
      side.mean[3 * m + 2] = 0.5 * cs;
    }
  }
  for (int q = 0; q < N; ++q) {
    const Point<N>& p = points[q];
    Eigen::Matrix<double, N, 1> bump;
    Eigen::Matrix<double, 2, N> dbump;
    calc_bumps<N>(p, bump, dbump);
    const Eigen::Matrix<double, 2, N> along = calc_side_vectors<N>(plate, p);
    Strains<N>& bending = plate.bending[q];
    Vectors<N>&shear = plate.shear[q], &slope = plate.slope[q], &force = plate.force[q];
    bending.setZero();
    shear.setZero();
    slope.setZero();
    force.setZero();
    for (int i = 0; i < N; ++i) {
      const double dx = p.dshape(0, i), dy = p.dshape(1, i);
      bending(0, 3 * i + 2) = dx;
      bending(1, 3 * i + 1) = -dy;
      bending(2, 3 * i + 1) = -dx;
      bending(2, 3 * i + 2) = dy;
      slope(0, 3 * i + 2) = -p.shape[i];  // -β
      slope(1, 3 * i + 1) = p.shape[i];
    }
    for (int k = 0; k < N; ++k) {
      const auto& side = plate.sides[k];
      const double c = -1.5 / (1 + side.phi), cs = side.t.x(), sn = side.t.y();
      const Eigen::Vector3d curvature(c * cs * dbump(0, k), c * sn * dbump(1, k),
                                      c * (cs * dbump(1, k) + sn * dbump(0, k)));
      const Eigen::Vector2d gamma = side.phi / (1 + side.phi) * along.col(k);
      const Eigen::Vector2d rise = gamma - c * bump[k] * side.t;
      const Eigen::Vector2d rigid = side_force[k] * along.col(k);
      plate.side_bending[k][q] = curvature;
      plate.side_shear[k][q] = gamma;
      for (int m : {side.i, side.j}) {
        const auto mean = side.mean.template segment<3>(3 * m);
        bending.template middleCols<3>(3 * m) += curvature * mean;
        slope.template middleCols<3>(3 * m) += rise * mean;
        if (section.shear_flexible)
          shear.template middleCols<3>(3 * m) += gamma * mean;
        else
          force.template middleCols<3>(3 * m) += rigid * mean;
      }
    }
    if (section.shear_flexible) force = section.S * shear;
    if (section.D.isZero(0)) {  // a membrane: no bending ties the rotations to the slopes of the surface
      slope.setZero();
      for (int i = 0; i < N; ++i) slope.col(3 * i) = p.dshape.col(i);
    }
  }
  return plate;
}

template Points<3> calc_points<3>(const Corners<3>&);
template Points<4> calc_points<4>(const Corners<4>&);
template Point<3> calc_centre<3>(const Corners<3>&);
template Point<4> calc_centre<4>(const Corners<4>&);
template Plate<3> calc_plate<3>(const Corners<3>&, const Points<3>&, const ShellSection&);
template Plate<4> calc_plate<4>(const Corners<4>&, const Points<4>&, const ShellSection&);

}  // namespace bough::fe::shell
