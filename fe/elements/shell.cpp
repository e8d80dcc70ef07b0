#include "fe/elements/shell.hpp"

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"
#include "fe/elements/shell_dofs.hpp"
#include "fe/linear/blas.hpp"

namespace bough::fe {

using namespace shell;

Shell::Shell(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, const ShellGeometry& geometry,
             const ShellSection& section, MembraneKind kind)
    : Element(id, std::move(card), std::move(nodes), std::move(gdofs)),
      num_nodes_(static_cast<int>(geometry.x.size())),
      kind_(kind),
      z_offset_(geometry.z_offset),
      section_(section) {
  const auto& x = geometry.x;
  const Vector3d normal =
      num_nodes_ == 4 ? (x[2] - x[0]).cross(x[3] - x[1]).normalized() : (x[1] - x[0]).cross(x[2] - x[0]).normalized();
  Vector3d side = x[1] - x[0];
  side -= normal * normal.dot(side);
  side.normalize();
  R_ << side, normal.cross(side), normal;
  Vector3d centre = Vector3d::Zero();
  for (const auto& p : x) centre += p / static_cast<double>(num_nodes_);
  xy_.setZero();
  const double size = (x[2] - x[0]).norm();
  for (int i = 0; i < num_nodes_; ++i) {
    const Vector3d local = R_.transpose() * (x[i] - centre);
    xy_.col(i) = local.head<2>();
    arm_[i] = geometry.z_offset - local.z();
    normal_[i] = geometry.normals.empty() ? Vector3d::UnitZ() : Vector3d(R_.transpose() * geometry.normals[i]);
    has_arms_ = has_arms_ || std::abs(arm_[i]) > 1e-14 * size;
    has_lean_ = has_lean_ || normal_[i].head<2>().squaredNorm() > 1e-24;
  }
  if (!has_arms_) arm_.fill(0);
  if (num_nodes_ == 4)
    for (const auto& p : calc_points<4>(get_corners<4>())) area_ += p.weight;
  else
    for (const auto& p : calc_points<3>(get_corners<3>())) area_ += p.weight;
}

ElementShape Shell::shape() const { return {num_nodes() == 4 ? "quad4" : "tri3", nodes()}; }

template <int N>
ShellFields<N> Shell::calc_fields() const {
  const Corners<N> xy = get_corners<N>();
  ShellFields<N> f;
  f.points = calc_points<N>(xy);
  f.plate = calc_plate<N>(xy, f.points, section_);
  f.membrane = calc_membrane<N>(kind_, xy, f.points, section_, f.plate);
  return f;
}

template <int N, class Columns>
void Shell::to_nodes(Columns&& local) const {
  const Row<N> spin = has_lean_ ? calc_spin<N>(calc_centre<N>(get_corners<N>())) : Row<N>::Zero();
  // Where the nodal normal m leans, the part of θ along m is replaced by what the membrane turns about z (Ω, at the
  // centre): θ_t + m (Ω - θ_t·z)/(m·z) with θ_t = θ - m (m·θ). A rigid rotation is unchanged.
  for (int i = 0; i < N && has_lean_; ++i) {
    const Vector3d& m = normal_[i];
    if (m.head<2>().squaredNorm() < 1e-24) continue;
    const Matrix3d tangent = Matrix3d::Identity() - m * m.transpose();
    const Vector3d lean = m / m.z();
    const Matrix3d turn = tangent - lean * tangent.row(2);
    const auto x = local.col(6 * i + 3).eval(), y = local.col(6 * i + 4).eval();
    local.col(6 * i + 3) = x * turn(0, 0) + y * turn(1, 0);
    local.col(6 * i + 4) = x * turn(0, 1) + y * turn(1, 1);
    local.col(6 * i + 5) += x * turn(0, 2) + y * turn(1, 2);
    const auto leaning = (x * lean.x() + y * lean.y()).eval();
    for (int j = 0; j < N; ++j)
      for (int a = 0; a < 2; ++a) local.col(6 * j + a) += leaning * spin[3 * j + a];
  }
  for (int i = 0; i < N && has_arms_; ++i) {  // u + d θy, v - d θx
    local.col(6 * i + 4) += arm_[i] * local.col(6 * i);
    local.col(6 * i + 3) -= arm_[i] * local.col(6 * i + 1);
  }
}

template <int N>
Shell::Square<N> Shell::calc_surface_map() const {
  Square<N> map = Square<N>::Identity();
  to_nodes<N>(map);
  return map;
}

template <int N>
void Shell::add_turned(const Square<N>& local, double scale, Eigen::Ref<MatrixXd> out) const {
  for (int j = 0; j < 2 * N; ++j)
    for (int i = 0; i <= j; ++i) {
      const Matrix3d block = scale * (R_ * local.template block<3, 3>(3 * i, 3 * j) * R_.transpose());
      if (i == j) {
        out.block<3, 3>(3 * i, 3 * j) += 0.5 * (block + block.transpose());
      } else {
        out.block<3, 3>(3 * i, 3 * j) += block;
        out.block<3, 3>(3 * j, 3 * i) += block.transpose();
      }
    }
}

namespace {

/// K += BᵀC, column by column: for so few rows Eigen's product of large matrices packs longer than it multiplies.
template <class Rows, class Square>
void add_product(const Rows& B, const Rows& C, Square& K) {
  const Eigen::Matrix<double, Rows::ColsAtCompileTime, Rows::RowsAtCompileTime> B_t = B.transpose();
  for (int j = 0; j < Rows::ColsAtCompileTime; ++j)
    for (int r = 0; r < Rows::RowsAtCompileTime; ++r) K.col(j) += B_t.col(r) * C(r, j);
}

}  // namespace

template <int N>
void Shell::add_stiffness_of(double scale, Eigen::Ref<MatrixXd> out) const {
  using Block = Eigen::Matrix<double, 3 * N, 3 * N>;
  const auto [points, plate, membrane] = calc_fields<N>();
  const auto& c = section_;
  const bool coupled = !c.B.isZero(0);
  Block K_mm = Block::Zero(), K_pp = Block::Zero(), K_mp = Block::Zero();
  for (int q = 0; q < N; ++q) {
    const double w = points[q].weight;
    const Strains<N>&e = membrane.strain[q], &k = plate.bending[q];
    add_product(e, Strains<N>(w * c.A * e), K_mm);
    add_product(k, Strains<N>(w * c.D * k), K_pp);
    if (c.shear_flexible) add_product(plate.shear[q], Vectors<N>(w * plate.force[q]), K_pp);
    if (!coupled) continue;
    add_product(e, Strains<N>(w * c.B * k), K_mp);
    if (!membrane.coupled) continue;
    const Strains<N>& f = membrane.strain_of_plate[q];
    Block cross = Block::Zero();
    add_product(f, Strains<N>(w * c.B * k), cross);
    add_product(e, Strains<N>(w * c.A * f), K_mp);
    add_product(f, Strains<N>(w * c.A * f), K_pp);
    K_pp += cross + cross.transpose();
  }
  for (int i = 0; i < membrane.num_springs; ++i)
    K_mm.noalias() += membrane.spring_weight[i] * membrane.spring[i].transpose() * membrane.spring[i];
  Square<N> K;
  for (int j = 0; j < 3 * N; ++j)
    for (int i = 0; i < 3 * N; ++i) {
      K(kMembrane<N>[i], kMembrane<N>[j]) = K_mm(i, j);
      K(kPlate<N>[i], kPlate<N>[j]) = K_pp(i, j);
      K(kMembrane<N>[i], kPlate<N>[j]) = K(kPlate<N>[j], kMembrane<N>[i]) = K_mp(i, j);
    }
  if (has_arms_ || has_lean_) {
    to_nodes<N>(K);
    K.transposeInPlace();
    to_nodes<N>(K);
  }
  add_turned<N>(K, scale, out);
}

template <int N>
Eigen::Matrix<double, N, N> Shell::calc_mass_areas_of(MassKind kind) const {
  Eigen::Matrix<double, N, N> area = Eigen::Matrix<double, N, N>::Zero();
  for (const auto& p : calc_points<N>(get_corners<N>())) {
    if (kind == MassKind::Lumped)
      area.diagonal() += p.weight * p.shape;
    else
      area.noalias() += p.weight * p.shape * p.shape.transpose();
  }
  return area;
}

MatrixXd Shell::calc_mass_areas(MassKind kind) const {
  if (num_nodes_ == 4) return calc_mass_areas_of<4>(kind);
  return calc_mass_areas_of<3>(kind);
}

template <int N>
void Shell::add_mass_of(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const {
  // The centre of mass of the section moves by u + θ × d z.
  const Vector3d z = R_.col(2);
  const double d = z_offset_ + section_.mass_offset;
  const Matrix3d arm = -d * skew(z), tangent = Matrix3d::Identity() - z * z.transpose();
  const Eigen::Matrix<double, N, N> area = calc_mass_areas_of<N>(kind);
  const double inertia = section_.mass * d * d + (kind == MassKind::Consistent ? section_.rotary_inertia : 0);
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i) {
      const double part = scale * area(i, j);
      if (part == 0) continue;
      M.block<3, 3>(6 * i, 6 * j).diagonal().array() += part * section_.mass;
      if (d != 0) {
        M.block<3, 3>(6 * i, 6 * j + 3) += part * section_.mass * arm;
        M.block<3, 3>(6 * i + 3, 6 * j) += part * section_.mass * arm.transpose();
      }
      if (inertia != 0) M.block<3, 3>(6 * i + 3, 6 * j + 3) += part * inertia * tangent;
    }
}

namespace {

/// Derivatives by x and y of the shapes at corner k.
template <int N>
Eigen::Matrix<double, 2, N> calc_corner_gradient(const shell::Corners<N>& xy, int k) {
  Eigen::Matrix<double, 2, N> by_natural;
  if constexpr (N == 3) {
    by_natural << -1, 1, 0, -1, 0, 1;
  } else {
    constexpr double kR[4] = {-1, 1, 1, -1}, kS[4] = {-1, -1, 1, 1};
    for (int i = 0; i < 4; ++i) {
      by_natural(0, i) = 0.25 * kR[i] * (1 + kS[i] * kS[k]);
      by_natural(1, i) = 0.25 * kS[i] * (1 + kR[i] * kR[k]);
    }
  }
  return (by_natural * xy.transpose()).inverse() * by_natural;
}

}  // namespace

template <int N>
MassSamples Shell::sample_mass_of(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, const SpinAxis& spin) const {
  const Vector3d z = R_.col(2);
  const double d = z_offset_ + section_.mass_offset;
  MassSamples samples;
  const auto add = [&](double mass, const Eigen::Matrix<double, N, 1>& shape, const Eigen::Matrix<double, 2, N>& dshape,
                       double height) {
    MassSample s;
    s.mass = mass;
    s.arm = height * z;
    s.r = x * shape - spin.point + s.arm;
    // e x r of the surface in the tangents of the surface and its normal, along which displacements change by θ x n.
    Matrix3d tangents;
    tangents.leftCols<2>() = x * dshape.transpose();
    tangents.col(2) = tangents.col(0).cross(tangents.col(1)).normalized();
    const Vector3d c = tangents.inverse() * spin.axis.cross(s.r - s.arm);
    const Vector3d turned = c[2] * tangents.col(2) + spin.axis.cross(s.arm);
    s.N.setZero(3, 6 * N);
    s.DN.setZero(3, 6 * N);
    s.Theta.setZero(3, 6 * N);
    for (int i = 0; i < N; ++i) {
      const double along = c[0] * dshape(0, i) + c[1] * dshape(1, i);
      s.N.middleCols<3>(6 * i).diagonal().setConstant(shape[i]);
      s.N.middleCols<3>(6 * i + 3) = -shape[i] * skew(s.arm);
      s.DN.middleCols<3>(6 * i).diagonal().setConstant(along);
      s.DN.middleCols<3>(6 * i + 3) = -along * skew(s.arm) - shape[i] * skew(turned);
      s.Theta.middleCols<3>(6 * i + 3).diagonal().setConstant(shape[i]);
    }
    samples.push_back(std::move(s));
  };
  if (kind == MassKind::Lumped) {
    const Eigen::Matrix<double, N, N> area = calc_mass_areas_of<N>(kind);
    for (int k = 0; k < N; ++k)
      add(section_.mass * area(k, k), Eigen::Matrix<double, N, 1>::Unit(k),
          calc_corner_gradient<N>(get_corners<N>(), k), d);
    return samples;
  }
  const double radius = section_.mass > 0 ? std::sqrt(std::max(section_.rotary_inertia, 0.0) / section_.mass) : 0;
  for (const auto& p : calc_points<N>(get_corners<N>())) {
    if (!(radius > 0)) {
      add(section_.mass * p.weight, p.shape, p.dshape, d);
      continue;
    }
    for (const double side : {-radius, radius}) add(0.5 * section_.mass * p.weight, p.shape, p.dshape, d + side);
  }
  return samples;
}

MassSamples Shell::sample_mass(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, const SpinAxis& spin) const {
  return num_nodes_ == 4 ? sample_mass_of<4>(kind, x, spin) : sample_mass_of<3>(kind, x, spin);
}

template <int N>
Shell::ForceMap<N> Shell::calc_force_map(const ShellFields<N>& fields) const {
  ForceMap<N> map = ForceMap<N>::Zero();
  const auto& c = section_;
  for (int q = 0; q < N; ++q) {
    const Strains<N>&e = fields.membrane.strain[q], &k = fields.plate.bending[q];
    const Strains<N> N_e = c.A * e, M_e = c.B.transpose() * e;
    Strains<N> N_k = c.B * k, M_k = c.D * k;
    if (fields.membrane.coupled) {
      N_k += c.A * fields.membrane.strain_of_plate[q];
      M_k += c.B.transpose() * fields.membrane.strain_of_plate[q];
    }
    for (int i = 0; i < 3 * N; ++i) {
      map.template block<3, 1>(kNumForces * q, kMembrane<N>[i]) = N_e.col(i);
      map.template block<3, 1>(kNumForces * q + 3, kMembrane<N>[i]) = M_e.col(i);
      map.template block<3, 1>(kNumForces * q, kPlate<N>[i]) = N_k.col(i);
      map.template block<3, 1>(kNumForces * q + 3, kPlate<N>[i]) = M_k.col(i);
      map.template block<2, 1>(kNumForces * q + 6, kPlate<N>[i]) = fields.plate.force[q].col(i);
      if (!fields.membrane.has_rotations)
        map(kNumForces * N + q, kMembrane<N>[i]) = c.drilling * fields.membrane.spring[q][i];
    }
  }
  for (int k = 0; k < N && fields.membrane.has_rotations; ++k) {
    auto row = map.row(kNumForces * N + k);
    for (int q = 0; q < N; ++q)
      row += fields.points[q].weight * fields.membrane.strain[q].col(3 * k + 2).transpose() *
             map.template middleRows<3>(kNumForces * q);
    for (int s = 0; s < fields.membrane.num_springs; ++s)
      for (int i = 0; i < 3 * N; ++i)
        row[kMembrane<N>[i]] +=
            fields.membrane.spring_weight[s] * fields.membrane.spring[s][3 * k + 2] * fields.membrane.spring[s][i];
  }
  to_nodes<N>(map);
  for (int i = 0; i < 2 * N; ++i)
    map.template middleCols<3>(3 * i) = (map.template middleCols<3>(3 * i) * R_.transpose()).eval();
  return map;
}

void Shell::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  num_nodes_ == 4 ? add_stiffness_of<4>(scale, K) : add_stiffness_of<3>(scale, K);
}

void Shell::add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const {
  num_nodes_ == 4 ? add_mass_of<4>(kind, scale, M) : add_mass_of<3>(kind, scale, M);
}

void Shell::calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const {
  if (num_nodes_ == 4)
    force = calc_force_map<4>(calc_fields<4>()) * u;
  else
    force = calc_force_map<3>(calc_fields<3>()) * u;
}

void Shell::calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const {
  if (num_nodes_ == 4)
    linear::multiply_dense(false, calc_force_map<4>(calc_fields<4>()), U, 0, forces);
  else
    linear::multiply_dense(false, calc_force_map<3>(calc_fields<3>()), U, 0, forces);
}

std::vector<std::string> Shell::internal_force_names() const {
  std::vector<std::string> names;
  for (int q = 1; q <= num_points(); ++q)
    for (const char* c : {"Nx", "Ny", "Nxy", "Mx", "My", "Mxy", "Qx", "Qy"})
      names.push_back(c + std::string("@") + std::to_string(q));
  for (int q = 1; q <= num_points(); ++q) names.push_back("Mz@" + std::to_string(q));
  return names;
}

template ShellFields<3> Shell::calc_fields<3>() const;
template ShellFields<4> Shell::calc_fields<4>() const;
template Shell::Square<3> Shell::calc_surface_map<3>() const;
template Shell::Square<4> Shell::calc_surface_map<4>() const;
template void Shell::add_turned<3>(const Square<3>&, double, Eigen::Ref<MatrixXd>) const;
template void Shell::add_turned<4>(const Square<4>&, double, Eigen::Ref<MatrixXd>) const;
template Shell::ForceMap<3> Shell::calc_force_map<3>(const ShellFields<3>&) const;
template Shell::ForceMap<4> Shell::calc_force_map<4>(const ShellFields<4>&) const;

}  // namespace bough::fe
