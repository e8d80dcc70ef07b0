// Forces of the second route: gravity, springs, tables, friction, bushings, contacts, drag.
#include <algorithm>
#include <cmath>

#include "tests/solver/support/dense_equations.hpp"

namespace bough::solver::testing::dense_route {

namespace {

/// Velocity in W of the point of a body that is at r, the body moving as the frame.
Vector3d calc_velocity_at(const Pose& frame, const Vector3d& r) {
  return frame.p.d1 + get_axial(frame.R.d1 * frame.R.at.transpose()).cross(r - frame.p.at);
}

/// Rate of [p; θ] of a bushing, θ by differences of the logarithm along the turn.
Vector6d calc_bushing_rate(const Pose& from, const Pose& to) {
  const Mat T = from.R.transpose();
  const Mat R = T * to.R;
  const Vector3d w = get_axial(R.d1 * R.at.transpose());
  const auto calc_vector = [&](double s) -> Vector3d {
    const Matrix3d turned = Eigen::AngleAxisd(s * w.norm(), w.normalized()).toRotationMatrix() * R.at;
    const Eigen::AngleAxisd turn(turned);
    return turn.angle() * turn.axis();
  };
  Vector6d rate;
  rate << (T * (to.p - from.p)).d1, w.isZero(0) ? Vector3d::Zero() : differentiate(calc_vector, 0.01 / w.norm());
  return rate;
}

/// Polynomials a_k x^k of the intervals, all from one system of equations.
double calc_cubic(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto n = static_cast<Eigen::Index>(x.size()) - 1;
  LongMatrix A = LongMatrix::Zero(4 * n, 4 * n);
  LongVector b = LongVector::Zero(4 * n);
  Eigen::Index row = 0;
  /// Derivative d at x[k] of the polynomial of interval i, in powers of the distance from x[i].
  const auto add = [&](Eigen::Index i, Eigen::Index k, int d, long double sign) {
    const long double s = static_cast<long double>(x[static_cast<size_t>(k)]) - x[static_cast<size_t>(i)];
    for (int power = d; power < 4; ++power) {
      long double factor = sign;
      for (int f = 0; f < d; ++f) factor *= power - f;
      A(row, 4 * i + power) += factor * std::pow(s, static_cast<long double>(power - d));
    }
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    for (const Eigen::Index k : {i, i + 1}) {
      add(i, k, 0, 1);
      b[row++] = y[static_cast<size_t>(k)];
    }
  }
  for (Eigen::Index i = 1; i < n; ++i) {
    for (int d = 1; d <= (i == 1 || i == n - 1 ? 3 : 2); ++d) {
      add(i - 1, i, d, 1);
      add(i, i, d, -1);
      ++row;
    }
  }
  BOUGH_DEMAND(row == 4 * n);
  const LongVector a = A.fullPivLu().solve(b);
  Eigen::Index i = 0;
  while (i + 1 < n && at > x[static_cast<size_t>(i) + 1]) ++i;
  const long double s = static_cast<long double>(at) - x[static_cast<size_t>(i)];
  return static_cast<double>(a[4 * i] + s * (a[4 * i + 1] + s * (a[4 * i + 2] + s * a[4 * i + 3])));
}

}  // namespace

double calc_table(const records::FunctionRecord& table, double x) {
  BOUGH_DEMAND(table.type == "table");
  if (x <= table.x.front()) return table.y.front();
  if (x >= table.x.back()) return table.y.back();
  if (table.interpolation == "cubic") return calc_cubic(table.x, table.y, x);
  size_t i = 1;
  while (table.x[i] < x) ++i;
  const double share = (x - table.x[i - 1]) / (table.x[i] - table.x[i - 1]);
  return (1 - share) * table.y[i - 1] + share * table.y[i];
}

VectorXd Route::displace(const VectorXd& q, int b, int i, double s) const {
  VectorXd moved = q;
  const TreeBody& tb = tree_[b];
  const bool turns = has_quaternion(get_hinge(b).type);
  if (turns && i < 3) {
    Eigen::Vector4d turn = Eigen::Vector4d::Zero();
    turn[i] = std::sin(0.5 * s);
    turn[3] = std::cos(0.5 * s);
    moved.segment<4>(tb.q_offset) = multiply_quaternions(q.segment<4>(tb.q_offset), turn);
  } else {
    moved[tb.q_offset + i + (turns ? 1 : 0)] += s;
  }
  return moved;
}

double Route::calc_spring_energy(int b, const VectorXd& q) const {
  const auto& h = get_hinge(b);
  const TreeBody& tb = tree_[b];
  double energy = 0;
  const int turns = has_quaternion(h.type) ? 3 : 0;
  for (int i = turns; i < static_cast<int>(h.stiffness.size()); ++i) {
    const double rest = h.null_position.empty() ? 0 : h.null_position[static_cast<size_t>(i)];
    const double stretch = q[tb.q_offset + i + (turns ? 1 : 0)] - rest;
    energy += 0.5 * h.stiffness[static_cast<size_t>(i)] * stretch * stretch;
  }
  if (turns && !h.stiffness.empty()) {
    const Eigen::Vector4d at = q.segment<4>(tb.q_offset);
    const double s = at.head<3>().norm();
    const Vector3d theta = 2 * std::atan2(s, at[3]) / s * at.head<3>();
    for (int i = 0; i < 3; ++i) energy += 0.5 * h.stiffness[static_cast<size_t>(i)] * theta[i] * theta[i];
  }
  return energy;
}

double Route::calc_central_energy(const records::ForceElementRecord& field, const Motion& poses,
                                  const VectorXd& q) const {
  double energy = 0;
  const Vector3d pole = field.axis.normalized();
  for (int b = 0; b < tree_.size(); ++b) {
    const MatrixXd M = calc_mass(b, get_eta(b, q));
    const double m = M(0, 0);
    const Vector3d S(M(5, 1), M(3, 2), M(4, 0));
    const Matrix3d J = M.block<3, 3>(3, 3), R = poses.X[static_cast<size_t>(b)].R.at;
    const Matrix3d P = R * (0.5 * J.trace() * Matrix3d::Identity() - J - S * S.transpose() / m) * R.transpose();
    const Vector3d d = poses.X[static_cast<size_t>(b)].p.at + R * S / m - field.centre;
    const double r = d.norm();
    const Vector3d n = d / r;
    energy += -field.mu * m / r - field.mu / (2 * r * r * r) * (3 * n.dot(P * n) - P.trace());
    const double latitude = std::asin(n.dot(pole)), sine = std::sin(latitude);
    energy += field.mu * m / r * field.j2 * std::pow(field.equator / r, 2) * (3 * sine * sine - 1) / 2;
  }
  return energy;
}

void Route::add_forces(const Motion& motion, Acting& to) const {
  for (int b = 0; b < tree_.size(); ++b) add_hinge(b, to);
  for (const auto& force : spec_.forces) {
    const int b = find_body(force.body);
    const auto get_node = [&](const Motion& poses) {
      return calc_marker(b, force.node, Vector3d::Zero(), Matrix3d::Identity(), poses);
    };
    Vector3d f = calc_function(force.function)[0] * force.direction;
    if (force.frame == records::VectorFrame::Body) f = motion.X[static_cast<size_t>(b)].R.at * f;
    if (force.frame == records::VectorFrame::Node) f = get_node(motion).R.at * f;
    const bool is_force = force.kind == records::ForceKind::Force;
    to.power +=
        add_wrench(get_node, motion, is_force ? f : Vector3d::Zero(), is_force ? Vector3d::Zero() : f, to.force);
  }
  for (const auto& element : spec_.force_elements) {
    switch (element.type) {
      case records::ElementType::CentralGravity:
        add_central(element, to);
        break;
      case records::ElementType::Bushing:
        add_bushing(element, motion, to);
        break;
      case records::ElementType::Contact:
        add_contact(element, motion, to);
        break;
      case records::ElementType::Drag:
        add_drag(element, motion, to);
        break;
      default:
        BOUGH_DEMAND(element.type == records::ElementType::Spring);
        add_spring(element, motion, to);
    }
  }
}

void Route::add_hinge(int b, Acting& to) const {
  const TreeBody& tb = tree_[b];
  const auto& h = get_hinge(b);
  for (int i = 0; i < tb.num_hinge_u(); ++i) {
    const int row = tb.u_offset + i;
    if (discrete_.mode[static_cast<size_t>(row)] != HingeMode::Free) continue;
    if (!h.stiffness.empty())
      to.force[row] -= differentiate([&](double s) { return calc_spring_energy(b, displace(q_, b, i, s)); }, 0.005);
    if (!has_quaternion(h.type)) add_hinge_law(b, i, to);
    if (h.damping.empty()) continue;
    to.force[row] -= h.damping[static_cast<size_t>(i)] * u_[row];
    to.dissipated += h.damping[static_cast<size_t>(i)] * u_[row] * u_[row];
  }
}

void Route::add_hinge_law(int b, int i, Acting& to) const {
  const auto& h = get_hinge(b);
  const auto& law = h.law;
  const auto k = static_cast<size_t>(i);
  const double q = q_[tree_[b].q_offset + i], rate = u_[tree_[b].u_offset + i];
  double elastic = law.preload.empty() ? 0 : law.preload[k], resisting = 0;
  if (!law.spring_table.empty() && !law.spring_table[k].empty())
    elastic -= calc_table(find_function(law.spring_table[k]), q - (h.null_position.empty() ? 0 : h.null_position[k]));
  if (!law.damper_table.empty() && !law.damper_table[k].empty())
    resisting += calc_table(find_function(law.damper_table[k]), rate);
  if (law.has_friction && law.coulomb[k] > 0) {
    const double width = law.smoothing.empty() ? 0 : law.smoothing[k];
    const double more = law.static_friction.empty() ? 0 : law.static_friction[k] - law.coulomb[k];
    const double v = law.stribeck_velocity.empty() ? 0 : law.stribeck_velocity[k];
    const double size = law.coulomb[k] + (v > 0 ? more / std::exp(rate * rate / (v * v)) : 0);
    resisting += width > 0 ? size * std::tanh(rate / width) : rate > 0 ? size : -size;
  }
  if (law.has_stops) {
    const double above = q - law.stop_upper[k], below = law.stop_lower[k] - q, depth = std::max(above, below);
    if (depth > 0) {
      const double into = above > 0 ? rate : -rate, outward = above > 0 ? -1 : 1;
      const double spring = law.stop_stiffness[k] * depth;
      const double whole = std::max(0.0, spring * (1 + law.stop_damping[k] * into));
      elastic += outward * spring;
      resisting -= outward * (whole - spring);
    }
  }
  to.force[tree_[b].u_offset + i] += elastic - resisting;
  to.dissipated += resisting * rate;
}

void Route::add_central(const records::ForceElementRecord& field, Acting& to) const {
  const VectorXd none = VectorXd::Zero(tree_.num_u);
  const auto calc_energy = [&](const VectorXd& q) { return calc_central_energy(field, calc_poses(q, none, none), q); };
  for (int b = 0; b < tree_.size(); ++b) {
    const TreeBody& tb = tree_[b];
    for (int i = 0; i < tb.num_hinge_u(); ++i)
      to.force[tb.u_offset + i] -= differentiate([&](double s) { return calc_energy(displace(q_, b, i, s)); }, 0.005);
    for (int j = 0; j < tb.num_modes(); ++j)
      to.force[tb.eta_dot_offset() + j] -= differentiate(
          [&](double s) { return calc_energy(q_ + s * VectorXd::Unit(q_.size(), tb.eta_offset() + j)); }, 0.02);
  }
}

void Route::add_spring(const records::ForceElementRecord& element, const Motion& motion, Acting& to) const {
  const auto get_span = [&](const Motion& poses) {
    return calc_end(element.to, poses).p - calc_end(element.from, poses).p;
  };
  const Vec span = get_span(motion);
  const double length = span.at.norm(), rate = span.at.dot(span.d1) / length;
  double elastic = element.preload + element.stiffness * (length - element.free_length);
  if (!element.spring_table.empty()) elastic += calc_table(find_function(element.spring_table), length);
  double resisting = element.damping * rate;
  if (!element.damper_table.empty()) resisting += calc_table(find_function(element.damper_table), rate);
  if (element.sense != records::SpringSense::Both) {
    // Neither the spring nor both together change their sign.
    const bool pulls = element.sense == records::SpringSense::Tension;
    if (pulls ? elastic <= 0 : elastic >= 0) elastic = resisting = 0;
    if (pulls ? elastic + resisting < 0 : elastic + resisting > 0) resisting = -elastic;
  }
  const double driven = element.function.empty() ? 0 : calc_function(element.function)[0];
  for (int i = 0; i < to.force.size(); ++i)
    to.force[i] -= (elastic + resisting + driven) * span.at.dot(get_span(units_[static_cast<size_t>(i)]).d1) / length;
  to.power -= driven * rate;
  to.dissipated += resisting * rate;
}

void Route::add_bushing(const records::ForceElementRecord& element, const Motion& motion, Acting& to) const {
  const Pose a = calc_end(element.from, motion), b = calc_end(element.to, motion);
  const Matrix3d R = a.R.at.transpose();
  const Eigen::AngleAxisd turn(Matrix3d(R * b.R.at));
  Vector6d x;
  x << R * (b.p.at - a.p.at), turn.angle() * turn.axis();
  const Vector6d rate = calc_bushing_rate(a, b), along = element.stiffness6 * x + element.damping6 * rate;
  for (int i = 0; i < to.force.size(); ++i) {
    const Motion& unit = units_[static_cast<size_t>(i)];
    to.force[i] -= along.dot(calc_bushing_rate(calc_end(element.from, unit), calc_end(element.to, unit)));
  }
  to.dissipated += rate.dot(element.damping6 * rate);
}

void Route::add_contact(const records::ForceElementRecord& element, const Motion& motion, Acting& to) const {
  const Pose a = calc_end(element.from, motion), b = calc_end(element.to, motion);
  const Vector3d d = a.p.at - b.p.at;
  const bool is_plane = element.shape == records::ContactShape::Plane;
  const Vector3d n = is_plane ? Vector3d(b.R.at * element.normal.normalized()) : Vector3d(d.normalized());
  const double depth = element.radius + (is_plane ? 0 : element.to_radius) - n.dot(d);
  if (depth <= 0) return;
  const Vector3d at = is_plane ? Vector3d(a.p.at - n.dot(d) * n) : Vector3d(b.p.at + element.to_radius * n);
  const Vector3d v = calc_velocity_at(a, at) - calc_velocity_at(b, at);
  const double approach = -n.dot(v), elastic = element.stiffness * std::pow(depth, element.exponent);
  const double normal = std::max(0.0, elastic * (1 + element.damping * approach));
  const Vector3d slip = v + approach * n;
  const Vector3d f = normal * n - element.friction * normal * slip / std::hypot(slip.norm(), element.slip_velocity);
  for (int i = 0; i < to.force.size(); ++i) {
    const Motion& unit = units_[static_cast<size_t>(i)];
    to.force[i] +=
        f.dot(calc_velocity_at(calc_end(element.from, unit), at) - calc_velocity_at(calc_end(element.to, unit), at));
  }
  to.dissipated -= (f - elastic * n).dot(v);
}

void Route::add_drag(const records::ForceElementRecord& element, const Motion& motion, Acting& to) const {
  const auto get_end = [&](const Motion& poses) { return calc_end(element.from, poses); };
  const Pose at = get_end(motion);
  const Vector3d v = at.p.d1 - element.wind;
  const bool is_plate = element.normal.norm() > 0;
  const double seen = is_plate ? std::abs((at.R.at * element.normal.normalized()).dot(v)) : v.norm();
  const Vector3d f = -0.5 * element.density * element.coefficient * element.area * seen * v;
  to.power += add_wrench(get_end, motion, f, Vector3d::Zero(), to.force);
}

}  // namespace bough::solver::testing::dense_route
