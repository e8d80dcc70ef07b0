#include "solver/simulate/joint_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "solver/forces/latch_slack.hpp"
#include "solver/simulate/run.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {

constexpr int kMostRounds = 200;
constexpr double kFaint = 1e-9;   // of the hardest blow of a moment: what is slower stays together
constexpr double kTouch = 1e-11;  // of where a stop is, or how far it was: what is no farther from it touches it

int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

}  // namespace

Latches::Latches(const System& system) : system_(system) {
  for (const Latch& latch : system.latches) {
    Watched w;
    w.latch = latch;
    latches_.push_back(std::move(w));
  }
}

void Latches::calc_guards(const SystemData& data, VectorXd& guards) const {
  guards.setConstant(-1);
  for (size_t i = 0; i < latches_.size(); ++i) {
    const Watched& w = latches_[i];
    auto own = guards.segment<kGuards>(kGuards * static_cast<Eigen::Index>(i));
    const HingeMode mode = data.tree.mode[static_cast<size_t>(w.latch.u_row)];
    const double q = data.tree.q[w.latch.q_row], rate = data.tree.u[w.latch.u_row];
    if (mode == HingeMode::Locked && w.rests) {
      const double force = data.tree.calc_constraint_force(w.latch.u_row);
      if (std::isfinite(w.high())) own[0] = force - w.high();
      if (std::isfinite(w.low())) own[1] = w.low() - force;
    } else if (mode == HingeMode::Free) {
      // Past it and on its way further: what has just been thrown back may still be behind by rounding.
      if (std::isfinite(w.latch.lower)) own[0] = std::min(w.latch.lower - q, -rate * shortest_);
      if (std::isfinite(w.latch.upper)) own[1] = std::min(q - w.latch.upper, rate * shortest_);
      if (w.slide != 0) own[2] = -w.slide * rate;
    }
  }
}

void Latches::find_stops(const SystemOde& ode, double resolution, const VectorXd& y) {
  for (Watched& w : latches_) {
    const double q = y[w.latch.q_row], rate = y[ode.num_q() + w.latch.u_row];
    w.farthest = std::max(w.farthest, std::abs(q));
    const auto touches = [&](double past, double at) {
      return std::isfinite(at) &&
             past > -(kTouch * std::max(std::abs(at), w.farthest) + 4 * resolution * std::abs(rate));
    };
    if (w.rests && w.stop != 0) continue;
    const bool is_low = touches(w.latch.lower - q, w.latch.lower), is_high = touches(q - w.latch.upper, w.latch.upper);
    w.stop = is_low && is_high ? (rate < 0 ? -1 : 1) : is_low ? -1 : is_high ? 1 : 0;
  }
}

void Latches::lock(SystemOde& ode, double t, const std::vector<bool>& rests, VectorXd& y) const {
  const auto& modes = ode.data().tree.mode;
  const auto get_next = [&](size_t i) {
    const HingeMode mode = modes[static_cast<size_t>(latches_[i].latch.u_row)];
    if (mode == HingeMode::Prescribed || (mode == HingeMode::Locked && !latches_[i].rests)) return mode;
    return rests[i] ? HingeMode::Locked : HingeMode::Free;
  };
  size_t changed = 0;
  while (changed < latches_.size() && get_next(changed) == modes[static_cast<size_t>(latches_[changed].latch.u_row)])
    ++changed;
  if (changed == latches_.size()) {
    ode.keep_modes(t, y);
    return;
  }
  Discrete next = get_discrete(ode.data());
  for (size_t i = 0; i < latches_.size(); ++i) next.mode[static_cast<size_t>(latches_[i].latch.u_row)] = get_next(i);
  ode.bring_to_rest(t, next, y);
}

// What comes at its stop at one moment is thrown back at once; what that drives at other stops is the next round, so
// that a blow travels along a row of bodies that touch. Without restitution what touches is one with what strikes it.
bool Latches::strike_stops(SystemOde& ode, double t, double shortest, VectorXd& y, std::vector<std::string>& what) {
  const int u = ode.num_q();
  double first = 0;
  for (int round = 0;; ++round) {
    double hardest = 0;
    for (const Watched& w : latches_) {
      if (!can_strike(ode, w)) continue;
      const double into = w.stop * y[u + w.latch.u_row];
      if (into > calc_slowest(w, u, shortest)) hardest = std::max(hardest, into);
    }
    if (hardest == 0) return round > 0;
    if (round == 0) {  // an impulse overcomes whatever holds
      lock(ode, t, std::vector<bool>(latches_.size(), false), y);
      for (Watched& w : latches_) w.rests = false;
      first = hardest;
    }
    const bool is_last = hardest <= kFaint * first || round == kMostRounds;
    std::vector<Blow> blows;
    std::vector<const Watched*> struck;
    for (Watched& w : latches_) {
      if (!can_strike(ode, w)) continue;
      const double into = w.stop * y[u + w.latch.u_row];
      const bool comes = into > std::max(calc_slowest(w, u, shortest), kFaint * first), stays = into >= -kFaint * first;
      if (round == kMostRounds && comes && w.latch.restitution >= 1) fail_endless(what);
      if (!comes && !(stays && (is_last || w.latch.restitution == 0))) continue;
      blows.push_back({w.latch.u_row, w.stop, is_last ? 0 : w.latch.restitution});
      struck.push_back(&w);
      w.hardest = std::max(w.hardest, into);
    }
    const VectorXd before = y.segment(u, ode.num_coordinates() - u);
    ode.strike(t, blows, y);
    for (size_t i = 0; i < blows.size(); ++i) {
      const double from = before[blows[i].row], to = y[u + blows[i].row];
      if (blows[i].impulse == 0 || std::abs(from) <= kFaint * first) continue;
      what.push_back(struck[i]->latch.name + " meets its stop at " +
                     short_text(struck[i]->stop < 0 ? struck[i]->latch.lower : struck[i]->latch.upper) +
                     ": its rate turns from " + short_text(from) + " to " + short_text(to) + " by an impulse of " +
                     short_text(blows[i].impulse));
    }
    if (is_last) return true;
  }
}

double Latches::calc_slowest(const Watched& w, int u, double shortest) const {
  // By what drives it there; where nothing does (a box that rocks on two of its feet) by how it once came.
  return std::max(std::abs(y_dot_[u + w.latch.u_row]) * shortest, w.stop != 0 ? kFaint * w.hardest : 0);
}

bool Latches::can_strike(const SystemOde& ode, const Watched& w) const {
  return w.stop != 0 && ode.data().tree.mode[static_cast<size_t>(w.latch.u_row)] == HingeMode::Free;
}

void Latches::fail_endless(const std::vector<std::string>& what) const {
  throw ComputationError("run.endless-impacts", system_.tree.bodies.front().hinge_at,
                         "stops that throw each other back do not come to an end, last " + what.back(),
                         "give them a restitution below 1, or a stiffness in its place");
}

// What moves slowly enough may rest: all of it is held, and what is not held by what may hold it comes loose.
void Latches::find_rest(SystemOde& ode, double t, double shortest, VectorXd& y, std::vector<std::string>& what) {
  const int u = ode.num_q();
  auto& [rests, before, slide] = scratch_;
  rests.assign(latches_.size(), false);
  before.assign(latches_.size(), false);
  slide.assign(latches_.size(), 0);
  for (size_t i = 0; i < latches_.size(); ++i) {
    const Watched& w = latches_[i];
    const HingeMode mode = ode.data().tree.mode[static_cast<size_t>(w.latch.u_row)];
    before[i] = w.rests && mode == HingeMode::Locked;
    if (mode == HingeMode::Prescribed || (mode == HingeMode::Locked && !w.rests)) continue;
    const double rate = y[u + w.latch.u_row];
    slide[i] = w.latch.static_friction > 0 ? sign(rate) : 0;
    const bool is_held = w.latch.static_friction > 0 || w.stop != 0;
    const bool is_slow = std::abs(rate) <= calc_slowest(w, u, shortest);
    // What slides on its way, and has not turned, goes on.
    const bool turns = w.latch.static_friction == 0 || w.slide == 0 || w.slide * rate <= 0;
    if (is_held && is_slow && turns) rests[i] = true;  // what is left of its rate goes by the impulse of locking it
  }
  for (size_t left = latches_.size() + 1; left > 0; --left) {
    lock(ode, t, rests, y);
    for (size_t i = 0; i < latches_.size(); ++i) {
      latches_[i].rests = rests[i];
      latches_[i].slide = rests[i] ? 0 : slide[i];
      ode.data().tree.slide[latches_[i].latch.u_row] = latches_[i].slide;
    }
    ode.calc_derivative(t, y, y_dot_);
    double most = 0;
    size_t loosest = latches_.size();
    for (size_t i = 0; i < latches_.size(); ++i) {
      if (!rests[i]) continue;
      const double force = ode.data().tree.calc_constraint_force(latches_[i].latch.u_row);
      const double excess = std::max(force - latches_[i].high(), latches_[i].low() - force);
      if (!(excess > most)) continue;
      most = excess;
      loosest = i;
    }
    if (loosest == latches_.size()) break;
    rests[loosest] = false;
    if (latches_[loosest].latch.static_friction > 0)
      slide[loosest] = ode.data().tree.calc_constraint_force(latches_[loosest].latch.u_row) > 0 ? -1 : 1;
  }
  for (size_t i = 0; i < latches_.size(); ++i) {
    const Watched& w = latches_[i];
    if (rests[i] && !before[i]) what.push_back(w.latch.name + (w.stop != 0 ? " comes to rest at its stop" : " sticks"));
    if (!rests[i] && before[i]) what.push_back(w.latch.name + (w.stop != 0 ? " leaves its stop" : " slips"));
  }
}

std::vector<std::string> Latches::settle(SystemOde& ode, double t, double shortest, VectorXd& y) {
  std::vector<std::string> what;
  shortest_ = shortest;
  if (y_dot_.size() == 0) y_dot_ = VectorXd::Zero(ode.size());
  for (Watched& w : latches_) ode.data().tree.slide[w.latch.u_row] = w.slide;
  ode.calc_derivative(t, y, y_dot_);
  find_stops(ode, shortest, y);
  if (strike_stops(ode, t, shortest, y, what)) {
    for (Watched& w : latches_) {
      w.slide = w.latch.static_friction > 0 ? sign(y[ode.num_q() + w.latch.u_row]) : 0;
      ode.data().tree.slide[w.latch.u_row] = w.slide;
    }
    ode.calc_derivative(t, y, y_dot_);
  }
  find_rest(ode, t, shortest, y, what);
  return what;
}

void Latches::demand_inside(const SystemOde& ode, double t, double slack, const VectorXd& y) const {
  for (const Watched& w : latches_) {
    if (ode.data().tree.mode[static_cast<size_t>(w.latch.u_row)] != HingeMode::Free) continue;
    const double q = y[w.latch.q_row], stop = std::clamp(q, w.latch.lower, w.latch.upper);
    if (std::abs(q - stop) <= calc_slack(stop) + slack * std::abs(y[ode.num_q() + w.latch.u_row])) continue;
    throw ComputationError("run.beyond-stop", {},
                           w.latch.name + " comes free at " + short_text(q) + ", beyond its stop at " +
                               short_text(stop) + ", at t = " + short_text(t),
                           "keep its motion within its stops, or release it where it is");
  }
}

void Latches::get_memory(VectorXd& memory) const {
  for (size_t i = 0; i < latches_.size(); ++i) {
    const auto at = kMemory * static_cast<Eigen::Index>(i);
    memory[at] = latches_[i].rests ? 2 : latches_[i].slide;
    memory[at + 1] = latches_[i].stop;
    memory[at + 2] = latches_[i].hardest;
    memory[at + 3] = latches_[i].farthest;
  }
}

void Latches::set_memory(const VectorXd& memory, SystemOde& ode) {
  for (size_t i = 0; i < latches_.size(); ++i) {
    const auto at = kMemory * static_cast<Eigen::Index>(i);
    Watched& w = latches_[i];
    w.rests = memory[at] == 2;
    w.slide = w.rests ? 0 : static_cast<int>(memory[at]);
    w.stop = static_cast<int>(memory[at + 1]);
    w.hardest = memory[at + 2];
    w.farthest = memory[at + 3];
    ode.data().tree.slide[w.latch.u_row] = w.slide;
  }
}

}  // namespace bough::solver
