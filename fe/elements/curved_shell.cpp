#include "fe/elements/curved_shell.hpp"

#include <cmath>

#include "base/rotation.hpp"
#include "fe/elements/curved_shell_operators.hpp"

namespace bough::fe {

using Matrix3Xd = Eigen::Matrix3Xd;
using Matrix2Xd = Eigen::Matrix2Xd;

namespace {

/// The midside nodes that are not there, by their corners: position and normal. It is the mean of the surface, off the
/// grids by z_offset, that moves with the corners.
void fill_absent(CurvedShellGeometry& g) {
  const std::size_t n = g.is_present.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (g.is_present[k]) continue;
    const std::size_t a = k, b = (k + 1) % n;
    const Vector3d normals = g.normal[a] + g.normal[b];
    g.normal[n + k] = normals.normalized();
    g.x[n + k] = 0.5 * (g.x[a] + g.x[b]) + g.z_offset * (0.5 * normals - g.normal[n + k]);
  }
}

/// The direction side 1-2 has in the mean tangent plane, for the frames of all points.
Vector3d calc_direction(const std::vector<Vector3d>& x, const std::vector<Vector3d>& normals, Vector3d* normal) {
  *normal = Vector3d::Zero();
  for (const auto& v : normals) *normal += v;
  normal->normalize();
  const Vector3d side = x[1] - x[0];
  return (side - *normal * normal->dot(side)).normalized();
}

/// Axes with x along `direction` projected and z along the normal; J: rows r, s; columns the local x, y of x,r and x,s.
Matrix3d calc_axes(const Eigen::Matrix<double, 3, 2>& x, const Vector3d& direction, Eigen::Matrix2d* J, double* area) {
  const Vector3d normal = Vector3d(x.col(0)).cross(Vector3d(x.col(1)));
  *area = normal.norm();
  Matrix3d R;
  R.col(2) = normal / *area;
  R.col(0) = (direction - R.col(2) * R.col(2).dot(direction)).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  *J = x.transpose() * R.leftCols<2>();
  return R;
}

Matrix3d calc_to_local(const Eigen::Matrix2d& G) {
  Matrix3d t;
  t << G(0, 0) * G(0, 0), G(0, 1) * G(0, 1), G(0, 0) * G(0, 1), G(1, 0) * G(1, 0), G(1, 1) * G(1, 1), G(1, 0) * G(1, 1),
      2 * G(0, 0) * G(1, 0), 2 * G(0, 1) * G(1, 1), G(0, 0) * G(1, 1) + G(0, 1) * G(1, 0);
  return t;
}

}  // namespace

CurvedShell::CurvedShell(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs,
                         CurvedShellGeometry g, std::vector<ShellSection> sections, std::vector<double> angle)
    : Element(id, std::move(card), std::move(nodes), std::move(gdofs)),
      tying_(&get_shell_tying(static_cast<int>(g.is_present.size()))),
      z_offset_(g.z_offset),
      sections_(std::move(sections)),
      angle_(std::move(angle)) {
  fill_absent(g);
  const int corners = tying_->num_corners;
  int next = corners;
  for (int i = 0; i < num_full(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    x_.push_back(g.x[k] + z_offset_ * g.normal[k]);
    normal_.push_back(g.normal[k]);
    place_.push_back(i < corners ? i : g.is_present[static_cast<std::size_t>(i - corners)] ? next++ : -1);
  }
  Vector3d normal;
  const Vector3d side = calc_direction(x_, normal_, &normal);
  bubble_ << side, normal.cross(side);
}

std::vector<SurfaceFrame> CurvedShell::calc_frames(const CurvedShellGeometry& geometry) {
  CurvedShellGeometry g = geometry;
  fill_absent(g);
  const ShellTying& tying = get_shell_tying(static_cast<int>(g.is_present.size()));
  Vector3d normal;
  const Vector3d direction = calc_direction(g.x, g.normal, &normal);
  std::vector<SurfaceFrame> frames;
  for (const auto& point : tying.points) {
    const ShellSample& at = tying.samples[static_cast<std::size_t>(point.sample)];
    SurfaceFrame f;
    Eigen::Matrix<double, 3, 2> x = Eigen::Matrix<double, 3, 2>::Zero();
    Vector3d V = Vector3d::Zero();
    for (int i = 0; i < tying.num_nodes; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Vector3d p = g.x[k] + g.z_offset * g.normal[k];
      f.x += at.shape[i] * p;
      V += at.shape[i] * g.normal[k];
      x += p * at.dshape.col(i).transpose();
    }
    Eigen::Matrix2d J;
    f.R = calc_axes(x, direction, &J, &f.area);
    f.along_r = std::atan2(J(0, 1), J(0, 0));
    if (f.R.col(2).dot(V) < 0) f.area = -f.area;
    const double r = at.natural.x(), s = at.natural.y();
    if (tying.num_corners == 3)
      f.corner = Vector3d(1 - r - s, r, s);
    else
      f.corner = Eigen::Vector4d((1 - r) * (1 - s), (1 + r) * (1 - s), (1 + r) * (1 + s), (1 - r) * (1 + s)) / 4;
    frames.push_back(std::move(f));
  }
  return frames;
}

ElementShape CurvedShell::shape() const {
  const bool quad = tying_->num_corners == 4;
  if (static_cast<int>(nodes().size()) == num_full()) return {quad ? "quad8" : "tri6", nodes()};
  return {quad ? "quad4" : "tri3", {nodes().begin(), nodes().begin() + tying_->num_corners}};
}

CurvedShell::Surface CurvedShell::calc_surface(int sample) const {
  const ShellSample& at = tying_->samples[static_cast<std::size_t>(sample)];
  Surface f{Eigen::Matrix<double, 3, 2>::Zero(), Eigen::Matrix<double, 3, 2>::Zero(), Vector3d::Zero()};
  for (int i = 0; i < num_full(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    f.x += x_[k] * at.dshape.col(i).transpose();
    f.V_a += normal_[k] * at.dshape.col(i).transpose();
    f.V += at.shape[i] * normal_[k];
  }
  return f;
}

int CurvedShell::find_dof(int full_node, int component) const {
  return 6 * place_[static_cast<std::size_t>(full_node)] + component;
}

MatrixXd CurvedShell::calc_map() const {
  const int n = num_full(), corners = tying_->num_corners;
  MatrixXd map = MatrixXd::Zero(6 * n, num_dofs());
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (place_[k] < 0) continue;
    const Matrix3d turn = -skew(normal_[k]);  // θ × V
    map.block<3, 3>(6 * i, find_dof(i, 0)).setIdentity();
    map.block<3, 3>(6 * i, find_dof(i, 3)) = z_offset_ * turn;
    map.block<3, 3>(6 * i + 3, find_dof(i, 3)) = turn;
  }
  for (int i = corners; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (place_[k] >= 0) continue;
    const int a = i - corners, b = (a + 1) % corners;
    const Vector3d& V = normal_[k];
    map.middleRows(6 * i, 3) = 0.5 * (map.middleRows(6 * a, 3) + map.middleRows(6 * b, 3));
    // + V V·((θa - θb) × (xb - xa)) / 8: the middle of a beam that bends without shear.
    const Vector3d side = x_[static_cast<std::size_t>(b)] - x_[static_cast<std::size_t>(a)];
    const Matrix3d bend = V * side.cross(V).transpose() / 8;
    for (int end : {a, b}) {
      map.block<3, 3>(6 * i, find_dof(end, 3)) += (end == a ? 1 : -1) * bend;
      map.block<3, 3>(6 * i + 3, find_dof(end, 3)) = -0.5 * skew(V);
    }
  }
  return map;
}

ShellSection CurvedShell::calc_section(int point) const {
  const auto q = static_cast<std::size_t>(point);
  const ShellSection& section = sections_[sections_.size() == 1 ? 0 : q];
  return rotate_section(section, angle_[q]);
}

CurvedShell::Operators CurvedShell::calc_operators(bool with_drilling) const {
  const int n = num_full(), size = 6 * n + num_bubbles();
  const bool quad = tying_->num_corners == 4;
  Operators o;
  std::vector<Surface> surfaces;
  for (std::size_t k = 0; k < tying_->samples.size(); ++k) {
    const auto& at = tying_->samples[k];
    const Surface f = calc_surface(static_cast<int>(k));
    Eigen::Matrix<double, 5, Eigen::Dynamic> rows = Eigen::Matrix<double, 5, Eigen::Dynamic>::Zero(5, size);
    for (int i = 0; i <= n; ++i) {
      const double r = at.dshape(0, i), s = at.dshape(1, i), N = at.shape[i];
      Eigen::Matrix<double, 5, 3> of_u, of_d;
      of_u << r * f.x.col(0).transpose(), s * f.x.col(1).transpose(), (r * f.x.col(1) + s * f.x.col(0)).transpose(),
          r * f.V.transpose(), s * f.V.transpose();
      of_d << Matrix3d::Zero(), N * f.x.transpose();
      if (i < n) {
        rows.middleCols<3>(6 * i) = of_u;
        rows.middleCols<3>(6 * i + 3) = of_d;
      } else {
        rows.middleCols<2>(6 * n) = of_d * bubble_;
        if (quad) rows.middleCols<2>(6 * n + 2) = of_u * bubble_;
      }
    }
    o.membrane.push_back(rows.topRows<3>());
    o.shear.push_back(rows.bottomRows<2>());
    surfaces.push_back(f);
  }
  Matrix3Xd lost = Matrix3Xd::Zero(3, size);  // by tying, over the element
  double area = 0;
  const MatrixXd map = with_drilling ? calc_map() : MatrixXd();
  for (const auto& point : tying_->points) {
    const auto& at = tying_->samples[static_cast<std::size_t>(point.sample)];
    const Surface& f = surfaces[static_cast<std::size_t>(point.sample)];
    Operators::Point p;
    Eigen::Matrix2d J;
    const Matrix3d R = calc_axes(f.x, bubble_.col(0), &J, &p.area);
    p.area *= point.weight;
    p.J_inv = J.inverse();
    p.to_local = calc_to_local(p.J_inv);
    Matrix3Xd e = Matrix3Xd::Zero(3, size), k = Matrix3Xd::Zero(3, size);
    Matrix2Xd g = Matrix2Xd::Zero(2, size);
    for (const auto& tie : point.membrane) e += tie.weight * o.membrane[static_cast<std::size_t>(tie.sample)];
    for (const auto& tie : point.shear) g += tie.weight * o.shear[static_cast<std::size_t>(tie.sample)];
    for (int i = 0; i <= n; ++i) {
      const double r = at.dshape(0, i), s = at.dshape(1, i);
      Matrix3d of_u, of_d;
      of_u << r * f.V_a.col(0).transpose(), s * f.V_a.col(1).transpose(),
          (r * f.V_a.col(1) + s * f.V_a.col(0)).transpose();
      of_d << r * f.x.col(0).transpose(), s * f.x.col(1).transpose(), (r * f.x.col(1) + s * f.x.col(0)).transpose();
      if (i < n) {
        k.middleCols<3>(6 * i) = of_u;
        k.middleCols<3>(6 * i + 3) = of_d;
      } else {
        k.middleCols<2>(6 * n) = of_d * bubble_;
        if (!quad) continue;
        k.middleCols<2>(6 * n + 2) = of_u * bubble_;
        e.middleCols<2>(6 * n + 2) = of_d * bubble_;  // not tied: so it does no work on constant stress
      }
    }
    p.membrane = p.to_local * e;
    if (quad) {
      Matrix3Xd direct = o.membrane[static_cast<std::size_t>(point.sample)];
      direct.middleCols<2>(6 * n + 2) = e.middleCols<2>(6 * n + 2);
      lost += p.area * (p.to_local * direct - p.membrane);
      area += p.area;
    }
    p.bending = p.to_local * k;
    p.shear = p.J_inv * g;
    if (with_drilling) {
      p.drilling = Eigen::RowVectorXd::Zero(num_dofs());
      p.turn = p.u_x = p.u_y = Eigen::Matrix3Xd::Zero(3, num_dofs());
      p.spin = Eigen::RowVectorXd::Zero(6 * n);
      const int corners = tying_->num_corners;
      for (int i = 0; i < n; ++i) {
        const Eigen::Vector2d grad = p.J_inv * at.dshape.col(i);
        const Vector3d spin = 0.5 * (grad.x() * R.col(1) - grad.y() * R.col(0));
        p.drilling -= spin.transpose() * map.middleRows(6 * i, 3);
        p.spin.segment<3>(6 * i) = -spin.transpose();
        p.u_x += grad.x() * R.transpose() * map.middleRows(6 * i, 3);
        p.u_y += grad.y() * R.transpose() * map.middleRows(6 * i, 3);
        const bool present = place_[static_cast<std::size_t>(i)] >= 0;
        for (int end : {present ? i : i - corners, present ? i : (i - corners + 1) % corners}) {
          p.drilling.segment<3>(find_dof(end, 3)) += 0.5 * at.shape[i] * R.col(2).transpose();
          p.turn.middleCols<3>(find_dof(end, 3)) += 0.5 * at.shape[i] * R.transpose();
        }
      }
    }
    o.points.push_back(std::move(p));
  }
  // The mean strain is that of the displacements: so the patch test holds where the quadrilateral is no parallelogram.
  if (quad)
    for (auto& p : o.points) p.membrane += lost / area;
  return o;
}

MatrixXd CurvedShell::calc_full_stiffness(const Operators& o) const {
  const int size = 6 * num_full() + num_bubbles();
  MatrixXd K = MatrixXd::Zero(size, size);
  const double area = calc_area();
  for (std::size_t q = 0; q < o.points.size(); ++q) {
    const auto& p = o.points[q];
    const ShellSection c = calc_section(static_cast<int>(q));
    const Matrix3Xd N = c.A * p.membrane + c.B * p.bending, M = c.B.transpose() * p.membrane + c.D * p.bending;
    K.noalias() += p.area * (p.membrane.transpose() * N + p.bending.transpose() * M);
    K.noalias() += p.area * p.shear.transpose() * (calc_shear_stiffness(c, area) * p.shear);
  }
  return K;
}

MatrixXd CurvedShell::calc_bubble_map(const MatrixXd& full) const {
  const int n = 6 * num_full(), m = num_bubbles();
  // A property may lack the stiffness that a bubble needs (no bending, no membrane): it then stays at rest.
  const VectorXd diagonal = full.diagonal().tail(m);
  VectorXd scale(m);
  for (int b = 0; b < m; ++b) scale[b] = diagonal[b] > 0 ? 1 / std::sqrt(diagonal[b]) : 0;
  MatrixXd inner = scale.asDiagonal() * full.bottomRightCorner(m, m) * scale.asDiagonal();
  for (int b = 0; b < m; ++b)
    if (scale[b] == 0) inner(b, b) = 1;
  return -(scale.asDiagonal() * inner.ldlt().solve(MatrixXd(scale.asDiagonal() * full.bottomLeftCorner(m, n))));
}

void CurvedShell::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  const int n = 6 * num_full(), m = num_bubbles();
  const Operators o = calc_operators(true);
  const MatrixXd full = calc_full_stiffness(o), map = calc_map();
  MatrixXd inner = full.topLeftCorner(n, n);
  inner.noalias() += full.topRightCorner(n, m) * calc_bubble_map(full);
  inner = (0.5 * (inner + inner.transpose())).eval();
  K.noalias() += scale * (map.transpose() * inner.selfadjointView<Eigen::Lower>() * map);
  for (std::size_t q = 0; q < o.points.size(); ++q) {
    const auto& p = o.points[q];
    const double weight = p.area * calc_section(static_cast<int>(q)).drilling;
    K.noalias() += scale * weight * p.drilling.transpose() * p.drilling;
  }
}

}  // namespace bough::fe
