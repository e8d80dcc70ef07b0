/// Membranes of the flat shells. With drilling rotations (CQUADR, CTRIAR):
///
/// Four corners: assumed stresses P β in equilibrium, complete to first order (7 parameters, as in Pian & Sumihara,
/// IJNME 20 (1984) 1685-1695, but in x, y: what stays a bending field in an element of any shape), against side
/// displacements that are quadratic across the side by the difference of its two rotations (Allman, Comput. Struct. 19
/// (1984) 1-8; hybrid shells of this kind: Aminpour, IJNME 33 (1992) 19-38): K = GᵀH⁻¹G, H = ∫PᵀA⁻¹P, G = ∮Pᵀn ū. Rank
/// 7; the mean rotation is tied to ½(v,x - u,y) at the centre with γ = G (Hughes & Brezzi, CMAME 72 (1989) 105-121) and
/// the alternating one, freed of what is linear in x and y, is held by a tenth of G.
///
/// Three corners: ANDES with the free parameters of the optimal triangle (Felippa, CMAME 192 (2003) 2125-2168):
/// α_b = 3/2, β = 1 2 1 0 1 -1 -1 -1 -2, β0 = ½(1 - 4ν²) but not below 0.01, ν = A12/√(A11 A22).
#include <Eigen/Cholesky>
#include <cmath>

#include "fe/elements/shell_fields.hpp"

namespace bough::fe::shell {
namespace {

constexpr double kAlternating = 0.1;

template <int N>
void set_bilinear(const Points<N>& points, Membrane<N>& m) {
  for (int q = 0; q < N; ++q) {
    m.strain[q].setZero();
    for (int i = 0; i < N; ++i) {
      const double dx = points[q].dshape(0, i), dy = points[q].dshape(1, i);
      m.strain[q](0, 3 * i) = dx;
      m.strain[q](1, 3 * i + 1) = dy;
      m.strain[q](2, 3 * i) = dy;
      m.strain[q](2, 3 * i + 1) = dx;
    }
  }
}

/// The incompatible modes of Taylor, Beresford & Wilson, IJNME 10 (1976) 1211-1219 (QM6), condensed into the strains.
/// They do no work on the forces of curvature, B κ̄, which are constant.
void add_modes(const Corners<4>& xy, const Points<4>& points, const ShellSection& section, Membrane<4>& m) {
  const Point<4> centre = calc_centre<4>(xy);
  auto& modes = m.mode;
  Eigen::Matrix4d& Kaa = m.mode_stiffness;
  Kaa.setZero();
  m.has_modes = true;
  Eigen::Matrix<double, 4, 12> Kau = Eigen::Matrix<double, 4, 12>::Zero();
  for (int q = 0; q < 4; ++q) {
    const auto& p = points[q];
    // J at the centre, scaled, so that the modes do no work on constant stress.
    const double ratio = centre.J / p.J;
    const Eigen::Vector2d a = -2 * p.r * ratio * centre.J_inv.col(0), b = -2 * p.s * ratio * centre.J_inv.col(1);
    modes[q] << a.x(), b.x(), 0, 0, 0, 0, a.y(), b.y(), a.y(), b.y(), a.x(), b.x();
    const Eigen::Matrix<double, 4, 3> stress = p.weight * modes[q].transpose() * section.A;
    Kaa.noalias() += stress * modes[q];
    Kau.noalias() += stress * m.strain[q];
  }
  // Column by column: the solver of many right-hand sides is made for larger matrices.
  const Eigen::LDLT<Eigen::Matrix4d> factor(Kaa);
  Eigen::Matrix<double, 4, 12> by_membrane;
  for (int j = 0; j < 12; ++j) by_membrane.col(j) = factor.solve(Kau.col(j));
  for (int q = 0; q < 4; ++q) m.strain[q].noalias() -= modes[q] * by_membrane;
}

/// Linear stresses in equilibrium about the centre, in units of `size`.
Eigen::Matrix<double, 3, 7> calc_stresses(const Eigen::Vector2d& at, double size) {
  const double x = at.x() / size, y = at.y() / size;
  Eigen::Matrix<double, 3, 7> P;
  P << 1, 0, 0, y, 0, x, 0,  //
      0, 1, 0, 0, x, 0, y,   //
      0, 0, 1, 0, 0, -y, -x;
  return P;
}

void set_hybrid(const Corners<4>& xy, const Points<4>& points, const ShellSection& section, Membrane<4>& m) {
  const Point<4> centre = calc_centre<4>(xy);
  const Eigen::Vector2d origin = xy.rowwise().mean();
  const double size = std::sqrt(centre.weight);
  const Eigen::Matrix3d compliance = section.A.inverse();
  Eigen::Matrix<double, 7, 7> H = Eigen::Matrix<double, 7, 7>::Zero();
  std::array<Eigen::Matrix<double, 3, 7>, 4> strain;
  for (int q = 0; q < 4; ++q) {
    const Eigen::Matrix<double, 3, 7> P = calc_stresses(xy * points[q].shape - origin, size);
    strain[q] = compliance * P;
    H.noalias() += points[q].weight * P.transpose() * strain[q];
  }
  Eigen::Matrix<double, 7, 12> G = Eigen::Matrix<double, 7, 12>::Zero();
  const double g = 0.5 / std::sqrt(3.0);
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    const Eigen::Vector2d side = xy.col(j) - xy.col(i), out(side.y(), -side.x());  // length L, outward
    for (double t : {0.5 - g, 0.5 + g}) {
      const Eigen::Matrix<double, 3, 7> P = calc_stresses(xy.col(i) + t * side - origin, size);
      Eigen::Matrix<double, 2, 7> traction;  // times L/2
      traction.row(0) = 0.5 * (out.x() * P.row(0) + out.y() * P.row(2));
      traction.row(1) = 0.5 * (out.x() * P.row(2) + out.y() * P.row(1));
      G.middleCols<2>(3 * i).noalias() += (1 - t) * traction.transpose();
      G.middleCols<2>(3 * j).noalias() += t * traction.transpose();
      // Across the side: n L/2 t(1-t) (θ_j - θ_i).
      const Eigen::Matrix<double, 7, 1> bump = 0.5 * t * (1 - t) * traction.transpose() * out;
      G.col(3 * i + 2) -= bump;
      G.col(3 * j + 2) += bump;
    }
  }
  const Eigen::Matrix<double, 7, 12> beta = H.ldlt().solve(G);
  for (int q = 0; q < 4; ++q) m.strain[q].noalias() = strain[q] * beta;

  m.num_springs = 2;
  m.spring[0] = -calc_spin<4>(centre);
  const Eigen::Vector4d sign(1, -1, 1, -1);
  const Eigen::Vector4d alternating = (sign - centre.dshape.transpose() * (xy * sign)) / 4;
  m.spring[1].setZero();
  for (int i = 0; i < 4; ++i) {
    m.spring[0][3 * i + 2] = 0.25;
    m.spring[1][3 * i + 2] = alternating[i];
  }
  m.spring_weight[0] = section.A(2, 2) * centre.weight;
  m.spring_weight[1] = kAlternating * section.A(2, 2) * centre.weight;
}

void set_andes(const Corners<3>& xy, const Points<3>& points, const ShellSection& section, Membrane<3>& m) {
  const auto dx = [&](int i, int j) { return xy(0, i) - xy(0, j); };
  const auto dy = [&](int i, int j) { return xy(1, i) - xy(1, j); };
  const double area = 0.5 * (dx(1, 0) * dy(2, 0) - dx(2, 0) * dy(1, 0));
  // Basic part: mean strains (Felippa, eq. 9, α_b = 3/2); sides by the corner a opposite.
  Strains<3> mean;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    const double f = 1.5 / 6;
    mean.col(3 * a) << dy(b, c), 0, dx(c, b);
    mean.col(3 * a + 1) << 0, dx(c, b), dy(b, c);
    mean.col(3 * a + 2) << f * dy(b, c) * (dy(a, c) - dy(b, a)), f * dx(c, b) * (dx(c, a) - dx(a, b)),
        2 * f * (dx(c, a) * dy(a, c) - dx(a, b) * dy(b, a));
  }
  mean *= 0.5 / area;
  // Rotations beyond that of the linear displacements.
  Eigen::Matrix<double, 3, 9> hierarchical = Eigen::Matrix<double, 3, 9>::Zero();
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      hierarchical(i, 3 * a) = dx(c, b) / (4 * area);
      hierarchical(i, 3 * a + 1) = dy(c, b) / (4 * area);
      if (i == a) hierarchical(i, 3 * a + 2) = 1;
    }
  // Natural strains along sides 2-1, 3-2, 1-3 by those rotations at the corners, and Cartesian from natural.
  const double l[3] = {(xy.col(1) - xy.col(0)).squaredNorm(), (xy.col(2) - xy.col(1)).squaredNorm(),
                       (xy.col(0) - xy.col(2)).squaredNorm()};
  Eigen::Matrix3d natural;  // rows xx yy xy, columns sides 21, 32, 13
  const int ends[3][2] = {{1, 0}, {2, 1}, {0, 2}};
  Eigen::Matrix3d along;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d t = (xy.col(ends[k][0]) - xy.col(ends[k][1])) / std::sqrt(l[k]);
    along.row(k) << t.x() * t.x(), t.y() * t.y(), t.x() * t.y();
  }
  natural = along.inverse();
  const double b1 = 1, b2 = 2, b3 = 1, b4 = 0, b5 = 1, b6 = -1, b7 = -1, b8 = -1, b9 = -2;
  Eigen::Matrix3d Q[3];
  Q[0] << b1, b2, b3, b4, b5, b6, b7, b8, b9;
  Q[1] << b9, b7, b8, b3, b1, b2, b6, b4, b5;
  Q[2] << b5, b6, b4, b8, b9, b7, b2, b3, b1;
  const double A11A22 = section.A(0, 0) * section.A(1, 1);
  const double nu = A11A22 > 0 ? section.A(0, 1) / std::sqrt(A11A22) : 0;
  const double beta0 = std::max(0.5 * (1 - 4 * nu * nu), 0.01);
  for (int q = 0; q < 3; ++q) {
    Eigen::Matrix3d at = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i) at += points[q].shape[i] * Q[i];
    for (int k = 0; k < 3; ++k) at.row(k) *= 2 * area / (3 * l[k]);
    m.strain[q] = mean + 1.5 * std::sqrt(beta0) * natural * (at * hierarchical);
  }
}

template <int N>
void set_coupling(const Points<N>& points, const ShellSection& section, const Plate<N>& plate, Membrane<N>& m) {
  m.stretch = calc_stretch_of_curvature(section);
  m.coupled = !m.stretch.isZero(0);
  if (!m.coupled) return;
  Strains<N> mean = Strains<N>::Zero();
  double area = 0;
  for (int q = 0; q < N; ++q) {
    mean += points[q].weight * plate.bending[q];
    area += points[q].weight;
  }
  mean /= area;
  for (int q = 0; q < N; ++q) m.strain_of_plate[q] = m.stretch * (plate.bending[q] - mean);
}

}  // namespace

template <int N>
Membrane<N> calc_membrane(MembraneKind kind, const Corners<N>& xy, const Points<N>& points, const ShellSection& section,
                          const Plate<N>& plate) {
  Membrane<N> m;
  set_coupling<N>(points, section, plate, m);
  if (kind == MembraneKind::Drilling && section.A.determinant() > 0) {
    if constexpr (N == 4)
      set_hybrid(xy, points, section, m);
    else
      set_andes(xy, points, section, m);
    m.has_rotations = true;
    return m;
  }
  set_bilinear<N>(points, m);
  m.num_springs = N;
  for (int q = 0; q < N; ++q) {
    m.spring[q] = -calc_spin<N>(points[q]);
    for (int i = 0; i < N; ++i) m.spring[q][3 * i + 2] = points[q].shape[i];
    m.spring_weight[q] = section.drilling * points[q].weight;
  }
  if constexpr (N == 4) {
    if (!section.A.isZero(0)) add_modes(xy, points, section, m);
  }
  return m;
}

template Membrane<3> calc_membrane<3>(MembraneKind, const Corners<3>&, const Points<3>&, const ShellSection&,
                                      const Plate<3>&);
template Membrane<4> calc_membrane<4>(MembraneKind, const Corners<4>&, const Points<4>&, const ShellSection&,
                                      const Plate<4>&);

}  // namespace bough::fe::shell
