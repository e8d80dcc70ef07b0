#include "bough/fe/elements/shell.hpp"

#include <cmath>

#include "bough/base/rotation.hpp"

namespace bough::fe {

namespace {

using Row24 = Eigen::Matrix<double, 1, 24>;

// Sides in the direction of growing ξ or η (quadrilateral) or around (triangle).
constexpr int kQuadSides[4][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}};
constexpr int kTriSides[3][2] = {{0, 1}, {1, 2}, {2, 0}};

/// Shape functions, side bumps and their derivatives by natural coordinates at a point.
struct Natural {
  Eigen::Vector4d shape = Eigen::Vector4d::Zero(), bump = Eigen::Vector4d::Zero();
  Eigen::Matrix<double, 2, 4> dshape = Eigen::Matrix<double, 2, 4>::Zero(), dbump = Eigen::Matrix<double, 2, 4>::Zero();
};

Natural calc_quad(double r, double s) {
  Natural n;
  n.shape << (1 - r) * (1 - s) / 4, (1 + r) * (1 - s) / 4, (1 + r) * (1 + s) / 4, (1 - r) * (1 + s) / 4;
  n.dshape << -(1 - s) / 4, (1 - s) / 4, (1 + s) / 4, -(1 + s) / 4, -(1 - r) / 4, -(1 + r) / 4, (1 + r) / 4,
      (1 - r) / 4;
  n.bump << (1 - r * r) * (1 - s) / 2, (1 + r) * (1 - s * s) / 2, (1 - r * r) * (1 + s) / 2, (1 - r) * (1 - s * s) / 2;
  n.dbump << -r * (1 - s), (1 - s * s) / 2, -r * (1 + s), -(1 - s * s) / 2, -(1 - r * r) / 2, -s * (1 + r),
      (1 - r * r) / 2, -s * (1 - r);
  return n;
}

Natural calc_tri(double r, double s) {
  Natural n;
  const double l = 1 - r - s;
  n.shape << l, r, s, 0;
  n.dshape << -1, 1, 0, 0, -1, 0, 1, 0;
  n.bump << 4 * l * r, 4 * r * s, 4 * s * l, 0;
  n.dbump << 4 * (l - r), 4 * s, -4 * s, 0, -4 * r, 4 * r, 4 * (l - s), 0;
  return n;
}

}  // namespace

/// Strain operators on the 24 (or 18) element-axes dofs, u v w θx θy θz node by node.
struct Shell::Point {
  Eigen::Matrix<double, 3, 24> membrane = Eigen::Matrix<double, 3, 24>::Zero();
  Eigen::Matrix<double, 3, 4> modes = Eigen::Matrix<double, 3, 4>::Zero();  // incompatible membrane modes
  Eigen::Matrix<double, 3, 24> bending = Eigen::Matrix<double, 3, 24>::Zero();
  Eigen::Matrix<double, 2, 24> shear = Eigen::Matrix<double, 2, 24>::Zero();
  Eigen::Matrix<double, 2, 24> slope = Eigen::Matrix<double, 2, 24>::Zero();     // w,x w,y
  Eigen::Matrix<double, 4, 24> gradient = Eigen::Matrix<double, 4, 24>::Zero();  // u,x u,y v,x v,y
  Row24 drilling = Row24::Zero();
  Eigen::Vector4d shape = Eigen::Vector4d::Zero();
  double weight = 0;  // dA
};

Shell::Shell(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, const ShellGeometry& geometry,
             const ShellSection& section)
    : Element(id, std::move(card), std::move(nodes), std::move(gdofs)),
      z_offset_(geometry.z_offset),
      section_(section) {
  const auto& x = geometry.x;
  const std::size_t n = x.size();
  const Vector3d normal =
      n == 4 ? (x[2] - x[0]).cross(x[3] - x[1]).normalized() : (x[1] - x[0]).cross(x[2] - x[0]).normalized();
  Vector3d side = x[1] - x[0];
  side -= normal * normal.dot(side);
  side.normalize();
  R_ << side, normal.cross(side), normal;
  Vector3d centre = Vector3d::Zero();
  for (const auto& p : x) centre += p / static_cast<double>(n);
  for (const auto& p : x) {
    const Vector3d local = R_.transpose() * (p - centre);
    xy_.push_back(local.head<2>());
    arm_.push_back(geometry.z_offset - local.z());
    const std::size_t i = arm_.size() - 1;
    normal_.push_back(geometry.normals.empty() ? Vector3d::UnitZ() : Vector3d(R_.transpose() * geometry.normals[i]));
  }
  for (int q = 0; q < num_points(); ++q) area_ += calc_point(q).weight;
}

ElementShape Shell::shape() const { return {num_nodes() == 4 ? "quad4" : "tri3", nodes()}; }

Shell::Point Shell::calc_point(int q) const {
  const bool quad = num_nodes() == 4;
  const int n = num_nodes();
  const double g = 1 / std::sqrt(3.0);
  double r, s, quadrature;
  if (quad) {
    r = (q == 0 || q == 3) ? -g : g;
    s = q < 2 ? -g : g;
    quadrature = 1;
  } else {
    r = q == 1 ? 2.0 / 3 : 1.0 / 6;
    s = q == 2 ? 2.0 / 3 : 1.0 / 6;
    quadrature = 1.0 / 6;
  }
  const Natural at = quad ? calc_quad(r, s) : calc_tri(r, s);
  Eigen::Matrix2d J = Eigen::Matrix2d::Zero();  // rows: d(x,y)/dr, d(x,y)/ds
  for (int i = 0; i < n; ++i) J += at.dshape.col(i) * xy_[i].transpose();
  const Eigen::Matrix2d J_inv = J.inverse();
  const Eigen::Matrix<double, 2, 4> dshape = J_inv * at.dshape;
  const Eigen::Matrix<double, 2, 4> dbump = J_inv * at.dbump;

  Point p;
  p.weight = quadrature * J.determinant();
  p.shape = at.shape;
  for (int i = 0; i < n; ++i) {
    const int c = 6 * i;
    const double dx = dshape(0, i), dy = dshape(1, i);
    p.membrane(0, c) = dx;
    p.membrane(1, c + 1) = dy;
    p.membrane(2, c) = dy;
    p.membrane(2, c + 1) = dx;
    p.gradient(0, c) = dx;
    p.gradient(1, c) = dy;
    p.gradient(2, c + 1) = dx;
    p.gradient(3, c + 1) = dy;
    p.bending(0, c + 4) = dx;  // β_x = θy, β_y = -θx
    p.bending(1, c + 3) = -dy;
    p.bending(2, c + 4) = dy;
    p.bending(2, c + 3) = -dx;
    p.slope(0, c + 4) = -at.shape[i];  // -β; the shear is added below
    p.slope(1, c + 3) = at.shape[i];
    p.drilling[c] = 0.5 * dy;  // θz - ½(v,x - u,y)
    p.drilling[c + 1] = -0.5 * dx;
    p.drilling[c + 5] = at.shape[i];
  }
  if (quad) {
    // J at the centre, scaled, so that the modes do no work on constant stress (Taylor et al. 1976).
    const Natural centre = calc_quad(0, 0);
    Eigen::Matrix2d J0 = Eigen::Matrix2d::Zero();
    for (int i = 0; i < n; ++i) J0 += centre.dshape.col(i) * xy_[i].transpose();
    const double ratio = J0.determinant() / J.determinant();
    const Eigen::Vector2d a = ratio * J0.inverse() * Eigen::Vector2d(-2 * r, 0);
    const Eigen::Vector2d b = ratio * J0.inverse() * Eigen::Vector2d(0, -2 * s);
    p.modes << a.x(), b.x(), 0, 0, 0, 0, a.y(), b.y(), a.y(), b.y(), a.x(), b.x();
  }

  Eigen::Matrix<double, 2, 24> covariant = Eigen::Matrix<double, 2, 24>::Zero();  // γ_r, γ_s
  Row24 side_shear[4];
  const auto* sides = quad ? kQuadSides : nullptr;
  for (int k = 0; k < n; ++k) {
    const int i = quad ? sides[k][0] : kTriSides[k][0], j = quad ? sides[k][1] : kTriSides[k][1];
    const Eigen::Vector2d d = xy_[j] - xy_[i];
    const double L = d.norm(), cs = d.x() / L, sn = d.y() / L;
    double phi = 0;
    if (section_.shear_flexible) {
      // Bending and shear stiffness along the side: 12 D_s / (S_s L²) (Katili, Part I, eq. 16 for an isotropic plate).
      const Eigen::Vector3d e(cs * cs, sn * sn, 2 * cs * sn);
      const Eigen::Vector2d t(cs, sn);
      phi = 12 * e.dot(section_.D * Eigen::Vector3d(cs * cs, sn * sn, cs * sn * 2)) / (t.dot(section_.S * t) * L * L);
    }
    // mean of w,s + β_s over the side, before the bump
    Row24 mean = Row24::Zero();
    mean[6 * i + 2] = -1 / L;
    mean[6 * j + 2] = 1 / L;
    for (int m : {i, j}) {
      mean[6 * m + 4] += 0.5 * cs;
      mean[6 * m + 3] -= 0.5 * sn;
    }
    const Row24 bump = -1.5 / (1 + phi) * mean;
    side_shear[k] = phi / (1 + phi) * mean;
    p.bending.row(0) += cs * dbump(0, k) * bump;
    p.bending.row(1) += sn * dbump(1, k) * bump;
    p.bending.row(2) += (cs * dbump(1, k) + sn * dbump(0, k)) * bump;
    p.slope.row(0) -= cs * at.bump[k] * bump;
    p.slope.row(1) -= sn * at.bump[k] * bump;
    if (quad) {
      const double end = k == 0 ? (1 - s) / 2 : k == 1 ? (1 + r) / 2 : k == 2 ? (1 + s) / 2 : (1 - r) / 2;
      covariant.row(k % 2) += end * 0.5 * L * side_shear[k];
    }
  }
  if (quad) {
    p.shear = J_inv * covariant;
  } else {
    // Each corner sees the shears of its two sides; linear in between (Katili, Part I, eqs. 21-23).
    for (int i = 0; i < 3; ++i) {
      const int ka = i, kb = (i + 2) % 3;
      Eigen::Matrix2d t;
      t << (xy_[kTriSides[ka][1]] - xy_[kTriSides[ka][0]]).normalized().transpose(),
          (xy_[kTriSides[kb][1]] - xy_[kTriSides[kb][0]]).normalized().transpose();
      Eigen::Matrix<double, 2, 24> both;
      both << side_shear[ka], side_shear[kb];
      p.shear += at.shape[i] * (t.inverse() * both);
    }
  }
  p.slope += p.shear;
  return p;
}

void Shell::calc_map(Dofs& map) const {
  const int n = num_nodes();
  map.setZero(6 * n, 6 * n);
  const Matrix3d Rt = R_.transpose();
  for (int i = 0; i < n; ++i) {
    map.block<3, 3>(6 * i, 6 * i) = Rt;
    map.block<3, 3>(6 * i + 3, 6 * i + 3) = Rt;
    map.block<1, 3>(6 * i, 6 * i + 3) = arm_[i] * Rt.row(1);       // u + d θy
    map.block<1, 3>(6 * i + 1, 6 * i + 3) = -arm_[i] * Rt.row(0);  // v - d θx
  }
  // Where the nodal normal m leans, the part of θ along m is replaced by what the membrane turns about z (Ω, at the
  // centre): θ_t + m (Ω - θ_t·z)/(m·z) with θ_t = θ - m (m·θ). A rigid rotation is unchanged.
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 24> spin;
  for (int i = 0; i < n; ++i) {
    const Vector3d& m = normal_[i];
    if (m.head<2>().squaredNorm() < 1e-24) continue;
    if (spin.size() == 0) spin = calc_spin() * map;  // only rows of u, v enter: unchanged by this loop
    const Matrix3d tangent = Matrix3d::Identity() - m * m.transpose();
    const Vector3d lean = m / m.z();
    const Matrix3d turn = (tangent - lean * tangent.row(2)) * Rt;
    for (int a = 0; a < 2; ++a) {
      map.row(6 * i + 3 + a).setZero();
      map.block<1, 3>(6 * i + 3 + a, 6 * i + 3) = turn.row(a);
      map.row(6 * i + 3 + a) += lean[a] * spin;
    }
  }
}

Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 24> Shell::calc_spin() const {
  const int n = num_nodes();
  const Natural at = n == 4 ? calc_quad(0, 0) : calc_tri(1.0 / 3, 1.0 / 3);
  Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
  for (int i = 0; i < n; ++i) J += at.dshape.col(i) * xy_[i].transpose();
  const Eigen::Matrix<double, 2, 4> dshape = J.inverse() * at.dshape;
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 24> row;
  row.setZero(6 * n);
  for (int i = 0; i < n; ++i) {
    row[6 * i] = -0.5 * dshape(1, i);
    row[6 * i + 1] = 0.5 * dshape(0, i);
  }
  return row;
}

Shell::Dofs Shell::calc_local_stiffness(Eigen::Matrix<double, 4, 24>* modes) const {
  const int n = num_nodes();
  Eigen::Matrix<double, 24, 24> K = Eigen::Matrix<double, 24, 24>::Zero();
  Eigen::Matrix4d Kaa = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 24> Kau = Eigen::Matrix<double, 4, 24>::Zero();
  const auto& c = section_;
  const bool coupled = c.B.squaredNorm() > 0;
  for (int q = 0; q < num_points(); ++q) {
    const Point p = calc_point(q);
    Eigen::Matrix<double, 3, 24> N = c.A * p.membrane, M = c.D * p.bending;
    if (coupled) {
      N += c.B * p.bending;
      M += c.B.transpose() * p.membrane;
    }
    K.noalias() += p.weight * (p.membrane.transpose() * N + p.bending.transpose() * M);
    if (c.shear_flexible) K.noalias() += p.weight * p.shear.transpose() * c.S * p.shear;
    K.noalias() += p.weight * c.drilling * p.drilling.transpose() * p.drilling;
    if (n == 4) {
      Kaa += p.weight * p.modes.transpose() * c.A * p.modes;
      Kau += p.weight * p.modes.transpose() * N;
    }
  }
  if (n == 4 && c.A.squaredNorm() > 0) {
    const Eigen::Matrix<double, 4, 24> solved = -Kaa.ldlt().solve(Kau);
    K += Kau.transpose() * solved;
    if (modes) *modes = solved;
  } else if (modes) {
    modes->setZero();
  }
  return K.topLeftCorner(6 * n, 6 * n);
}

void Shell::add_mapped(const Dofs& local, double scale, Eigen::Ref<MatrixXd> out) const {
  Dofs map;
  calc_map(map);
  out.noalias() += scale * (map.transpose() * local.selfadjointView<Eigen::Lower>() * map);
}

void Shell::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  add_mapped(calc_local_stiffness(nullptr), scale, K);
}

void Shell::add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const {
  const int n = num_nodes();
  // The centre of mass of the section moves by u + θ × d z.
  const Vector3d z = R_.col(2);
  const double d = z_offset_ + section_.mass_offset;
  const Matrix3d arm = -d * skew(z), tangent = Matrix3d::Identity() - z * z.transpose();
  const auto add = [&](int i, int j, double mass, double rotary) {
    M.block<3, 3>(6 * i, 6 * j).diagonal().array() += mass;
    if (d != 0) {
      M.block<3, 3>(6 * i, 6 * j + 3) += mass * arm;
      M.block<3, 3>(6 * i + 3, 6 * j) += mass * arm.transpose();
    }
    if (d != 0 || rotary != 0) M.block<3, 3>(6 * i + 3, 6 * j + 3) += (mass * d * d + rotary) * tangent;
  };
  for (int q = 0; q < num_points(); ++q) {
    const Point p = calc_point(q);
    const double mass = scale * p.weight * section_.mass, rotary = scale * p.weight * section_.rotary_inertia;
    for (int i = 0; i < n; ++i) {
      if (kind == MassKind::Lumped) add(i, i, p.shape[i] * mass, 0);
      for (int j = 0; j < n && kind == MassKind::Consistent; ++j)
        add(i, j, p.shape[i] * p.shape[j] * mass, p.shape[i] * p.shape[j] * rotary);
    }
  }
}

void Shell::calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const {
  Dofs map;
  calc_map(map);
  Eigen::Matrix<double, 24, 1> local = Eigen::Matrix<double, 24, 1>::Zero();
  local.head(num_dofs()) = map * u;
  Eigen::Matrix<double, 4, 24> modes;
  calc_local_stiffness(&modes);
  const Eigen::Vector4d a = modes * local;
  for (int q = 0; q < num_points(); ++q) {
    const Point p = calc_point(q);
    force.segment<3>(3 * q) = section_.A * (p.membrane * local + p.modes * a) + section_.B * (p.bending * local);
  }
}

std::vector<std::string> Shell::internal_force_names() const {
  std::vector<std::string> names;
  for (int q = 1; q <= num_points(); ++q)
    for (const char* c : {"Nx", "Ny", "Nxy"}) names.push_back(c + std::string("@") + std::to_string(q));
  return names;
}

void Shell::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                    Eigen::Ref<MatrixXd> K_G) const {
  const int n = num_nodes();
  Eigen::Matrix<double, 24, 24> local = Eigen::Matrix<double, 24, 24>::Zero();
  for (int q = 0; q < num_points(); ++q) {
    const Point p = calc_point(q);
    Eigen::Matrix2d N;
    N << force[3 * q], force[3 * q + 2], force[3 * q + 2], force[3 * q + 1];
    N *= p.weight;
    local.noalias() += p.slope.transpose() * N * p.slope;
    local.noalias() += p.gradient.topRows<2>().transpose() * N * p.gradient.topRows<2>();
    local.noalias() += p.gradient.bottomRows<2>().transpose() * N * p.gradient.bottomRows<2>();
  }
  add_mapped(local.topLeftCorner(6 * n, 6 * n), scale, K_G);
}

}  // namespace bough::fe
