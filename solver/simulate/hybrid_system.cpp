#include "solver/simulate/hybrid_system.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "solver/system/derivative.hpp"
#include "solver/system/levels.hpp"

namespace bough::solver {

HybridSystem::HybridSystem(const System& system)
    : start_(system),
      system_(&system),
      data_(system.make_data()),
      num_q_(system.num_q()),
      num_u_(system.num_u()),
      num_z_(system.num_z()) {
  for (const TreeBody& tb : system.tree.bodies) has_motion_ = has_motion_ || !tb.motion.empty();
  for (VectorXd* v : {&k_, &c_, &first_delta_, &first_u_, &delta_, &extra_}) v->setZero(num_u_);
}

void HybridSystem::calc_derivative(double t, const Eigen::Ref<const VectorXd>& y, Eigen::Ref<VectorXd> y_dot) {
  ++num_evaluations_;
  data_->friction.is_frozen = false;
  solver::calc_derivative(*system_, *data_, t, y, y_dot);
}

std::vector<std::string> HybridSystem::cross_jump(double before, double t, Eigen::Ref<VectorXd> y) {
  std::vector<std::string> events;
  solver::cross_jump(*system_, *data_, before, t, nullptr, y.head(num_q_), y.segment(num_q_, num_u_),
                     y[num_coordinates() + num_z_], events);
  return events;
}

void HybridSystem::project(double t, Eigen::Ref<VectorXd> y) {
  solver::project(*system_, *data_, t, y.head(num_q_), y.segment(num_q_, num_u_));
}

void HybridSystem::project_error(Eigen::Ref<VectorXd> error) {
  solver::remove_normal(*system_, *data_, error.head(num_q_), error.segment(num_q_, num_u_));
}

void HybridSystem::strike(double t, std::vector<Impact>& blows, Eigen::Ref<VectorXd> y) {
  const double before = get_work(y);
  solver::strike(*system_, *data_, t, y.head(num_q_), blows, y.segment(num_q_, num_u_), y[num_coordinates() + num_z_]);
  y[num_coordinates() + num_z_ + 1] += std::max(0.0, before - get_work(y));
}

std::unique_ptr<SystemData> HybridSystem::set_variant(int variant) {
  auto before = std::move(data_);
  system_ = &start_.get_variant(variant);
  data_ = system_->make_data();
  set_modes(*system_, *data_, get_discrete(*before));
  return before;
}

std::string HybridSystem::switch_levels(double t, int variant, Eigen::Ref<VectorXd> y) {
  VectorXd y_dot(size());
  auto q = y.head(num_q_);
  auto u = y.segment(num_q_, num_u_);
  const auto take_stock = [&](double& mass, double& energy, Vector6d& momentum) {
    calc_derivative(t, y, y_dot);
    Vector3d linear, angular;
    calc_momentum(*system_, *data_, linear, angular);
    momentum << linear, angular;
    const Energies e = calc_energies(*system_, *data_);
    energy = e.kinetic + e.strain + e.potential;
    mass = calc_system_mass(*system_, *data_).mass;
  };
  double mass = 0, energy = 0, mass_after = 0, energy_after = 0;
  Vector6d momentum, momentum_after;
  take_stock(mass, energy, momentum);
  const System& before = *system_;
  const auto data_before = set_variant(variant);
  set_z(*data_, y.segment(num_coordinates(), num_z_));
  std::ostringstream text;
  for (const LevelMatch& match : match_levels(before, *data_before, *system_, *data_, t, q, u))
    text << "body '" << system_->body_name(match.body) << "' has level " << system_->get_level(variant, match.body) + 1
         << ": its nodes move by " << match.position << ", turn by " << match.rotation
         << ", and change their velocity by " << match.velocity << "; ";
  if (has_projection()) project(t, y);
  take_stock(mass_after, energy_after, momentum_after);
  // Content that leaves takes its momentum and energy with it.
  y.segment<6>(num_coordinates() + num_z_ - 6) += momentum - momentum_after;
  y[num_coordinates() + num_z_] += energy_after - energy;
  text << "a mass of " << mass - mass_after << " leaves with a momentum of (" << momentum[0] - momentum_after[0] << ", "
       << momentum[1] - momentum_after[1] << ", " << momentum[2] - momentum_after[2] << ")";
  return text.str();
}

std::vector<std::string> HybridSystem::change(double t, const DiscreteState& next, Eigen::Ref<VectorXd> y) {
  // A coordinate that was prescribed continues at the last value of its function.
  calc_kinematics(*system_, *data_, t, y.head(num_q_), y.segment(num_q_, num_u_));
  y.head(num_q_) = data_->tree.q;
  std::vector<std::string> events;
  if (next.variant >= 0 && next.variant != system_->variant) events.push_back(switch_levels(t, next.variant, y));
  solver::cross_jump(*system_, *data_, t, t, &next, y.head(num_q_), y.segment(num_q_, num_u_),
                     y[num_coordinates() + num_z_], events);
  return events;
}

void HybridSystem::keep_modes(double t, Eigen::Ref<VectorXd> y) {
  calc_kinematics(*system_, *data_, t, y.head(num_q_), y.segment(num_q_, num_u_));
  y.head(num_q_) = data_->tree.q;
  y.segment(num_q_, num_u_) = data_->tree.u;
}

void HybridSystem::stick(double t, const DiscreteState& next, Eigen::Ref<VectorXd> y) {
  const double before = get_work(y);
  change(t, next, y);
  y[num_coordinates() + num_z_ + 1] += std::max(0.0, before - get_work(y));
}

ConstraintState HybridSystem::find_as_closed(double t, const Eigen::Ref<const VectorXd>& y, int constraint) {
  calc_kinematics(*system_, *data_, t, y.head(num_q_), y.segment(num_q_, num_u_));
  return solver::find_as_closed(system_->loops, system_->tree, data_->tree, constraint);
}

namespace {
constexpr Eigen::Index kClosing = 22;       // numbers of a ConstraintState: closed, R, p, gap, q
constexpr Eigen::Index kClosingFrame = 15;  // without q
}  // namespace

VectorXd HybridSystem::make_memory() const {
  const auto closing = kClosing * static_cast<Eigen::Index>(data_->loops.constraints.size());
  VectorXd memory = VectorXd::Zero(num_u_ + closing + (system_->num_levels.empty() ? 0 : 1));
  get_memory(memory);
  return memory;
}

bool HybridSystem::is_alike(const VectorXd& memory) const {
  VectorXd other = memory, own = make_memory();
  if (other.size() != own.size()) return false;
  if (!system_->num_levels.empty()) other.tail<1>() = own.tail<1>();
  for (Eigen::Index at = num_u_ + kClosingFrame; at < own.size(); at += kClosing)
    other.segment(at, kClosing - kClosingFrame) = own.segment(at, kClosing - kClosingFrame);
  return other == own;
}

void HybridSystem::get_memory(VectorXd& memory) const {
  for (int row = 0; row < num_u_; ++row) memory[row] = static_cast<double>(data_->tree.mode[static_cast<size_t>(row)]);
  Eigen::Index at = num_u_;
  for (const ConstraintData& constraint : data_->loops.constraints) {
    const ConstraintState& c = constraint.state;
    memory[at] = c.is_closed ? 1 : 0;
    memory.segment<9>(at + 1) = c.R.reshaped();
    memory.segment<3>(at + 10) = c.p;
    memory.segment<2>(at + 13) = c.gap;
    memory.segment(at + 15, c.q.size()) = c.q;
    at += kClosing;
  }
  if (at < memory.size()) memory[at] = system_->variant;
}

void HybridSystem::set_memory(const VectorXd& memory) {
  if (!system_->num_levels.empty())
    if (const auto variant = static_cast<int>(std::lround(memory[memory.size() - 1])); variant != system_->variant)
      set_variant(variant);
  DiscreteState d = get_discrete(*data_);
  for (int row = 0; row < num_u_; ++row)
    d.mode[static_cast<size_t>(row)] = static_cast<HingeMode>(std::lround(memory[row]));
  Eigen::Index at = num_u_;
  for (ConstraintState& c : d.constraints) {
    c.is_closed = memory[at] > 0.5;
    c.R = memory.segment<9>(at + 1).reshaped(3, 3);
    c.p = memory.segment<3>(at + 10);
    c.gap = memory.segment<2>(at + 13);
    c.q = memory.segment(at + 15, c.q.size());
    at += kClosing;
  }
  set_modes(*system_, *data_, d);
}

VectorXd HybridSystem::make_initial_state() const { return system_->make_initial_state().x; }

std::string HybridSystem::name_row(int row) const {
  const bool is_rate = row >= num_q_;
  const int i = is_rate ? row - num_q_ : row;
  for (int b = 0; b < system_->num_bodies(); ++b) {
    const int hinge = is_rate ? system_->u_offset(b) : system_->q_offset(b);
    const int hinge_size = is_rate ? system_->num_hinge_rates(b) : system_->num_hinge_q(b);
    const int eta = is_rate ? system_->eta_dot_offset(b) : system_->eta_offset(b);
    const std::string body = "body '" + system_->body_name(b) + "'";
    if (i >= hinge && i < hinge + hinge_size)
      return body + (is_rate ? " (hinge rate " : " (hinge coordinate ") + std::to_string(i - hinge + 1) + ")";
    if (i >= eta && i < eta + system_->num_modes(b))
      return body + (is_rate ? " (modal rate " : " (modal coordinate ") + std::to_string(i - eta + 1) + ")";
  }
  if (is_rate && i < num_u_ + system_->signals.num_states) return system_->signals.name_state(i - num_u_);
  if (is_rate && i < num_u_ + num_z_) return "the momentum that left with propellant";
  return i == num_u_ + num_z_ ? "the work done" : "the energy dissipated";
}

std::string HybridSystem::name_first_non_finite(double t, const Eigen::Ref<const VectorXd>& y) {
  const auto find_bad = [](const auto& values) {
    int row = 0;
    while (row < values.size() && std::isfinite(values[row])) ++row;
    return row < values.size() ? row : -1;
  };
  if (const int row = find_bad(y); row >= 0) return name_row(row);
  for (const TreeBody& tb : system_->tree.bodies) {
    for (const TimeFunction* f : tb.motion) {
      if (f == nullptr) continue;
      const auto value = data_->tree.functions[*f].calc(t);
      if (!std::isfinite(value.f + value.f_dot + value.f_ddot)) return "the motion of hinge '" + tb.hinge_name + "'";
    }
  }
  for (const AppliedForce& force : system_->forces) {
    const double value = force.function ? data_->tree.functions[*force.function].calc(t).f : 1;
    if (!std::isfinite(value * force.direction.norm())) return "force '" + force.name + "'";
  }
  VectorXd y_dot = VectorXd::Zero(size());
  calc_derivative(t, y, y_dot);
  for (size_t i = 0; i < data_->elements.size(); ++i) {
    const ForceResult& r = data_->elements[i];
    if (!std::isfinite(r.power + r.dissipated + r.strain + r.potential))
      return "force '" + system_->elements[i]->name() + "'";
  }
  for (const TreeBody& tb : system_->tree.bodies) {
    if (!data_->tree.applied.segment(tb.v_offset, 6 + tb.num_modes()).allFinite())
      return "the load on body '" + tb.name + "'";
  }
  const int row = find_bad(y_dot.tail(size() - num_q_));
  return row < 0 ? "" : "the derivative of " + name_row(num_q_ + row);
}

}  // namespace bough::solver
