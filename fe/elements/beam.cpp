#include "fe/elements/beam.hpp"

#include "base/rotation.hpp"

namespace bough::fe {

Matrix6d calc_section_mass(const BeamProperty& property, const BeamSection& s, bool bending) {
  const double rho_A = property.material.rho * s.A;
  const double mu = rho_A + s.nsm;
  Matrix6d m = Matrix6d::Zero();
  m.topLeftCorner<3, 3>() = mu * Matrix3d::Identity();
  if (property.has_torsional_inertia) m(3, 3) = property.material.rho * (s.I1 + s.I2);
  if (!property.has_section_inertia) return m;
  const Eigen::Vector2d first = rho_A * s.n + s.nsm * s.m;
  const Vector3d p(0, first[0], first[1]);
  m.topRightCorner<3, 3>() = -skew(p);
  m.bottomLeftCorner<3, 3>() = skew(p);
  const double rho = property.material.rho;
  double yy = rho_A * s.n[0] * s.n[0] + s.nsm * s.m[0] * s.m[0];
  double zz = rho_A * s.n[1] * s.n[1] + s.nsm * s.m[1] * s.m[1];
  double yz = rho_A * s.n[0] * s.n[1] + s.nsm * s.m[0] * s.m[1];
  m(3, 3) = yy + zz + rho * (s.I1 + s.I2) + s.nsi;
  if (bending) {
    yy += rho * s.I1;
    zz += rho * s.I2;
    yz += rho * s.I12;
  }
  m(4, 4) = zz;
  m(5, 5) = yy;
  m(4, 5) = m(5, 4) = -yz;
  return m;
}

Beam::Beam(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs,
           std::shared_ptr<const BeamProperty> property, const BeamGeometry& geometry,
           std::shared_ptr<const BeamField> field)
    : Element(id, std::move(card), std::move(nodes), std::move(gdofs)),
      property_(std::move(property)),
      geometry_(geometry),
      field_(std::move(field)) {
  BOUGH_DEMAND(num_dofs() == 12 && property_ && geometry_.length > 0);
  if (!field_) field_ = std::make_shared<BeamField>(*property_, geometry_.length);
  BOUGH_DEMAND(field_->length() == geometry_.length);
}

Matrix12d Beam::calc_release() const {
  Matrix12d C = Matrix12d::Identity();
  const unsigned pins = geometry_.pin_a | (geometry_.pin_b << 6);
  if (!pins) return C;
  const BeamField& field = *field_;
  const Matrix6x12d S = field.calc_relative();
  Matrix12d K = S.transpose() * field.calc_stiffness() * S;
  const Matrix12d K0 = K;
  for (int i = 0; i < 12; ++i) {
    // A pivot gone means that earlier releases leave nothing to release here: the dof then follows its grid.
    if (!(pins >> i & 1u) || !(K(i, i) > 1e-10 * K0(i, i))) continue;
    Matrix12d step = Matrix12d::Identity();
    step.row(i) = -K.row(i) / K(i, i);
    step(i, i) = 0;
    K = (step.transpose() * K * step).eval();
    C = (C * step).eval();
  }
  return C;
}

Matrix12d Beam::calc_arm_map() const {
  const Matrix3d R = geometry_.R_basic_element.transpose();
  Matrix12d T = Matrix12d::Zero();
  T.block<3, 3>(0, 0) = T.block<3, 3>(3, 3) = T.block<3, 3>(6, 6) = T.block<3, 3>(9, 9) = R;
  T.block<3, 3>(0, 3) = -R * skew(geometry_.wa);
  T.block<3, 3>(6, 9) = -R * skew(geometry_.wb);
  return T;
}

Matrix12d Beam::calc_end_map() const {
  if (!(geometry_.pin_a || geometry_.pin_b)) return calc_arm_map();
  return calc_release() * calc_arm_map();
}

void Beam::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  const BeamField& field = *field_;
  const Matrix6x12d A = field.calc_relative() * calc_end_map();
  const Matrix6x12d GA = scale * (field.calc_stiffness() * A);
  K.noalias() += A.transpose().lazyProduct(GA);
}

void Beam::add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const {
  kind == MassKind::Lumped ? add_lumped_mass(scale, M) : add_consistent_mass(scale, M);
}

void Beam::add_lumped_mass(double scale, Eigen::Ref<MatrixXd> M) const {
  const BeamField& field = *field_;
  Matrix6d end[2] = {Matrix6d::Zero(), Matrix6d::Zero()};
  for (const auto& point : field.calc_points(2, 3)) {
    const double t = point.x / geometry_.length;
    const Matrix6d m = calc_section_mass(*property_, property_->calc_section(t), false);
    end[0] += (1 - t) * point.weight * m;
    end[1] += t * point.weight * m;
  }
  // The mass sits on the rigid arms, so pins do not touch it.
  const Matrix3d R = geometry_.R_basic_element.transpose();
  for (int k = 0; k < 2; ++k) {
    Matrix6d T = Matrix6d::Zero();
    T.topLeftCorner<3, 3>() = T.bottomRightCorner<3, 3>() = R;
    T.topRightCorner<3, 3>() = -R * skew(k == 0 ? geometry_.wa : geometry_.wb);
    M.block<6, 6>(6 * k, 6 * k) += scale * T.transpose() * end[k] * T;
  }
}

void Beam::add_consistent_mass(double scale, Eigen::Ref<MatrixXd> M) const {
  const BeamField& field = *field_;
  Matrix12d local = Matrix12d::Zero();
  double mass = 0;
  for (const auto& point : field.calc_points(4, 7)) {
    const Matrix6d m = calc_section_mass(*property_, property_->calc_section(point.x / geometry_.length), true);
    Matrix6x12d D;
    field.calc_shape(point.x, &D, nullptr);
    const Matrix6x12d mD = point.weight * (m * D);
    local.noalias() += D.transpose().lazyProduct(mD);
    mass += point.weight * m(0, 0);
  }
  if (!property_->has_section_inertia && !property_->has_torsional_inertia && !geometry_.is_part) {
    // Nastran's coupled CBAR: the axial terms are the mean of lumped and consistent. BARMASS makes them consistent.
    local(0, 0) += mass / 12;
    local(6, 6) += mass / 12;
    local(0, 6) -= mass / 12;
    local(6, 0) -= mass / 12;
  }
  const Matrix12d T = calc_end_map();
  M += scale * (T.transpose() * (local * T));
}

void Beam::calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const {
  calc_internal_forces_of(u, force);
}

void Beam::calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const {
  const Matrix12d map = calc_end_map();
  const Matrix6d G = field_->calc_stiffness();
  const Matrix6x12d S = field_->calc_relative();
  for (Eigen::Index c = 0; c < U.cols(); ++c) {
    const Eigen::Matrix<double, 12, 1> u_end = map * U.col(c);
    const Eigen::Matrix<double, 6, 1> q = G * (S * u_end);
    forces.col(c) << q[0], q[1], q[2], q[3], q[4] - q[2] * geometry_.length, q[5] + q[1] * geometry_.length, q[4], q[5];
  }
}

std::vector<std::string> Beam::internal_force_names() const {
  return {"axial", "shear_y", "shear_z", "torque", "moment_y_a", "moment_z_a", "moment_y_b", "moment_z_b"};
}

void Beam::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                   Eigen::Ref<MatrixXd> K_G) const {
  const double N = force[0], Vy = force[1], Vz = force[2], T = force[3];
  const BeamField& field = *field_;
  Matrix12d local = Matrix12d::Zero();
  enum { du, dv, dw, rx, ry, rz, drx, dry, drz };
  for (const auto& point : field.calc_points(3, 7)) {
    const double t = point.x / geometry_.length;
    const double My = (1 - t) * force[4] + t * force[6], Mz = (1 - t) * force[5] + t * force[7];
    const BeamSection s = property_->calc_section(t);
    // Without torsional stiffness the twist is anybody's, AUTOSPC's in skew axes: no work for N on it.
    const double r2 = field.active().torsion ? s.n.squaredNorm() + (s.A > 0 ? (s.I1 + s.I2) / s.A : 0) : 0;
    // ½ qᵀ W q = second-order part of the stress power, docs/elements/beam.md eq. (7).
    Eigen::Matrix<double, 9, 9> W = Eigen::Matrix<double, 9, 9>::Zero();
    const auto set = [&](int i, int j, double value) { W(i, j) = W(j, i) = value; };
    W(dv, dv) = W(dw, dw) = N;
    W(drx, drx) = N * r2;
    set(rx, dw, Vy), set(rx, ry, 0.5 * Vy), set(rz, du, -Vy);
    set(rx, dv, -Vz), set(rx, rz, 0.5 * Vz), set(ry, du, Vz);
    set(dv, drx, -My), set(rx, drz, 0.5 * My), set(rz, drx, 0.5 * My);
    set(dw, drx, -Mz), set(rx, dry, -0.5 * Mz), set(ry, drx, -0.5 * Mz);
    set(rz, dry, 0.5 * T), set(ry, drz, -0.5 * T);
    Matrix6x12d D, e;
    field.calc_shape(point.x, &D, &e);
    Eigen::Matrix<double, 9, 12> Q;
    Q.row(du) = e.row(0);
    Q.row(dv) = e.row(1) + D.row(5);
    Q.row(dw) = e.row(2) - D.row(4);
    Q.middleRows<3>(rx) = D.bottomRows<3>();
    Q.middleRows<3>(drx) = e.bottomRows<3>();
    const Eigen::Matrix<double, 9, 12> WQ = point.weight * (W * Q);
    local.noalias() += Q.transpose().lazyProduct(WQ);
  }
  const Matrix12d map = calc_end_map();
  K_G += scale * (map.transpose() * (local * map));
  if (!geometry_.wa.isZero(0) || !geometry_.wb.isZero(0)) add_arm_stiffness(force, scale, K_G);
  if (geometry_.pin_a || geometry_.pin_b) add_pin_stiffness(force, scale, K_G);
}

/// Second-order motion of the arm tips, ½ θ×(θ×w), under the end forces.
void Beam::add_arm_stiffness(const Eigen::Ref<const VectorXd>& force, double scale, Eigen::Ref<MatrixXd> K_G) const {
  const Vector3d f_b = geometry_.R_basic_element * force.head<3>();
  for (int k = 0; k < 2; ++k) {
    const Vector3d w = k == 0 ? geometry_.wa : geometry_.wb, f = k == 0 ? Vector3d(-f_b) : f_b;
    const Matrix3d fw = f * w.transpose();
    K_G.block<3, 3>(6 * k + 3, 6 * k + 3) += scale * (0.5 * (fw + fw.transpose()) - f.dot(w) * Matrix3d::Identity());
  }
}

/// The axes of a release turn with the arm tip (u, θ): the end is at u + d + θ×d, turned by θ + h + ½ θ×h, where d and
/// h are the released motions.
void Beam::add_pin_stiffness(const Eigen::Ref<const VectorXd>& force, double scale, Eigen::Ref<MatrixXd> K_G) const {
  const Matrix12d tip = calc_arm_map();
  const Matrix12d released = (calc_release() - Matrix12d::Identity()) * tip;
  for (int k = 0; k < 2; ++k) {
    const double sign = k == 0 ? -1 : 1;
    const Vector3d f = sign * force.head<3>(), m = sign * Vector3d(force[3], force[4 + 2 * k], force[5 + 2 * k]);
    const Eigen::Matrix<double, 3, 12> theta = tip.middleRows<3>(6 * k + 3), d = released.middleRows<3>(6 * k),
                                       h = released.middleRows<3>(6 * k + 3);
    const Matrix12d half = -theta.transpose() * (skew(f) * d + 0.5 * skew(m) * h);
    K_G += scale * (half + half.transpose());
  }
}

}  // namespace bough::fe
