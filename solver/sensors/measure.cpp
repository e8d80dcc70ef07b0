// Measured value of each kind of sensor, without imperfections.
#include <algorithm>
#include <cmath>

#include "solver/motion/recovery.hpp"
#include "solver/sensors/sensor.hpp"

namespace bough::solver {
namespace {

using Eigen::Map;
using records::get_kind;
using records::SensorKind;
using records::SensorOf;
using records::SensorType;

/// Motion of the observer, in W; at rest for the inertial frame.
struct Observer {
  Place place;
  Vector3d v = Vector3d::Zero(), a = Vector3d::Zero();
  Vector3d w = Vector3d::Zero(), alpha = Vector3d::Zero();
};

Observer calc_observer(const Motion& motion, int body, int node) {
  Observer o;
  if (body < 0) return o;
  if (node > 0) {
    const NodeMotion k = calc_node_motion(motion, body, node);
    return {k.place(), k.v_WK, k.a_WK, k.w_WK, k.alpha_WK};
  }
  const BodyState& s = motion.get_state(body);
  o.place = s.calc_place(Vector3d::Zero());
  o.v.noalias() = s.R_WB * s.v_B;
  o.a.noalias() = s.R_WB * s.a_B;
  o.w.noalias() = s.R_WB * s.w_B;
  o.alpha.noalias() = s.R_WB * s.alpha_B;
  return o;
}

Matrix3d calc_orbital_axes(const Observer& o, const Sensor& e) {
  const Vector3d R = o.place.p_W - e.orbit->field().centre, h = R.cross(o.v);
  if (!(h.norm() > 0))
    throw ComputationError("run.no-orbit", {},
                           "sensor '" + e.name + "' has no LVLH frame: its body moves along the radius",
                           "give the body a velocity across the direction to the centre");
  Matrix3d axes;
  axes.col(2) = -R.normalized();
  axes.col(1) = -h.normalized();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  return axes;
}

/// The observer on the LVLH frame of a body, without accelerations: h/R² and the turning of the orbit plane by gravity,
/// (g·h)/h² R, with h = R × v. Other loads across the plane are left out; they are not known before accelerations.
Observer calc_orbital_observer(const Motion& motion, const Sensor& e) {
  const BodyState& s = motion.get_state(e.relative_to);
  Observer o;
  o.place = s.calc_place(Vector3d::Zero());
  o.v.noalias() = s.R_WB * s.v_B;
  const Vector3d R = o.place.p_W - e.orbit->field().centre;
  const Vector3d h = R.cross(o.v);
  o.w = h / R.squaredNorm();
  if (!h.isZero(0)) o.w += motion.gravity.calc_acceleration(e.relative_to, o.place.p_W).dot(h) / h.squaredNorm() * R;
  return o;
}

Vector3d calc_relative(SensorType type, bool from_turning, const NodeMotion& k, Observer o) {
  if (!from_turning) {  // he keeps his axes
    if (type == SensorType::AngularVelocity) return k.w_WK - o.w;
    if (type == SensorType::AngularAcceleration) return k.alpha_WK - o.alpha;
    o.w.setZero();
    o.alpha.setZero();
  }
  const Vector3d p = k.place() - o.place;
  if (type == SensorType::Position) return p;
  const Vector3d v = k.v_WK - o.v - o.w.cross(p);
  if (type == SensorType::Velocity) return v;
  const Vector3d w = k.w_WK - o.w;
  if (type == SensorType::AngularVelocity) return w;
  if (type == SensorType::AngularAcceleration) return k.alpha_WK - o.alpha - o.w.cross(w);
  return k.a_WK - o.a - o.alpha.cross(p) - o.w.cross(o.w.cross(p)) - 2 * o.w.cross(v);
}

/// Axes of a body, or of one of its nodes, in W; body >= 0.
Matrix3d calc_axes(const Motion& motion, int body, int node) {
  return node > 0 ? calc_node_motion(motion, body, node).R_WK : motion.get_state(body).R_WB;
}

Vector3d turn_into(const Motion& motion, const Sensor& e, const Vector3d& value_W) {
  if (e.frame < 0) return value_W;
  return calc_axes(motion, e.frame, e.frame_node).transpose() * value_W;
}

void measure_attitude(const Sensor& e, const Matrix3d& R, double* out) {
  if (e.type == SensorType::DirectionCosines) {
    Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{out} = R;
  } else if (e.type == SensorType::Euler) {
    Map<Vector3d>{out} = calc_euler_angles(R, e.axes);
  } else {
    Eigen::Quaterniond q(R);
    q.normalize();
    const double sign = q.w() < 0 ? -1 : 1;
    Map<Eigen::Vector4d>{out} = sign * Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  }
}

void measure_instrument(const Motion& motion, const Sensor& e, double* out) {
  const NodeMotion k = calc_node_motion(motion, e.body, e.node);
  const Matrix3d R_SW = (k.R_WK * e.mount).transpose();
  Map<Vector3d> value(out);
  if (e.type == SensorType::Gyro || e.type == SensorType::IntegratingGyro) {
    value.noalias() = R_SW * k.w_WK;
  } else if (e.type == SensorType::Accelerometer) {
    value.noalias() = R_SW * (k.a_WK - motion.gravity.calc_acceleration(e.body, k.p_WK));
  } else if (e.type == SensorType::Magnetometer) {
    value.noalias() = R_SW * motion.gravity.calc_magnetic_field(k.p_WK);
  } else if (e.type == SensorType::Direction) {
    value.noalias() = R_SW * e.target;
  } else {
    const Vector3d n = R_SW * (e.target - k.p_WK);
    out[0] = std::atan2(n.y(), n.z());
    out[1] = std::atan2(-n.x(), std::hypot(n.y(), n.z()));
  }
}

bool is_place(SensorType type) { return type == SensorType::HingeAngle || type == SensorType::Resolver; }

void measure_coordinate(const Motion& motion, const Sensor& e, double* out) {
  Eigen::Matrix<double, 7, 1> q, q_dot, force;
  const TreeBody& tb = motion.tree[e.body];
  const int nq = tb.num_hinge_q(), nu = tb.num_hinge_u();
  get_hinge(motion, e.body, q.head(nq), q_dot.head(nu), force.head(nu));
  const auto& value = is_place(e.type) ? q : q_dot;
  Map<VectorXd> result(out, e.size);
  result = value.segment(e.coordinate == 0 ? 0 : e.coordinate - 1, e.size);
  if (e.type != SensorType::Resolver) return;
  for (int i = 0; i < e.size; ++i)
    if (e.wraps[static_cast<size_t>(i)]) result[i] = std::remainder(result[i], 2 * EIGEN_PI);
}

void measure_modes(const Motion& motion, const Sensor& e, double* out) {
  const TreeBody& tb = motion.tree[e.body];
  const int n = tb.num_modes();
  const auto eta = motion.data.q.segment(tb.eta_offset(), n);
  if (e.type == SensorType::StrainEnergy) {
    *out = tb.body.calc_strain_energy(eta);
    return;
  }
  const int first = e.coordinate == 0 ? 0 : e.coordinate - 1;
  Map<VectorXd> result(out, e.size);
  if (e.type == SensorType::ModalCoordinate)
    result = eta.segment(first, e.size);
  else
    result = motion.data.u.segment(tb.eta_dot_offset() + first, e.size);
}

/// Position and attitude of an optical node in A, the body or node of relative_to; W without.
void calc_placement(const Motion& motion, const Sensor& e, const SightTerm& term, Vector3d& p_AK, Matrix3d& R_AK) {
  const NodeMotion k = calc_node_motion(motion, term.body, term.node);
  p_AK = k.p_WK;
  R_AK = k.R_WK;
  if (e.relative_to < 0) return;
  const Matrix3d R_AW = calc_axes(motion, e.relative_to, e.relative_node).transpose();
  p_AK = R_AW * (k.place() - calc_observer(motion, e.relative_to, e.relative_node).place);
  R_AK = R_AW * k.R_WK;
}

void measure_sight(const Motion& motion, const Sensor& e, double* out) {
  Vector3d sum = Vector3d::Zero(), p;
  Matrix3d R;
  for (const SightTerm& term : e.terms) {
    calc_placement(motion, e, term, p, R);
    const Eigen::AngleAxisd turn(Matrix3d(R * term.R_AK.transpose()));
    sum += term.displacement * (p - term.p_AK) + term.rotation * (turn.angle() * turn.axis());
  }
  std::copy_n(sum.data(), e.size, out);
}

}  // namespace

void set_reference(const Motion& motion, Sensor& e) {
  for (SightTerm& term : e.terms) calc_placement(motion, e, term, term.p_AK, term.R_AK);
}

Vector3d calc_euler_angles(const Matrix3d& R, const std::array<int, 3>& axes) {
  const int i = axes[0], j = axes[1], k = axes[2] == i ? 3 - i - j : axes[2];
  const double s = (j - i + 3) % 3 == 1 ? 1 : -1;  // of (i, j, k) as a permutation
  if (axes[2] != i)
    return {std::atan2(-s * R(j, k), R(k, k)), std::asin(std::clamp(s * R(i, k), -1.0, 1.0)),
            std::atan2(-s * R(i, j), R(i, i))};
  return {std::atan2(R(j, i), -s * R(k, i)), std::acos(std::clamp(R(i, i), -1.0, 1.0)),
          std::atan2(R(i, j), s * R(i, k))};
}

void measure(const Motion& motion, const Sensor& e, double* out) {
  switch (get_kind(e.type).of) {
    case SensorOf::Coordinate:
      return measure_coordinate(motion, e, out);
    case SensorOf::Instrument:
      return measure_instrument(motion, e, out);
    case SensorOf::Modes:
    case SensorOf::Energy:
      return measure_modes(motion, e, out);
    case SensorOf::HingeLoad: {
      const HingeReaction r = calc_hinge_reaction(motion.tree, motion.data, e.body);
      Map<Vector3d>{out} = e.type == SensorType::HingeForce ? r.force : r.moment;
      return;
    }
    case SensorOf::Attitude: {
      const Matrix3d R_WS = calc_node_motion(motion, e.body, e.node).R_WK * e.mount;
      if (e.relative_to < 0) return measure_attitude(e, R_WS, out);
      if (e.orbit != nullptr) {
        const Matrix3d R_WL = calc_orbital_axes(calc_orbital_observer(motion, e), e);
        return measure_attitude(e, R_WL.transpose() * R_WS, out);
      }
      return measure_attitude(e, calc_axes(motion, e.relative_to, e.relative_node).transpose() * R_WS, out);
    }
    case SensorOf::Optics:
      return measure_sight(motion, e, out);
    case SensorOf::Element:
      return e.recovery->calc(motion, e.row, e.size, out);
    case SensorOf::Gap: {
      Place other{e.target, e.target};
      if (e.to_body >= 0) other = calc_node_motion(motion, e.to_body, e.to_node).place();
      *out = (calc_node_motion(motion, e.body, e.node).place() - other).norm();
      return;
    }
    case SensorOf::Elastic: {
      Vector3d deflection, rotation;
      calc_node_deflection(motion, e.body, e.node, deflection, rotation);
      const Vector3d& value_B = e.type == SensorType::Deflection ? deflection : rotation;
      Map<Vector3d>{out} = e.frame == e.body && e.frame_node == 0
                               ? value_B
                               : turn_into(motion, e, motion.get_state(e.body).R_WB * value_B);
      return;
    }
    case SensorOf::Point:
      if (e.orbit != nullptr) {
        const Observer o = calc_orbital_observer(motion, e);
        const Vector3d value = calc_relative(e.type, e.from_turning, calc_node_motion(motion, e.body, e.node), o);
        Map<Vector3d>{out} =
            e.in_orbital_frame ? Vector3d(calc_orbital_axes(o, e).transpose() * value) : turn_into(motion, e, value);
        return;
      }
      Map<Vector3d>{out} = turn_into(motion, e,
                                     calc_relative(e.type, e.from_turning, calc_node_motion(motion, e.body, e.node),
                                                   calc_observer(motion, e.relative_to, e.relative_node)));
      return;
  }
}

void mark_motion(const Tree& tree, const Sensor& e, std::vector<bool>& q, std::vector<bool>& u) {
  const auto fill = [](std::vector<bool>& rows, int first, int count) {
    std::fill_n(rows.begin() + first, count, true);
  };
  const SensorKind& kind = get_kind(e.type);
  if (kind.reads_acceleration) {
    q.assign(q.size(), true);
    u.assign(u.size(), true);
    return;
  }
  const TreeBody& own = tree[std::max(0, e.body)];
  switch (kind.of) {
    case SensorOf::Coordinate:
      fill(q, own.q_offset, own.num_hinge_q());
      fill(u, own.u_offset, is_place(e.type) ? 0 : own.num_hinge_u());
      return;
    case SensorOf::Modes:
    case SensorOf::Energy:
      fill(q, own.eta_offset(), own.num_modes());
      fill(u, own.eta_dot_offset(), e.type == SensorType::ModalRate ? own.num_modes() : 0);
      return;
    default:
      break;
  }
  const bool reads_rates = e.type == SensorType::Velocity || e.type == SensorType::AngularVelocity ||
                           e.type == SensorType::Gyro || e.type == SensorType::IntegratingGyro || e.orbit != nullptr;
  const auto mark_path = [&](int b) {
    for (; b >= 0; b = tree[b].parent) {
      const TreeBody& tb = tree[b];
      fill(q, tb.q_offset, tb.num_hinge_q() + tb.num_modes());
      if (reads_rates) fill(u, tb.u_offset, tb.num_hinge_u() + tb.num_modes());
    }
  };
  for (const int b : {e.body, e.frame, e.relative_to, e.to_body}) mark_path(b);
  for (const SightTerm& term : e.terms) mark_path(term.body);
}

}  // namespace bough::solver
