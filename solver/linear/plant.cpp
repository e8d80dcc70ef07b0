#include "solver/linear/plant.hpp"

#include <algorithm>

#include "solver/system/law_difference.hpp"
#include "solver/system/system.hpp"
#include "solver/tree/coordinates.hpp"

namespace bough::solver {
namespace {

size_t as_index(int i) { return static_cast<size_t>(i); }

/// A quaternion has one coordinate more than rates; it comes first, its rates too.
bool has_quaternion(const System& s, int b) { return s.num_hinge_q(b) == s.num_hinge_rates(b) + 1; }

/// Name of a rate of a hinge with a quaternion: rotations, then travels along x, y or z of the parent's hinge frame.
std::string name_rate(const TreeBody& tb, int rate) {
  if (rate < 3) return std::string("r") + "xyz"[rate];
  VectorXd q(tb.hinge->num_q()), u = VectorXd::Zero(tb.hinge->num_u());
  tb.hinge->set_neutral(q.data());
  HingeMotion motion;
  tb.hinge->calc_motion(q.data(), u.data(), motion);
  Eigen::Index axis = 0;
  motion.H.col(rate).head<3>().cwiseAbs().maxCoeff(&axis);
  return std::string(1, "xyz"[axis]);
}

/// Turns without moving: back where it was after 2 pi. Orientations of quaternions have small rotations, not angles.
bool is_angle(const TreeBody& tb, int coordinate) {
  if (tb.hinge->num_q() != tb.hinge->num_u()) return false;
  VectorXd q(tb.hinge->num_q()), u = VectorXd::Zero(tb.hinge->num_u());
  tb.hinge->set_neutral(q.data());
  HingeMotion motion;
  tb.hinge->calc_motion(q.data(), u.data(), motion);
  return motion.H.col(coordinate).head<3>().isZero(0) && !motion.H.col(coordinate).tail<3>().isZero(0);
}

}  // namespace

Plant::Plant(const System& system, bool is_open)
    : system_(system), data_(system.make_data()), tangents_(std::make_unique<LawTangents>()), is_open_(is_open) {
  add_dofs();
  BOUGH_DEMAND(num_dofs() == system.num_dofs());
  t_ = system.start;
  for (const auto& p : system.signals.places) {
    if (is_open && p.block->kind == BlockKind::Controller) continue;
    for (int i = 0; i < p.block->sizes.states; ++i) state_rows_.push_back(p.state + i);
  }
  std::sort(state_rows_.begin(), state_rows_.end());
  add_inputs();
  add_outputs();
  add_sampled();
  const OperatingPoint start = get_initial_state();
  choose_independent(start.t, start.q);
}

std::vector<int> Plant::find_used_up() {
  std::vector<int> used_up;
  VectorXd& z = data_->signals.z;
  for (int i = 0; i < num_signal_states(); ++i) {
    const int row = state_row(i);
    const auto draws = [row](const Tank& tank) {
      return std::find(tank.used_rows.begin(), tank.used_rows.end(), row) != tank.used_rows.end();
    };
    z.setZero();
    z[row] = 1;
    // Without a tank: consumption per body.
    const VectorXd used = system_.signals.calc_consumption(get_motion(system_, *data_), data_->signals);
    if (!used.isZero(0) || std::any_of(system_.tree.tanks.begin(), system_.tree.tanks.end(), draws))
      used_up.push_back(i);
  }
  z.setZero();
  return used_up;
}

void Plant::add_dofs() {
  for (int b = 0; b < system_.num_bodies(); ++b) {
    add_hinge(b);
    add_modes(b);
  }
  const VectorXd steps = calc_displacement_steps(system_.tree);
  for (size_t i = 0; i < dofs_.size(); ++i) dofs_[i].step = steps[rows_[i]];
}

void Plant::set_modes(const DiscreteState& discrete, double t, const VectorXd& q) {
  DiscreteState modes = discrete;
  modes.memory.resize(0);
  solver::set_modes(system_, *data_, modes);
  dofs_.clear();
  rows_.clear();
  grip_.clear();
  position_grip_.clear();
  paths_.clear();
  path_rows_.clear();
  inputs_.clear();
  outputs_ = {};
  add_dofs();
  add_inputs();
  add_outputs();
  choose_independent(t, q);
}

void Plant::add_hinge(int b) {
  const TreeBody& tb = system_.tree.bodies[as_index(b)];
  for (int i = 0; i < system_.num_hinge_rates(b); ++i) {
    const int row = system_.u_offset(b) + i;
    if (data_->tree.mode[as_index(row)] != HingeMode::Free) continue;
    rows_.push_back(row);
    const std::string coordinate = has_quaternion(system_, b) ? name_rate(tb, i) : std::to_string(i + 1);
    dofs_.push_back(
        {system_.hinge_name(b) + ":" + coordinate, is_translation(tb, i) ? "L" : "1", false, is_angle(tb, i)});
  }
}

void Plant::add_modes(int b) {
  for (int i = 0; i < system_.num_modes(b); ++i) {
    rows_.push_back(system_.eta_dot_offset(b) + i);
    dofs_.push_back({system_.body_name(b) + ":eta" + std::to_string(i + 1), "by normalisation", true});
  }
}

records::Signals Plant::name_positions() const {
  records::Signals names;
  const auto add = [&](const std::string& name, const std::string& dims) {
    names.name.push_back(name);
    names.dims.push_back(dims);
  };
  for (int b = 0; b < system_.num_bodies(); ++b) {
    const auto& hinge = system_.hinge_name(b);
    const bool is_free = has_quaternion(system_, b);
    for (int i = 0; i < system_.num_hinge_q(b); ++i) {
      const TreeBody& tb = system_.tree.bodies[as_index(b)];
      const std::string coordinate = !is_free ? std::to_string(i + 1)
                                     : i < 4  ? std::string("q") + "wxyz"[i]
                                              : name_rate(tb, i - 1);
      const int rate = is_free ? i - 1 : i;
      add(hinge + ":" + coordinate, (is_free && i < 4) || !is_translation(tb, rate) ? "1" : "L");
    }
    for (int i = 0; i < system_.num_modes(b); ++i)
      add(system_.body_name(b) + ":eta" + std::to_string(i + 1), "by normalisation");
  }
  return names;
}

OperatingPoint Plant::make_initial_point() {
  OperatingPoint point = get_initial_state();
  initialize_signals(point);
  return point;
}

OperatingPoint Plant::get_initial_state() const {
  OperatingPoint point;
  point.t = system_.start;
  point.q = VectorXd::Zero(system_.num_q());
  VectorXd u = VectorXd::Zero(system_.num_u());
  system_.calc_initial_state(point.q, u);
  point.u = u(rows_);
  const SignalData initial = system_.signals.make_data();
  point.z = initial.z;
  point.memory = initial.memory;
  return point;
}

std::string Plant::state_name(int i) const {
  if (i >= num_signal_states()) return paths_[as_index(i - num_signal_states())].name;
  return system_.signals.name_state(state_row(i));
}

std::string Plant::state_dims(int i) const {
  return i < num_signal_states() ? "by the controller" : paths_[as_index(i - num_signal_states())].dims;
}

double Plant::state_step(const OperatingPoint& point, int i) const {
  if (i >= num_signal_states()) return paths_[as_index(i - num_signal_states())].step;
  return 0.1 * std::max(1.0, std::abs(point.z[state_row(i)]));
}

void Plant::move_state(OperatingPoint& point, int i, double h) const {
  if (i < num_signal_states()) {
    point.z[state_row(i)] += h;
    return;
  }
  point.q = displace_tree(
      point.q, expand_positions(VectorXd::Zero(num_dofs()), h * VectorXd::Unit(num_paths(), i - num_signal_states())));
  close_positions(point.q);
}

std::vector<std::string> Plant::list_sampled() const {
  std::vector<std::string> names;
  const auto& places = system_.signals.places;
  for (size_t k = 0; k < places.size(); ++k) {
    if (places[k].is_sampled() && is_felt_[k]) names.push_back(places[k].block->name);
  }
  return names;
}

std::string Plant::find_opaque() const {
  const auto& places = system_.signals.places;
  for (size_t k = 0; k < places.size(); ++k)
    if (is_felt_[k] && places[k].block->is_opaque()) return places[k].block->label;
  return {};
}

void Plant::hold_commands(const OperatingPoint& point) {
  SignalData& s = data_->signals;
  if (!is_open_) return;
  s.is_open = false;
  evaluate(point);
  for (const auto& p : system_.signals.places) {
    const int n = p.actuator >= 0 ? p.block->sizes.inputs : 0;
    s.command.segment(std::max(0, p.actuator), n) = s.inputs.segment(p.in, n);
  }
  s.is_open = true;
}

VectorXd Plant::expand(const VectorXd& free) const {
  VectorXd u = VectorXd::Zero(system_.num_u());
  u(rows_) = free;
  return u;
}

VectorXd Plant::displace(const VectorXd& q, const VectorXd& delta) const {
  BOUGH_DEMAND(delta.size() == num_dofs());
  VectorXd moved = displace_tree(q, expand(delta));
  if (has_loops()) close_positions(moved);
  return moved;
}

VectorXd Plant::expand_positions(const VectorXd& delta, const VectorXd& paths) const {
  VectorXd step = expand(delta);
  step(path_rows_) = paths;
  return step;
}

VectorXd Plant::displace_tree(const VectorXd& q, const VectorXd& step) const {
  BOUGH_DEMAND(q.size() == system_.num_q() && step.size() == system_.num_u());
  VectorXd moved = q;
  for (int b = 0; b < system_.num_bodies(); ++b) {
    int q_row = system_.q_offset(b), u_row = system_.u_offset(b), left = system_.num_hinge_rates(b);
    if (left > 0 && has_quaternion(system_, b)) {
      const Eigen::Quaterniond before(q[q_row + 3], q[q_row], q[q_row + 1], q[q_row + 2]);
      const Vector3d turn = step.segment<3>(u_row);
      const double angle = turn.norm();
      const Eigen::Quaterniond by(
          Eigen::AngleAxisd(angle, angle > 0 ? Vector3d(turn / angle) : Vector3d(Vector3d::UnitX())));
      moved.segment<4>(q_row) = (before * by).coeffs();
      q_row += 4, u_row += 3, left -= 3;
    }
    moved.segment(q_row, left) += step.segment(u_row, left);
    moved.segment(system_.eta_offset(b), system_.num_modes(b)) +=
        step.segment(system_.eta_dot_offset(b), system_.num_modes(b));
  }
  return moved;
}

MatrixXd Plant::calc_turning(const OperatingPoint& point) const {
  const VectorXd u = calc_speeds(point);
  MatrixXd turning = MatrixXd::Zero(u.size(), u.size());
  for (int b = 0; b < system_.num_bodies(); ++b) {
    const int row = system_.u_offset(b);
    if (!has_quaternion(system_, b)) continue;
    turning.block<3, 3>(row, row) = -skew(u.segment<3>(row));
  }
  if (!has_loops()) return turning(rows_, rows_);
  std::vector<int> rows = rows_;
  rows.insert(rows.end(), path_rows_.begin(), path_rows_.end());
  return turning(rows, Eigen::all) * (num_paths() > 0 ? calc_position_follow(point) : calc_follow());
}

MatrixXd Plant::calc_mass(const OperatingPoint& point) {
  VectorXd ignored(system_.num_u());
  compute(point, nullptr, 0, ignored);
  MatrixXd mass;
  VectorXd force;
  calc_dense_equations(system_.tree, data_->tree, mass, force);
  if (!has_loops()) return mass(rows_, rows_);
  const MatrixXd follow = calc_follow();
  return follow.transpose() * mass * follow;
}

VectorXd Plant::get_for_file(const VectorXd& q) const {
  VectorXd file = q;
  for (int b = 0; b < system_.num_bodies(); ++b) {
    if (!has_quaternion(system_, b)) continue;
    const int row = system_.q_offset(b);
    for (int i = 0; i < 4; ++i) file[row + (i + 1) % 4] = q[row + i];
  }
  return file;
}

}  // namespace bough::solver
