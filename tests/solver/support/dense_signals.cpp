// Signals and actuators of the second route: controllers, samples, delays, motors, wheels, gyros, engines, tanks.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/solver/support/dense_equations.hpp"

namespace bough::solver::testing::dense_route {

namespace {

double get(const records::Settings& settings, const char* key, double otherwise = 0) {
  return settings.get(key, otherwise);
}

Vector3d get_axis(const records::Settings& settings, const char* key) {
  const auto& list = settings.numbers.at(key);
  return Vector3d(list.at(0), list.at(1), list.at(2)).normalized();
}

std::string get_word(const records::Settings& settings, const char* key) {
  const auto found = settings.words.find(key);
  return found == settings.words.end() ? "" : found->second.front();
}

int count_commands(const records::ActuatorRecord& r) { return r.type == "double_gimbal_cmg" ? 2 : 1; }
int count_lags(const records::ActuatorRecord& r) { return get(r.settings, "lag") > 0 ? count_commands(r) : 0; }
int count_own(const records::ActuatorRecord& r) {
  return r.type == "wheel" || r.type == "cmg" ? 1
         : r.type == "double_gimbal_cmg"      ? 2
         : r.type == "engine"                 ? (get(r.settings, "exhaust_velocity") > 0 ? 1 : 0)
                                              : 0;
}

/// Discs normal to the axis of a tank, from `bottom` to `top` above its place, of inner and outer radii squared.
template <class Radius>
Matrix6d add_discs(const records::TankRecord& tank, double bottom, double top, double inner2, const Radius& outer2) {
  // Points and weights of Gauss and Legendre: exact for polynomials of degree 9.
  const double x[] = {0, 1.0 / 3 * std::sqrt(5 - 2 * std::sqrt(10.0 / 7)),
                      1.0 / 3 * std::sqrt(5 + 2 * std::sqrt(10.0 / 7))};
  const double w[] = {128.0 / 225, (322 + 13 * std::sqrt(70.0)) / 900, (322 - 13 * std::sqrt(70.0)) / 900};
  const Vector3d e = tank.axis.normalized();
  Matrix6d sum = Matrix6d::Zero();
  for (int k = -2; k <= 2; ++k) {
    const int i = std::abs(k);
    const double z = 0.5 * (bottom + top) + 0.5 * (top - bottom) * (k < 0 ? -x[i] : x[i]);
    const double s2 = outer2(z);
    const double mass = tank.density * std::numbers::pi * (s2 - inner2) * 0.5 * (top - bottom) * w[i];
    const double across = 0.25 * mass * (s2 + inner2);
    sum += make_rigid_mass(mass, tank.position + z * e, across * (Matrix3d::Identity() + e * e.transpose()));
  }
  return sum;
}

}  // namespace

Matrix6d calc_content(const records::TankRecord& tank, const records::BodyRecord& body, double mass) {
  const double R2 = tank.radius * tank.radius, per_area = tank.density * std::numbers::pi;
  Matrix6d content = Matrix6d::Zero();
  if (tank.type == records::TankType::Cylinder) {
    content = add_discs(tank, 0, mass / (per_area * R2), 0, [&](double) { return R2; });
  } else if (tank.type == records::TankType::Grain) {
    content = add_discs(tank, 0, tank.height, R2 - mass / (per_area * tank.height), [&](double) { return R2; });
  } else if (tank.type == records::TankType::Sphere) {
    long double low = -tank.radius, high = tank.radius;  // of the surface, by halving
    for (int k = 0; k < 70; ++k) {
      const long double z = 0.5L * (low + high);
      const long double volume = R2 * (z + tank.radius) - (z * z * z + R2 * static_cast<long double>(tank.radius)) / 3;
      (per_area * volume < mass ? low : high) = z;
    }
    content = add_discs(tank, -tank.radius, static_cast<double>(low), 0, [&](double z) { return R2 - z * z; });
  } else {
    const double whole = mass + (tank.is_of_body ? body.mass : 0);
    size_t i = 1;
    while (i + 1 < tank.masses.size() && tank.masses[i] < whole) ++i;
    const double share = (whole - tank.masses[i - 1]) / (tank.masses[i] - tank.masses[i - 1]);
    content = make_rigid_mass(whole, (1 - share) * tank.cg[i - 1] + share * tank.cg[i],
                              (1 - share) * tank.inertia[i - 1] + share * tank.inertia[i]);
    if (tank.is_of_body) content -= make_rigid_mass(body.mass, body.cg, body.inertia);
  }
  if (tank.slosh_mass > 0) content -= make_rigid_mass(tank.slosh_mass, tank.slosh_position, Matrix3d::Zero());
  return content;
}

void Route::lay_out_states() {
  int row = 0;
  for (const auto& law : spec_.controllers) {
    law_row_.push_back(row);
    if (get(law.settings, "sample_time") == 0) row += static_cast<int>(law.settings.matrices.at("A").rows());
  }
  for (const auto& tank : spec_.tanks)
    tank_mass_.push_back(tank.function.empty() ? tank.mass : calc_function(tank.function)[0]);
  for (const auto& r : spec_.actuators) {
    actuator_row_.push_back(row);
    row += count_lags(r) + count_own(r);
    for (size_t i = 0; i < spec_.tanks.size(); ++i)
      if (get_word(r.settings, "tank") == spec_.tanks[i].name) tank_mass_[i] -= z_[row - 1];
  }
  BOUGH_DEMAND(row + (spec_.tanks.empty() ? 0 : 6) == z_.size());
}

Route Route::at_sample(double time) const {
  for (const auto& [t, x] : history_)
    if (std::abs(t - time) < 1e-9) return {spec_, flex_, system_, discrete_, history_, t, x};
  BOUGH_DEMAND(!"a state of the history at each sample");
  return *this;
}

VectorXd Route::calc_inputs(const records::ControllerRecord& law) const {
  VectorXd in(law.inputs.size());
  for (size_t i = 0; i < law.inputs.size(); ++i) in[static_cast<Eigen::Index>(i)] = calc_signal(law.inputs[i]);
  return in;
}

VectorXd Route::calc_sampled(const records::ControllerRecord& law, long last) const {
  const auto& m = law.settings.matrices;
  VectorXd state = VectorXd::Zero(m.at("A").rows());
  const double period = get(law.settings, "sample_time");
  for (long k = 0; k < last; ++k)
    state = m.at("A") * state + m.at("B") * at_sample(static_cast<double>(k) * period).calc_inputs(law);
  return m.at("C") * state + m.at("D") * at_sample(static_cast<double>(last) * period).calc_inputs(law);
}

double Route::calc_signal(const std::string& name, int component) const {
  for (const auto& input : spec_.inputs)
    if (input.name == name) return input.start;
  for (const auto& sensor : spec_.sensors) {
    if (sensor.name != name) continue;
    const double period = get(sensor.chain, "sample_time");
    if (period > 0) {
      const double k = std::floor((t_ - get(sensor.chain, "delay")) / period + 1e-9);
      if (k < 0) return 0;
      if (const double at = k * period; std::abs(at - t_) > 1e-9) {
        const Route then = at_sample(at);
        const int b = system_.find_hinge(sensor.hinge);
        return sensor.type == records::SensorType::HingeAngle ? then.q_[tree_[b].q_offset] : then.u_[tree_[b].u_offset];
      }
    }
    const int b = system_.find_hinge(sensor.hinge);
    return sensor.type == records::SensorType::HingeAngle ? q_[tree_[b].q_offset] : u_[tree_[b].u_offset];
  }
  for (size_t i = 0; i < spec_.controllers.size(); ++i) {
    const auto& law = spec_.controllers[i];
    if (law.name != name) continue;
    if (const double period = get(law.settings, "sample_time"); period > 0) {
      const long k = std::lround(std::floor((t_ - get(law.settings, "delay")) / period + 1e-9));
      return k < 0 ? 0 : calc_sampled(law, k)[component];
    }
    const auto& m = law.settings.matrices;
    return (m.at("C") * z_.segment(law_row_[i], m.at("A").rows()) + m.at("D") * calc_inputs(law))[component];
  }
  return calc_function(name)[0];
}

double Route::calc_command(const records::ActuatorRecord& r, int row, int i, VectorXd& z_dot) const {
  const auto& s = r.settings;
  double c = get(s, "scale", 1) * calc_signal(r.input, i) + get(s, "bias");
  const double band = get(s, "deadband");
  c = std::abs(c) <= band ? 0 : c > 0 ? c - band : c + band;
  if (s.has("upper")) c = std::min(c, get(s, "upper"));
  if (s.has("upper") || s.has("lower")) c = std::max(c, s.has("lower") ? get(s, "lower") : -get(s, "upper"));
  const double lag = get(s, "lag");
  if (!(lag > 0)) return c;
  const double rate = (c - z_[row + i]) / lag, limit = get(s, "rate_limit", 1e300);
  z_dot[row + i] = std::abs(rate) > limit ? std::copysign(limit, rate) : rate;
  return z_[row + i];
}

void Route::add_signals(const Motion& motion, Acting& to, VectorXd& z_dot) const {
  for (size_t i = 0; i < spec_.controllers.size(); ++i) {
    const auto& law = spec_.controllers[i];
    const auto& m = law.settings.matrices;
    if (get(law.settings, "sample_time") == 0)
      z_dot.segment(law_row_[i], m.at("A").rows()) =
          m.at("A") * z_.segment(law_row_[i], m.at("A").rows()) + m.at("B") * calc_inputs(law);
  }
  for (size_t i = 0; i < spec_.actuators.size(); ++i) add_actuator(i, motion, to, z_dot);
  for (size_t i = 0; i < spec_.tanks.size(); ++i) {
    const auto& tank = spec_.tanks[i];
    if (tank.function.empty()) continue;
    Vector3d exit = Vector3d::Zero();
    for (const auto& node : get_body(find_body(tank.body)).nodes)
      if (node.id == tank.exit_node) exit = node.p;
    add_outflow(i, -calc_function(tank.function)[1], exit, tank.exit_radius, tank.exit_axis.normalized(),
                Vector3d::Zero(), motion, to, z_dot);
  }
}

void Route::add_actuator(size_t index, const Motion& motion, Acting& to, VectorXd& z_dot) const {
  const auto& r = spec_.actuators[index];
  const int row = actuator_row_[index], own = row + count_lags(r);
  Vector3d command = Vector3d::Zero();
  for (int i = 0; i < count_commands(r); ++i) command[i] = calc_command(r, row, i, z_dot);
  if (r.type == "wheel") return add_wheel(r, own, command[0], motion, to, z_dot);
  if (r.type == "cmg" || r.type == "double_gimbal_cmg") return add_gyro(r, own, command, motion, to, z_dot);
  if (r.type == "engine") return add_engine(r, own, std::max(0.0, command[0]), motion, to, z_dot);
  const int u = tree_[system_.find_hinge(r.hinge)].u_offset + r.coordinate - 1;
  double f = command[0];
  if (r.type == "motor") {
    const double constant = get(r.settings, "torque_constant"), ratio = get(r.settings, "ratio", 1);
    const double current =
        (command[0] - get(r.settings, "back_emf", constant) * ratio * u_[u]) / get(r.settings, "resistance");
    f = ratio * constant * current - get(r.settings, "viscous") * u_[u];
  } else if (r.type == "brake") {
    f = -std::abs(command[0]) * std::tanh(u_[u] / get(r.settings, "stick_rate"));
  } else {
    BOUGH_DEMAND(r.type == "hinge");
  }
  to.force[u] += f;
  if (discrete_.mode[static_cast<size_t>(u)] == HingeMode::Free) to.power += f * u_[u];
}

void Route::add_wheel(const records::ActuatorRecord& r, int row, double command, const Motion& motion, Acting& to,
                      VectorXd& z_dot) const {
  const auto get_node = [&](const Motion& poses) {
    return calc_marker(find_body(r.body), r.node, Vector3d::Zero(), Matrix3d::Identity(), poses);
  };
  const Pose node = get_node(motion);
  const Vec axis = node.R * make_constant<3, 1>(get_axis(r.settings, "axis"));
  const Vector3d turning = get_axial(node.R.d1 * node.R.at.transpose());
  const double h = z_[row], speed = h / get(r.settings, "inertia") - axis.at.dot(turning);
  double torque = command - get(r.settings, "viscous") * speed;
  if (const double coulomb = get(r.settings, "coulomb"); coulomb > 0)
    torque -= coulomb * std::tanh(speed / get(r.settings, "stick_rate"));
  z_dot[row] = torque;
  // The momentum h a of the rotor changes by what the body does to it.
  to.power += add_wrench(get_node, motion, Vector3d::Zero(), -(torque * axis.at + h * axis.d1), to.force);
  to.power += torque * h / get(r.settings, "inertia");  // of ½ h² / J
}

void Route::add_gyro(const records::ActuatorRecord& r, int row, const Vector3d& rates, const Motion& motion, Acting& to,
                     VectorXd& z_dot) const {
  const auto get_node = [&](const Motion& poses) {
    return calc_marker(find_body(r.body), r.node, Vector3d::Zero(), Matrix3d::Identity(), poses);
  };
  const Vector3d outer = get_axis(r.settings, "gimbal_axis"), spin = get_axis(r.settings, "spin_axis");
  Mat turn = calc_turn(outer, make_num(z_[row], rates[0], 0));
  z_dot[row] = rates[0];
  if (r.type == "double_gimbal_cmg") {
    turn = turn * calc_turn(get_axis(r.settings, "inner_axis"), make_num(z_[row + 1], rates[1], 0));
    z_dot[row + 1] = rates[1];
  }
  const Vec h = get_node(motion).R * (turn * make_constant<3, 1>(get(r.settings, "momentum") * spin));
  to.power += add_wrench(get_node, motion, Vector3d::Zero(), -h.d1, to.force);
}

void Route::add_engine(const records::ActuatorRecord& r, int row, double thrust, const Motion& motion, Acting& to,
                       VectorXd& z_dot) const {
  const int b = find_body(r.body);
  const auto get_node = [&](const Motion& poses) {
    return calc_marker(b, r.node, Vector3d::Zero(), Matrix3d::Identity(), poses);
  };
  const Vector3d axis = get_axis(r.settings, "axis"), f = motion.X[static_cast<size_t>(b)].R.at * (thrust * axis);
  const double exhaust = get(r.settings, "exhaust_velocity");
  if (exhaust > 0) z_dot[row] = thrust / exhaust;
  for (size_t i = 0; i < spec_.tanks.size(); ++i) {
    if (spec_.tanks[i].name != get_word(r.settings, "tank")) continue;
    Vector3d exit = Vector3d::Zero();
    for (const auto& node : get_body(b).nodes)
      if (node.id == r.node) exit = node.p;
    return add_outflow(i, thrust / exhaust, exit, get(r.settings, "exit_radius"), axis, f, motion, to, z_dot);
  }
  to.power += add_wrench(get_node, motion, f, Vector3d::Zero(), to.force);
}

void Route::add_outflow(size_t index, double flow, const Vector3d& exit, double radius, const Vector3d& axis,
                        const Vector3d& thrust, const Motion& motion, Acting& to, VectorXd& z_dot) const {
  const auto& tank = spec_.tanks[index];
  const int b = find_body(tank.body);
  const Pose& X = motion.X[static_cast<size_t>(b)];
  const auto get_body_frame = [&](const Motion& poses) { return poses.X[static_cast<size_t>(b)]; };
  const Matrix3d& R = X.R.at;
  const Vector3d w = get_axial(X.R.d1 * R.transpose()), normal = R * axis;
  const auto calc_velocity = [&](const Vector3d& r) { return Vector3d(X.p.d1 + X.R.d1 * r); };
  const double mass = tank_mass_[index], step = 0.004 * mass;
  const Matrix6d change =
      differentiate([&](double s) { return calc_content(tank, get_body(b), mass + s); }, step);  // by the mass
  const Vector3d place(change(5, 1), change(3, 2), change(4, 0));
  // Momentum that crosses the boundary at the nozzle; that of the flow inside turns with the body.
  const Vec inside = X.R * make_constant<3, 1>(flow * (exit - place));
  const Vec turning = X.R * make_constant<3, 1>(flow * place.cross(exit));  // about Bo
  const Vector3d jet = flow * calc_velocity(exit) - thrust;
  const Vector3d of_disc = flow * 0.25 * radius * radius * (w + normal * normal.dot(w));
  const Vector3d out = jet + inside.d1;
  const Vector3d turn_out = (R * exit).cross(jet) + of_disc + X.p.d1.cross(inside.at) + turning.d1;
  // The content loses mass at the momentum that the body gives it at its place.
  const Vector3d lost = flow * calc_velocity(place);
  const Matrix3d inertia = change.block<3, 3>(3, 3);
  const Vector3d turn_lost = flow * ((R * place).cross(X.p.d1) + R * inertia * R.transpose() * w);
  to.power += add_wrench(get_body_frame, motion, lost - out, turn_lost - turn_out, to.force);
  z_dot.tail<6>().head<3>() += out;
  z_dot.tail<3>() += turn_out + X.p.at.cross(out);
  to.power -= flow * differentiate([&](double s) { return calc_tank_energy(index, mass + s, motion); }, step);
}

double Route::calc_tank_energy(size_t tank, double mass, const Motion& motion) const {
  Route other(*this);
  other.tank_mass_[tank] = mass;
  const int b = find_body(spec_.tanks[tank].body);
  const Pose& X = motion.X[static_cast<size_t>(b)];
  const MatrixXd M = other.calc_mass(b, VectorXd());
  const VectorXd V = calc_velocity(b, motion)[0];
  const Vector3d first(M(5, 1), M(3, 2), M(4, 0));
  double energy = 0.5 * V.dot(M * V) - spec_.simulation.gravity.dot(M(0, 0) * X.p.at + X.R.at * first);
  for (const auto& element : spec_.force_elements)
    if (element.type == records::ElementType::CentralGravity) energy += other.calc_central_energy(element, motion, q_);
  return energy;
}

}  // namespace bough::solver::testing::dense_route
