#include "fe/elements/shear_panel.hpp"

#include "fe/sections/stress.hpp"
#include "fe/shape/gauss.hpp"

namespace bough::fe {

namespace {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix2x4d = Eigen::Matrix<double, 2, 4>;

Vector3d calc_normal(const std::array<Vector3d, 4>& x) { return (x[2] - x[0]).cross(x[3] - x[1]).normalized(); }

/// Bilinear shapes on the unit square, corners 1 to 4 counterclockwise from the origin, with derivatives.
void calc_bilinear(double r, double s, Eigen::Vector4d* N, Matrix2x4d* dN) {
  *N << (1 - r) * (1 - s), r * (1 - s), r * s, (1 - r) * s;
  *dN << -(1 - s), 1 - s, s, -s, -(1 - r), -r, r, 1 - r;
}

/// The shapes w_i N_i / w and their derivatives; returns w.
double calc_rational(const Eigen::Vector4d& weight, double r, double s, Eigen::Vector4d* F, Matrix2x4d* dF) {
  Eigen::Vector4d N;
  Matrix2x4d dN;
  calc_bilinear(r, s, &N, &dN);
  const double w = weight.dot(N);
  const Eigen::Vector2d dw = dN * weight;
  *F = weight.cwiseProduct(N) / w;
  *dF = (dN * weight.asDiagonal() - dw * F->transpose()) / w;
  return w;
}

}  // namespace

double ShearPanel::calc_area(const std::array<Vector3d, 4>& x) { return 0.5 * (x[2] - x[0]).cross(x[3] - x[1]).norm(); }

Eigen::Vector4d ShearPanel::calc_weights(const std::array<Vector3d, 4>& x) {
  const Vector3d normal = calc_normal(x);
  Eigen::Vector4d w;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d &a = x[(i + 1) % 4], &b = x[(i + 2) % 4], &c = x[(i + 3) % 4];
    w[static_cast<Eigen::Index>(i)] = normal.dot((b - a).cross(c - a));
  }
  return 4 * w / w.sum();
}

ShearPanel::ShearPanel(int id, std::vector<int> nodes, std::vector<int> gdofs, const std::array<Vector3d, 4>& x,
                       const ShearPanelProperty& property)
    : Element(id, "CSHEAR", std::move(nodes), std::move(gdofs)),
      x_(x),
      property_(property),
      weight_(calc_weights(x)),
      mass_(Eigen::Vector4d::Zero()),
      forces_(Vector12d::Zero()) {
  const Vector3d normal = calc_normal(x);
  Eigen::Matrix<double, 3, 4> flat;  // on the mean plane
  for (int i = 0; i < 4; ++i) flat.col(i) = x[static_cast<std::size_t>(i)];
  flat -= normal * (normal.transpose() * flat);
  // On the panel for s = 1: along sides 1-2 and 4-1 backward, along 2-3 and 4-3 forward.
  constexpr double kSense[4] = {-1, 1, -1, 1};
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    const Vector3d half = 0.5 * kSense[i] * weight_[i] * weight_[j] * (flat.col(j) - flat.col(i));
    forces_.segment<3>(3 * i) += half;
    forces_.segment<3>(3 * j) += half;
  }
  // Normal forces of least norm: no resultant, and the moments of the forces above about the true corners undone.
  Eigen::Matrix<double, 3, 4> balance;
  Vector3d moment = Vector3d::Zero(), centre = flat.rowwise().mean();
  const Vector3d a = (flat.col(1) - flat.col(0)).normalized(), b = normal.cross(a);
  for (int i = 0; i < 4; ++i) {
    const Vector3d arm = x[static_cast<std::size_t>(i)] - centre;
    moment += arm.cross(Vector3d(forces_.segment<3>(3 * i)));
    balance.col(i) << 1, a.dot(arm.cross(normal)), b.dot(arm.cross(normal));
  }
  const Eigen::Vector4d kick =
      -balance.completeOrthogonalDecomposition().solve(Vector3d(0, a.dot(moment), b.dot(moment)));
  for (int i = 0; i < 4; ++i) forces_.segment<3>(3 * i) += kick[i] * normal;

  // With N = s w²/J (x,r x,s + x,s x,r): complementary energy ∫ (N:N - ν/(1+ν) tr² N) / (2 G t) dA / 2.
  for (const auto& p : get_gauss_points(8))
    for (const auto& q : get_gauss_points(8)) {
      Eigen::Vector4d F;
      Matrix2x4d dF;
      const double w = calc_rational(weight_, p.x, q.x, &F, &dF), weight = p.weight * q.weight;
      const Vector3d r = flat * dF.row(0).transpose(), s = flat * dF.row(1).transpose();
      const double J = normal.dot(r.cross(s)), c = w * w / J, rs = r.dot(s);
      const double NN = 2 * c * c * (r.squaredNorm() * s.squaredNorm() + rs * rs), trace = 2 * c * rs;
      flexibility_ +=
          weight * J * (NN - property_.nu / (1 + property_.nu) * trace * trace) / (2 * property_.G * property_.t);
      Eigen::Vector4d N;
      calc_bilinear(p.x, q.x, &N, &dF);
      const double area =
          normal.dot(Vector3d(flat * dF.row(0).transpose()).cross(Vector3d(flat * dF.row(1).transpose())));
      mass_ += weight * area * property_.mass * N;
    }
}

Vector3d ShearPanel::calc_side(int side, double* length) const {
  const Vector3d d = x_[static_cast<std::size_t>((side + 1) % 4)] - x_[static_cast<std::size_t>(side)];
  *length = d.norm();
  return d / *length;
}

void ShearPanel::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  K.noalias() += scale / flexibility_ * forces_ * forces_.transpose();
  for (int i = 0; i < 4; ++i) {
    double length = 0;
    const Vector3d e = calc_side(i, &length);
    const Matrix3d k =
        scale * property_.E * property_.rod_area[static_cast<std::size_t>(i)] / length * e * e.transpose();
    const int a = 3 * i, b = 3 * ((i + 1) % 4);
    K.block<3, 3>(a, a) += k;
    K.block<3, 3>(b, b) += k;
    K.block<3, 3>(a, b) -= k;
    K.block<3, 3>(b, a) -= k;
  }
}

void ShearPanel::add_mass(MassKind, double scale, Eigen::Ref<MatrixXd> M) const {
  for (int i = 0; i < 4; ++i) M.block<3, 3>(3 * i, 3 * i).diagonal().array() += scale * mass_[i];
}

void ShearPanel::calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const {
  const double s = forces_.dot(u) / flexibility_;
  for (int i = 0; i < 4; ++i) {
    force[i] = s * weight_[i] * weight_[(i + 1) % 4];
    double length = 0;
    const Vector3d e = calc_side(i, &length);
    force[4 + i] = property_.E * property_.rod_area[static_cast<std::size_t>(i)] / length *
                   e.dot(u.segment<3>(3 * ((i + 1) % 4)) - u.segment<3>(3 * i));
  }
}

std::vector<std::string> ShearPanel::internal_force_names() const {
  return {"q12", "q23", "q34", "q41", "N12", "N23", "N34", "N41"};
}

std::vector<StressPoint> ShearPanel::stress_points() const {
  std::vector<StressPoint> points;
  for (const char* side : {"12", "23", "34", "41"}) {
    points.emplace_back().name = side;
    points.back().kind = StressKind::Shear;
  }
  return points;
}

MatrixXd ShearPanel::calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const {
  return forces.topRows(4) / property_.t;
}

MatrixXd ShearPanel::calc_strains(const Eigen::Ref<const MatrixXd>& forces) const {
  return calc_stresses(forces) / property_.G;
}

void ShearPanel::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                         Eigen::Ref<MatrixXd> K_G) const {
  Eigen::Matrix4d of = Eigen::Matrix4d::Zero();
  for (const auto& p : get_gauss_points(8))
    for (const auto& q : get_gauss_points(8)) {
      Eigen::Vector4d F;
      Matrix2x4d dF;
      const double w = calc_rational(weight_, p.x, q.x, &F, &dF);
      const Eigen::Matrix4d one = dF.row(0).transpose() * dF.row(1);
      of += p.weight * q.weight * w * w * (one + one.transpose());
    }
  of *= force[0] / (weight_[0] * weight_[1]);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) K_G.block<3, 3>(3 * i, 3 * j).diagonal().array() += scale * of(i, j);
  for (int i = 0; i < 4; ++i) {
    double length = 0;
    const Vector3d e = calc_side(i, &length);
    const Matrix3d k = scale * force[4 + i] / length * (Matrix3d::Identity() - e * e.transpose());
    const int a = 3 * i, b = 3 * ((i + 1) % 4);
    K_G.block<3, 3>(a, a) += k;
    K_G.block<3, 3>(b, b) += k;
    K_G.block<3, 3>(a, b) -= k;
    K_G.block<3, 3>(b, a) -= k;
  }
}

}  // namespace bough::fe
