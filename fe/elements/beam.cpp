#include "fe/elements/beam.hpp"

#include <array>

#include "base/rotation.hpp"
#include "fe/elements/geometric_projection.hpp"

namespace bough::fe {

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
  if (!has_pins()) return calc_arm_map();
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

void Beam::add_at_grids(const Matrix12d& local, double scale, Eigen::Ref<MatrixXd> K) const {
  if (has_arms() || has_pins()) {
    const Matrix12d T = calc_end_map();
    K += scale * (T.transpose() * (local * T));
    return;
  }
  const Matrix3d& R = geometry_.R_basic_element;
  for (int i = 0; i < 12; i += 3)
    for (int j = 0; j < 12; j += 3) {
      const Matrix3d turned = R * local.block<3, 3>(i, j);
      K.block<3, 3>(i, j) += scale * (turned * R.transpose());
    }
}

void Beam::add_consistent_mass(double scale, Eigen::Ref<MatrixXd> M) const {
  BeamField::LineMass line = field_->calc_line_mass();
  if (!property_->has_section_inertia && !property_->has_torsional_inertia && !geometry_.is_part) {
    // Nastran's coupled CBAR: the axial terms are the mean of lumped and consistent. BARMASS makes them consistent.
    line.M(0, 0) += line.mass / 12;
    line.M(6, 6) += line.mass / 12;
    line.M(0, 6) -= line.mass / 12;
    line.M(6, 0) -= line.mass / 12;
  }
  add_at_grids(line.M, scale, M);
}

MassSamples Beam::sample_mass(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, const SpinAxis& spin) const {
  const Matrix3d& R = geometry_.R_basic_element;
  const bool is_consistent = kind == MassKind::Consistent;
  MassSamples samples;
  // U, Theta: motion of the axis of the beam at `place`, in basic; m: mass of the section in element axes.
  const auto add = [&](const Matrix6d& m, const Vector3d& place, const Matrix3Xd& U, const Matrix3Xd& Theta,
                       const Vector3d& arm) {
    MassSample s;
    s.mass = m(0, 0);
    const Vector3d p = s.mass > 0 ? Vector3d(0, m(3, 2), -m(3, 1)) / s.mass : Vector3d(Vector3d::Zero());
    s.arm = arm + R * p;
    s.r = place + R * p - spin.point;
    s.N = U - skew(R * p) * Theta;
    s.DN = -skew(spin.axis.cross(s.r)) * Theta;
    s.Theta = Theta;
    s.J = R * (m.bottomRightCorner<3, 3>() + s.mass * skew(p) * skew(p)) * R.transpose();
    samples.push_back(std::move(s));
  };
  if (is_consistent) {
    const Matrix12d T = calc_end_map();
    for (const auto& point : field_->calc_points(4, 7)) {
      Matrix6x12d D;
      field_->calc_shape(point.x, &D, nullptr);
      const Matrix6x12d motion = D * T;
      add(point.weight * calc_section_mass(*property_, property_->calc_section(point.x / geometry_.length), true),
          x.col(0) + geometry_.wa + R.col(0) * point.x, R * motion.topRows<3>(), R * motion.bottomRows<3>(),
          Vector3d::Zero());
    }
    return samples;
  }
  Matrix6d end[2] = {Matrix6d::Zero(), Matrix6d::Zero()};
  for (const auto& point : field_->calc_points(2, 3)) {
    const double t = point.x / geometry_.length;
    const Matrix6d m = point.weight * calc_section_mass(*property_, property_->calc_section(t), false);
    end[0] += (1 - t) * m;
    end[1] += t * m;
  }
  for (int k = 0; k < 2; ++k) {
    const Vector3d& arm = k == 0 ? geometry_.wa : geometry_.wb;
    Matrix3Xd U = Matrix3Xd::Zero(3, 12), Theta = U;
    U.middleCols<3>(6 * k).setIdentity();
    U.middleCols<3>(6 * k + 3) = -skew(arm);
    Theta.middleCols<3>(6 * k + 3).setIdentity();
    add(end[k], x.col(k) + arm, U, Theta, arm);
  }
  return samples;
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

namespace {

/// ½ qᵀ W q = second-order part of the stress power, docs/elements/beam.md eq. (7): W(i, j) = W(j, i) of each force.
struct StressTerm {
  enum Force { kN, kVy, kVz, kT, kMy, kMz } force;
  enum Motion { du, dv, dw, rx, ry, rz, drx, dry, drz } i, j;
  double factor;
  bool is_twist() const { return i == drx && j == drx; }  ///< its factor is r²
  static const std::array<StressTerm, 17> kAll;
};
// clang-format off
constexpr std::array<StressTerm, 17> StressTerm::kAll{{
    {kN, dv, dv, 1}, {kN, dw, dw, 1}, {kN, drx, drx, 1},
    {kVy, rx, dw, 1}, {kVy, rx, ry, 0.5}, {kVy, rz, du, -1},
    {kVz, rx, dv, -1}, {kVz, rx, rz, 0.5}, {kVz, ry, du, 1},
    {kT, rz, dry, 0.5}, {kT, ry, drz, -0.5},
    {kMy, dv, drx, -1}, {kMy, rx, drz, 0.5}, {kMy, rz, drx, 0.5},
    {kMz, dw, drx, -1}, {kMz, rx, dry, -0.5}, {kMz, ry, drx, -0.5}}};
// clang-format on

/// q of the section at x per displacements of the ends.
Eigen::Matrix<double, 9, 12> calc_stressed_motion(const BeamField& field, double x) {
  Matrix6x12d D, e;
  field.calc_shape(x, &D, &e);
  Eigen::Matrix<double, 9, 12> Q;
  Q.row(StressTerm::du) = e.row(0);
  Q.row(StressTerm::dv) = e.row(1) + D.row(5);
  Q.row(StressTerm::dw) = e.row(2) - D.row(4);
  Q.middleRows<3>(StressTerm::rx) = D.bottomRows<3>();
  Q.middleRows<3>(StressTerm::drx) = e.bottomRows<3>();
  return Q;
}

/// Polar radius² of the section. Without torsional stiffness the twist is undetermined, AUTOSPC's in skew axes: no work
/// for N on it.
double calc_twist_radius2(const BeamField& field, const BeamSection& s) {
  return field.active().torsion ? s.n.squaredNorm() + (s.A > 0 ? (s.I1 + s.I2) / s.A : 0) : 0;
}

}  // namespace

void Beam::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                   Eigen::Ref<MatrixXd> K_G) const {
  const BeamField& field = *field_;
  Matrix12d local = Matrix12d::Zero();
  for (const auto& point : field.calc_points(3, 7)) {
    const double t = point.x / geometry_.length;
    const double section[] = {
        force[0], force[1], force[2], force[3], (1 - t) * force[4] + t * force[6], (1 - t) * force[5] + t * force[7]};
    const double r2 = calc_twist_radius2(field, property_->calc_section(t));
    Eigen::Matrix<double, 9, 9> W = Eigen::Matrix<double, 9, 9>::Zero();
    for (const auto& term : StressTerm::kAll)
      W(term.i, term.j) = W(term.j, term.i) = section[term.force] * (term.is_twist() ? r2 : term.factor);
    const Eigen::Matrix<double, 9, 12> Q = calc_stressed_motion(field, point.x);
    const Eigen::Matrix<double, 9, 12> WQ = point.weight * (W * Q);
    local.noalias() += Q.transpose().lazyProduct(WQ);
  }
  add_at_grids(local, scale, K_G);
  if (has_arms()) add_arm_stiffness(force, scale, K_G);
  if (has_pins()) add_pin_stiffness(force, scale, K_G);
}

/// Products of q at the points, once for all loads. Arms and pins have separate terms.
void Beam::add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U, const Eigen::Ref<const MatrixXd>& Phi,
                                             GeometricProjection& sums) const {
  if (has_arms() || has_pins()) return StressState::add_projected_geometric_stiffness(U, Phi, sums);
  auto terms = sums.add_terms(num_internal_forces());
  MatrixXd force(num_internal_forces(), U.cols());
  calc_internal_forces_of(U, force);
  terms.weights = force;
  Eigen::Matrix<double, Eigen::Dynamic, 12> ends(Phi.cols(), 12);  // rows: columns of Φ in element axes
  for (int i = 0; i < 12; i += 3)
    ends.middleCols<3>(i) = Phi.middleRows<3>(i).transpose().lazyProduct(geometry_.R_basic_element);
  Eigen::Matrix<double, Eigen::Dynamic, 9> X(Phi.cols(), 9);
  for (const auto& point : field_->calc_points(3, 7)) {
    const double t = point.x / geometry_.length;
    const double r2 = calc_twist_radius2(*field_, property_->calc_section(t));
    X.noalias() = ends.lazyProduct(calc_stressed_motion(*field_, point.x).transpose());
    for (const auto& term : StressTerm::kAll) {
      const auto add = [&, factor = point.weight * (term.is_twist() ? r2 : term.factor)](int k, double share) {
        auto product = terms.products.col(k);
        if (term.i == term.j)
          add_square(X.col(term.i), share * factor, product);
        else
          add_cross(X.col(term.i), X.col(term.j), share * factor, product);
      };
      const bool is_moment = term.force == StressTerm::kMy || term.force == StressTerm::kMz;
      add(term.force, is_moment ? 1 - t : 1);  // moments: those of end A
      if (is_moment) add(term.force + 2, t);   // and of end B
    }
  }
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
