#include <cmath>

#include "base/rotation.hpp"
#include "fe/elements/curved_shell_operators.hpp"
#include "fe/elements/geometric_projection.hpp"
#include "fe/linear/blas.hpp"

namespace bough::fe {

double CurvedShell::calc_area() const {
  double area = 0;
  for (const auto& point : tying_->points) {
    const Surface f = calc_surface(point.sample);
    area += point.weight * Vector3d(f.x.col(0)).cross(Vector3d(f.x.col(1))).norm();
  }
  return area;
}

CurvedShell::NodalMasses CurvedShell::calc_nodal_masses(MassKind kind) const {
  const int n = num_full(), corners = tying_->num_corners, num = static_cast<int>(nodes().size());
  // An absent midside node moves by the mean of its corners.
  MatrixXd reduce = MatrixXd::Zero(num, n);
  for (int i = 0; i < n; ++i) {
    const int at = place_[static_cast<std::size_t>(i)];
    if (at >= 0) {
      reduce(at, i) = 1;
    } else {
      reduce(i - corners, i) = 0.5;
      reduce((i - corners + 1) % corners, i) = 0.5;
    }
  }
  MatrixXd mass = MatrixXd::Zero(num, num), first = mass, second = mass;  // of 1, z, z² about the nodes
  double total = 0, total_first = 0, total_second = 0;
  for (std::size_t q = 0; q < tying_->points.size(); ++q) {
    const auto& point = tying_->points[q];
    const Surface f = calc_surface(point.sample);
    const double area = point.weight * Vector3d(f.x.col(0)).cross(Vector3d(f.x.col(1))).norm();
    const ShellSection& section = sections_[sections_.size() == 1 ? 0 : q];
    const VectorXd N = reduce * tying_->samples[static_cast<std::size_t>(point.sample)].shape.head(n);
    const double m = section.mass * area, z = z_offset_ + section.mass_offset;
    const MatrixXd NN = N * N.transpose();
    mass += m * NN;
    first += m * z * NN;
    second += (m * z * z + section.rotary_inertia * area) * NN;
    total += m;
    total_first += m * z;
    total_second += m * z * z;
  }
  if (kind == MassKind::Lumped) {
    const VectorXd part = mass.diagonal() / (mass.trace() > 0 ? mass.trace() : 1);
    mass = total * MatrixXd(part.asDiagonal());
    first = total_first * MatrixXd(part.asDiagonal());
    second = total_second * MatrixXd(part.asDiagonal());
  }
  NodalMasses result{mass, first, second, std::vector<Vector3d>(static_cast<std::size_t>(num))};
  for (int i = 0; i < n; ++i)
    if (const int at = place_[static_cast<std::size_t>(i)]; at >= 0)
      result.normal[static_cast<std::size_t>(at)] = normal_[static_cast<std::size_t>(i)];
  return result;
}

void CurvedShell::add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const {
  const auto [mass, first, second, normal] = calc_nodal_masses(kind);
  const int num = static_cast<int>(nodes().size());
  std::vector<Matrix3d> turn;  // θ × V
  for (const Vector3d& V : normal) turn.push_back(-skew(V));
  for (int i = 0; i < num; ++i)
    for (int j = 0; j < num; ++j) {
      if (kind == MassKind::Lumped && i != j) continue;
      const Matrix3d &a = turn[static_cast<std::size_t>(i)], &b = turn[static_cast<std::size_t>(j)];
      M.block<3, 3>(6 * i, 6 * j).diagonal().array() += scale * mass(i, j);
      M.block<3, 3>(6 * i, 6 * j + 3) += scale * first(i, j) * b;
      M.block<3, 3>(6 * i + 3, 6 * j) += scale * first(i, j) * a.transpose();
      M.block<3, 3>(6 * i + 3, 6 * j + 3) += scale * second(i, j) * a.transpose() * b;
    }
}

MatrixXd CurvedShell::calc_inner_map(const Operators& o) const {
  const int n = 6 * num_full();
  MatrixXd inner = MatrixXd::Identity(n + num_bubbles(), n);
  inner.bottomRows(num_bubbles()) = calc_bubble_map(calc_full_stiffness(o));
  return inner * calc_map();
}

MatrixXd CurvedShell::calc_force_map(const Operators& o, const MatrixXd& inner_map) const {
  MatrixXd map(kNumForces * num_points(), inner_map.rows());
  const double area = calc_area();
  for (std::size_t q = 0; q < o.points.size(); ++q) {
    const auto& p = o.points[q];
    const ShellSection c = calc_section(static_cast<int>(q));
    auto at = map.middleRows<kNumForces>(kNumForces * static_cast<int>(q));
    at.topRows<3>() = c.A * p.membrane + c.B * p.bending;
    at.middleRows<3>(3) = c.B.transpose() * p.membrane + c.D * p.bending;
    at.bottomRows<2>() = calc_shear_stiffness(c, area) * p.shear;
  }
  MatrixXd result(num_internal_forces(), inner_map.cols());
  result.topRows(map.rows()) = map * inner_map;
  for (int q = 0; q < num_points(); ++q)
    result.row(map.rows() + q) = calc_section(q).drilling * o.points[static_cast<std::size_t>(q)].drilling;
  return result;
}

void CurvedShell::calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const {
  const Operators o = calc_operators(true);
  force = calc_force_map(o, calc_inner_map(o)) * u;
}

void CurvedShell::calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const {
  const Operators o = calc_operators(true);
  linear::multiply_dense(false, calc_force_map(o, calc_inner_map(o)), U, 0, forces);
}

std::vector<std::string> CurvedShell::internal_force_names() const {
  std::vector<std::string> names;
  for (std::size_t q = 1; q <= tying_->points.size(); ++q)
    for (const char* c : {"Nx", "Ny", "Nxy", "Mx", "My", "Mxy", "Qx", "Qy"})
      names.push_back(c + std::string("@") + std::to_string(q));
  for (int q = 1; q <= num_points(); ++q) names.push_back("Mz@" + std::to_string(q));
  return names;
}

void CurvedShell::calc_second_order(const Operators& o, const Eigen::Ref<const VectorXd>& force, MatrixXd& K,
                                    MatrixXd& at_nodes) const {
  const int n = num_full(), m = num_bubbles(), size = 6 * n + m, corners = tying_->num_corners;
  const bool quad = m == 4;
  // Forces that work on the covariant strains at the samples: e by tying, κ at the points, γ by tying.
  std::vector<Vector3d> on_e(tying_->samples.size(), Vector3d::Zero()), on_k = on_e, with_bubble = on_e;
  std::vector<Eigen::Vector2d> on_g(tying_->samples.size(), Eigen::Vector2d::Zero());
  VectorXd nodal = VectorXd::Zero(size);
  std::vector<double> on_drilling;
  Vector3d mean = Vector3d::Zero();  // a quadrilateral's mean strain is not tied
  if (quad) {
    double area = 0;
    for (std::size_t q = 0; q < o.points.size(); ++q) {
      mean += o.points[q].area * force.segment<3>(kNumForces * static_cast<int>(q));
      area += o.points[q].area;
    }
    mean /= area;
  }
  for (std::size_t q = 0; q < o.points.size(); ++q) {
    const auto& p = o.points[q];
    const auto& point = tying_->points[q];
    const auto f = p.area * force.segment<kNumForces>(kNumForces * static_cast<int>(q));
    const Vector3d N = p.to_local.transpose() * f.head<3>(), direct = p.area * p.to_local.transpose() * mean;
    const Eigen::Vector2d Q = p.J_inv.transpose() * f.tail<2>();
    for (const auto& tie : point.membrane)
      on_e[static_cast<std::size_t>(tie.sample)] += tie.weight.transpose() * (N - direct);
    for (const auto& tie : point.shear) on_g[static_cast<std::size_t>(tie.sample)] += tie.weight.transpose() * Q;
    on_e[static_cast<std::size_t>(point.sample)] += direct;
    with_bubble[static_cast<std::size_t>(point.sample)] += N;
    on_k[static_cast<std::size_t>(point.sample)] += p.to_local.transpose() * f.segment<3>(3);
    nodal += p.membrane.transpose() * f.head<3>() + p.bending.transpose() * f.segment<3>(3) +
             p.shear.transpose() * f.tail<2>();
    on_drilling.push_back(p.area * force[kNumForces * num_points() + static_cast<int>(q)]);
    nodal.head(6 * n) += on_drilling.back() * p.spin.transpose();
  }
  // u,a·u,b; u,a·d,b; u,a·d: scalar weights of the shapes, the bubble last.
  MatrixXd uu = MatrixXd::Zero(n + 1, n + 1), ud = uu;
  const auto form = [](const Vector3d& v) {
    Eigen::Matrix2d s;
    s << v[0], v[2], v[2], v[1];
    return s;
  };
  for (std::size_t k = 0; k < tying_->samples.size(); ++k) {
    const auto& at = tying_->samples[k];
    if (!on_e[k].isZero(0))
      uu.topLeftCorner(n, n) += at.dshape.leftCols(n).transpose() * form(on_e[k]) * at.dshape.leftCols(n);
    if (!with_bubble[k].isZero(0)) {  // with the bubble, whose strains are not tied
      const VectorXd with = at.dshape.transpose() * form(with_bubble[k]) * at.dshape.col(n);
      uu.col(n) += with;
      uu.row(n).head(n) += with.head(n).transpose();
    }
    if (!on_k[k].isZero(0)) ud += at.dshape.transpose() * form(on_k[k]) * at.dshape;
    if (!on_g[k].isZero(0)) ud += at.dshape.transpose() * on_g[k] * at.shape.transpose();
  }
  K.setZero(size, size);
  const auto add_block = [&](int row, int col, const MatrixXd& block) {
    K.block(row, col, block.rows(), block.cols()) += block;
  };
  const Matrix3d identity = Matrix3d::Identity();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int a = 0; a < 3; ++a) {
        K(6 * i + a, 6 * j + a) += uu(i, j);
        K(6 * i + a, 6 * j + 3 + a) += ud(i, j);
        K(6 * j + 3 + a, 6 * i + a) += ud(i, j);
      }
  for (int i = 0; i <= n; ++i)
    for (int j = i < n ? n : 0; j <= n; ++j) {
      // Bases of u and d of a node are the axes, those of a bubble the two tangents.
      const MatrixXd a = i < n ? MatrixXd(identity) : MatrixXd(bubble_);
      const MatrixXd b = j < n ? MatrixXd(identity) : MatrixXd(bubble_);
      const int u_i = i < n ? 6 * i : 6 * n + 2, u_j = j < n ? 6 * j : 6 * n + 2;
      const int d_j = j < n ? 6 * j + 3 : 6 * n;
      if (i == n && !quad) continue;
      const MatrixXd ab = a.transpose() * b;
      if (j < n || quad) add_block(u_i, u_j, uu(i, j) * ab);
      add_block(u_i, d_j, ud(i, j) * ab);
      add_block(d_j, u_i, ud(i, j) * ab.transpose());
    }
  at_nodes.setZero(num_dofs(), num_dofs());
  for (std::size_t q = 0; q < o.points.size(); ++q) {  // ½ (θz (u,x + v,y) - θx w,x - θy w,y)
    if (on_drilling[q] == 0) continue;
    const auto& p = o.points[q];
    const MatrixXd half = 0.5 * on_drilling[q] *
                          (p.turn.row(2).transpose() * (p.u_x.row(0) + p.u_y.row(1)) -
                           p.turn.row(0).transpose() * p.u_x.row(2) - p.turn.row(1).transpose() * p.u_y.row(2));
    at_nodes += half + half.transpose();
  }
  // Second order of d_i = exp(θ_i) V_i, at the ends of the arms too: V → V + θ×V + ½ (θ (θ·V) - V |θ|²).
  VectorXd on_arm = nodal.head(6 * n);
  for (int i = corners; i < n; ++i)
    if (place_[static_cast<std::size_t>(i)] < 0)
      for (int end : {i - corners, (i - corners + 1) % corners})
        on_arm.segment<3>(6 * end) += 0.5 * nodal.segment<3>(6 * i);
  for (int i = 0; i < n; ++i) {
    const Vector3d& V = normal_[static_cast<std::size_t>(i)];
    const bool present = place_[static_cast<std::size_t>(i)] >= 0;
    Vector3d g = nodal.segment<3>(6 * i + 3);
    if (present) g += z_offset_ * on_arm.segment<3>(6 * i);
    const Matrix3d H = 0.5 * (g * V.transpose() + V * g.transpose()) - g.dot(V) * Matrix3d::Identity();
    if (present) {
      at_nodes.block<3, 3>(find_dof(i, 3), find_dof(i, 3)) += H;
      continue;
    }
    const int ends[2] = {i - corners, (i - corners + 1) % corners};
    for (int a : ends)
      for (int b : ends) at_nodes.block<3, 3>(find_dof(a, 3), find_dof(b, 3)) += 0.25 * H;
  }
}

void CurvedShell::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                          Eigen::Ref<MatrixXd> K_G) const {
  const Operators o = calc_operators(true);
  const MatrixXd map = calc_inner_map(o);
  MatrixXd inner, at_nodes;
  calc_second_order(o, force, inner, at_nodes);
  K_G += scale * (map.transpose() * inner * map + at_nodes);
}

void CurvedShell::add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U,
                                                    const Eigen::Ref<const MatrixXd>& Phi,
                                                    GeometricProjection& sums) const {
  const Operators o = calc_operators(true);
  const MatrixXd map = calc_inner_map(o), force = calc_force_map(o, map) * U, inner_Phi = map * Phi;
  MatrixXd inner, at_nodes;
  auto terms = sums.add_terms(U.cols());
  terms.weights.setIdentity();
  for (Eigen::Index c = 0; c < U.cols(); ++c) {
    calc_second_order(o, force.col(c), inner, at_nodes);
    add_projection(inner, inner_Phi, terms.products.col(c));
    add_projection(at_nodes, Phi, terms.products.col(c));
  }
}

}  // namespace bough::fe
