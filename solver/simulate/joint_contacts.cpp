#include "solver/simulate/joint_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "solver/forces/stop_tolerance.hpp"
#include "solver/simulate/run.hpp"
#include "solver/system/derivative.hpp"
#include "solver/system/mobility.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {

constexpr int kMaxImpactRounds = 200;
constexpr double kImpactNoise = 1e-9;  // of the hardest blow of a moment: what is slower stays together
constexpr double kTouch = 1e-11;       // of where a stop is, or how far it was: what is no farther from it touches it
// Acceleration of a coordinate relative to what its friction can change, above which the loops force its rate.
constexpr double kForced = 1e6;
// Travel of a coordinate in the shortest bounce, 1e-9 of the run: a coordinate that its loops hold stands still below.
constexpr double kHeldTravel = 1e-15;
constexpr double kMinMobility = 1e-14;  // in a loop, relative to the open tree: round-off of the loop's factor

int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

// Force by which a sticking contact may exceed its limit by round-off: a bearing without load has a limit of zero.
template <class Contacts>
double calc_force_noise(const Contacts& contacts, const TreeData& data) {
  constexpr double kNoise = 1e-13;  // of the largest friction
  double largest = 0;
  for (const auto& w : contacts)
    if (const double high = w.high(data); std::isfinite(high)) largest = std::max(largest, high);
  return kNoise * largest;
}

// Returns true if the loops force the rate of a free coordinate through zero, so that its friction cannot hold it.
// One coordinate can stick if |a| <= 2 A F, with A its mobility and F the limit of its friction. Coordinates that stick
// together hold each other, hence the wide margin; A is of the order of (rate / rate of the loop)², which is round-off
// at a zero of the rate that the loop's motion forces. A lock there would stop the whole loop.
bool is_forced(const System& system, SystemData& data, int row, double acceleration, double limit) {
  if (data.loops.blocks.empty() || acceleration == 0) return false;
  const Mobility mobility = calc_mobility(system, data, row);
  return std::abs(acceleration) > kForced * std::max(mobility.closed, kMinMobility * mobility.open) * limit;
}

// Returns true if its loops, by joints that stick, are locked or prescribed, hold a free coordinate with friction:
// neither its friction nor the motion changes its rate, which is round-off.
bool is_held_by_loop(const System& system, SystemData& data, int row, double acceleration, double limit) {
  constexpr double kNoMobility = 1e-12;
  if (data.loops.blocks.empty()) return false;
  const Mobility mobility = calc_mobility(system, data, row);
  return mobility.closed <= kNoMobility * mobility.open &&
         std::abs(acceleration) <= kForced * kMinMobility * mobility.open * limit;
}

// Derivatives of a trial state of the stick test. The reactions of a coordinate that cannot stick may be so large that
// the friction of another one has no value: the trial then has no friction by bearing load, and keeps the limits of the
// last state. \return false in that case.
bool calc_trial(HybridSystem& ode, double t, const VectorXd& y, VectorXd& y_dot) {
  try {
    ode.calc_derivative(t, y, y_dot);
    return true;
  } catch (const ComputationError& error) {
    if (error.items().front().id != "solver.friction-jams") throw;
  }
  ode.data().friction.is_frozen = true;
  calc_derivative(ode.system(), ode.data(), t, y, y_dot);
  ode.data().friction.is_frozen = false;
  return false;
}

}  // namespace

JointContacts::JointContacts(const System& system) : system_(&system) {
  for (const JointContact& contact : system.joint_contacts) {
    Watched w;
    w.contact = contact;
    joint_contacts_.push_back(std::move(w));
  }
}

void JointContacts::calc_event_functions(const SystemData& data, VectorXd& event_functions) const {
  event_functions.setConstant(-1);
  const double noise = calc_force_noise(joint_contacts_, data.tree);
  for (size_t i = 0; i < joint_contacts_.size(); ++i) {
    const Watched& w = joint_contacts_[i];
    auto own = event_functions.segment<kNumEventFunctions>(kNumEventFunctions * static_cast<Eigen::Index>(i));
    const HingeMode mode = data.tree.mode[static_cast<size_t>(w.contact.u_row)];
    const double q = data.tree.q[w.contact.q_row], rate = data.tree.u[w.contact.u_row];
    if (mode == HingeMode::Locked && w.rests) {
      const double force = data.tree.calc_constraint_force(w.contact.u_row);
      const double high = w.high(data.tree), low = w.low(data.tree);
      if (std::isfinite(high)) own[0] = force - high - noise;
      if (std::isfinite(low)) own[1] = low - force - noise;
    } else if (mode == HingeMode::Free) {
      // Past the stop and moving on: a coordinate that has just rebounded may still be past it by round-off.
      if (std::isfinite(w.contact.lower)) own[0] = std::min(w.contact.lower - q, -rate * shortest_);
      if (std::isfinite(w.contact.upper)) own[1] = std::min(q - w.contact.upper, rate * shortest_);
      if (w.slide != 0)
        own[2] = -w.slide * rate;
      else if (w.contact.has_friction() && shortest_ > 0)  // held by its loops so far
        own[2] = std::abs(rate) - kHeldTravel / shortest_;
    }
  }
}

void JointContacts::find_stops(const HybridSystem& ode, double resolution, const VectorXd& y) {
  for (Watched& w : joint_contacts_) {
    const double q = y[w.contact.q_row], rate = y[ode.num_q() + w.contact.u_row];
    w.farthest = std::max(w.farthest, std::abs(q));
    const auto touches = [&](double past, double at) {
      return std::isfinite(at) &&
             past > -(kTouch * std::max(std::abs(at), w.farthest) + 4 * resolution * std::abs(rate));
    };
    if (w.rests && w.stop != 0) continue;
    const bool is_low = touches(w.contact.lower - q, w.contact.lower),
               is_high = touches(q - w.contact.upper, w.contact.upper);
    w.stop = is_low && is_high ? (rate < 0 ? -1 : 1) : is_low ? -1 : is_high ? 1 : 0;
  }
}

void JointContacts::lock(HybridSystem& ode, double t, const std::vector<bool>& rests, VectorXd& y) const {
  const auto& modes = ode.data().tree.mode;
  const auto get_next = [&](size_t i) {
    const HingeMode mode = modes[static_cast<size_t>(joint_contacts_[i].contact.u_row)];
    if (mode == HingeMode::Prescribed || (mode == HingeMode::Locked && !joint_contacts_[i].rests)) return mode;
    return rests[i] ? HingeMode::Locked : HingeMode::Free;
  };
  size_t changed = 0;
  while (changed < joint_contacts_.size() &&
         get_next(changed) == modes[static_cast<size_t>(joint_contacts_[changed].contact.u_row)])
    ++changed;
  if (changed == joint_contacts_.size()) {
    ode.keep_modes(t, y);
    return;
  }
  DiscreteState next = get_discrete(ode.data());
  for (size_t i = 0; i < joint_contacts_.size(); ++i)
    next.mode[static_cast<size_t>(joint_contacts_[i].contact.u_row)] = get_next(i);
  ode.stick(t, next, y);
}

// Impacts are simultaneous within a round. The rates they cause at other stops are the impacts of the next round, so
// that an impact travels along a row of touching bodies. Without restitution a touching body takes part at once.
bool JointContacts::strike_stops(HybridSystem& ode, double t, double shortest, VectorXd& y,
                                 std::vector<std::string>& what) {
  const int u = ode.num_q();
  double first = 0;
  for (int round = 0;; ++round) {
    double hardest = 0;
    for (const Watched& w : joint_contacts_) {
      if (!can_strike(ode, w)) continue;
      const double into = w.stop * y[u + w.contact.u_row];
      if (into > calc_slowest(w, u, shortest)) hardest = std::max(hardest, into);
    }
    if (hardest == 0) return round > 0;
    if (round == 0) {  // an impulse overcomes whatever holds
      lock(ode, t, std::vector<bool>(joint_contacts_.size(), false), y);
      for (Watched& w : joint_contacts_) w.rests = false;
      first = hardest;
    }
    const bool is_last = hardest <= kImpactNoise * first || round == kMaxImpactRounds;
    std::vector<Impact> blows;
    std::vector<const Watched*> struck;
    for (Watched& w : joint_contacts_) {
      if (!can_strike(ode, w)) continue;
      const double into = w.stop * y[u + w.contact.u_row];
      const bool comes = into > std::max(calc_slowest(w, u, shortest), kImpactNoise * first),
                 stays = into >= -kImpactNoise * first;
      if (round == kMaxImpactRounds && comes && w.contact.restitution >= 1) fail_endless(what);
      if (!comes && !(stays && (is_last || w.contact.restitution == 0))) continue;
      blows.push_back({w.contact.u_row, w.stop, is_last ? 0 : w.contact.restitution});
      struck.push_back(&w);
      w.hardest = std::max(w.hardest, into);
    }
    const VectorXd before = y.segment(u, ode.num_coordinates() - u);
    ode.strike(t, blows, y);
    for (size_t i = 0; i < blows.size(); ++i) {
      const double from = before[blows[i].row], to = y[u + blows[i].row];
      if (blows[i].impulse == 0 || std::abs(from) <= kImpactNoise * first) continue;
      what.push_back(struck[i]->contact.name + " meets its stop at " +
                     short_text(struck[i]->stop < 0 ? struck[i]->contact.lower : struck[i]->contact.upper) +
                     ": its rate turns from " + short_text(from) + " to " + short_text(to) + " by an impulse of " +
                     short_text(blows[i].impulse));
    }
    if (is_last) return true;
  }
}

double JointContacts::calc_slowest(const Watched& w, int u, double shortest) const {
  // The acceleration bounds the rate of a bounce; without one (a box that rocks on two feet) the largest impact does.
  return std::max(std::abs(y_dot_[u + w.contact.u_row]) * shortest, w.stop != 0 ? kImpactNoise * w.hardest : 0);
}

bool JointContacts::can_strike(const HybridSystem& ode, const Watched& w) const {
  return w.stop != 0 && ode.data().tree.mode[static_cast<size_t>(w.contact.u_row)] == HingeMode::Free;
}

void JointContacts::fail_endless(const std::vector<std::string>& what) const {
  throw ComputationError("run.endless-impacts", system_->tree.bodies.front().hinge_at,
                         "impacts between rigid stops repeat without end, last " + what.back(),
                         "give them a restitution below 1, or a stiffness in its place");
}

// Stick test: locks every slow coordinate that friction or a stop can hold. Then releases, one at a time, the
// coordinate whose constraint force exceeds its limit most.
void JointContacts::find_rest(HybridSystem& ode, double t, double shortest, VectorXd& y,
                              std::vector<std::string>& what) {
  const int u = ode.num_q();
  auto& [rests, before, slide, slowest] = scratch_;
  rests.assign(joint_contacts_.size(), false);
  before.assign(joint_contacts_.size(), false);
  slide.assign(joint_contacts_.size(), 0);
  slowest.assign(joint_contacts_.size(), 0);
  // Sticking joints that can hold their forces: coordinates that these keep still need no lock.
  const auto can_hold = [&](const Watched& w) {
    const TreeData& data = ode.data().tree;
    if (!w.rests || data.mode[static_cast<size_t>(w.contact.u_row)] != HingeMode::Locked) return true;
    const double force = data.calc_constraint_force(w.contact.u_row);
    const double noise = calc_force_noise(joint_contacts_, data);
    return force <= w.high(data) + noise && force >= w.low(data) - noise;
  };
  const bool holds = std::all_of(joint_contacts_.begin(), joint_contacts_.end(), can_hold);
  const bool none_rests = std::none_of(joint_contacts_.begin(), joint_contacts_.end(), [&](const Watched& w) {
    return w.rests && ode.data().tree.mode[static_cast<size_t>(w.contact.u_row)] == HingeMode::Locked;
  });
  for (size_t i = 0; i < joint_contacts_.size(); ++i) {
    const Watched& w = joint_contacts_[i];
    const HingeMode mode = ode.data().tree.mode[static_cast<size_t>(w.contact.u_row)];
    before[i] = w.rests && mode == HingeMode::Locked;
    if (mode == HingeMode::Prescribed || (mode == HingeMode::Locked && !w.rests)) continue;
    const double rate = y[u + w.contact.u_row], acceleration = y_dot_[u + w.contact.u_row];
    slide[i] = w.contact.has_friction() ? sign(rate) : 0;
    const bool is_held = w.contact.has_friction() || w.stop != 0;
    slowest[i] = calc_slowest(w, u, shortest);
    // Locks and prescribed motions, and no friction, hold the loop: the friction is zero, not that of a round-off rate.
    if (none_rests && mode == HingeMode::Free && w.contact.has_friction() && w.stop == 0 &&
        std::abs(rate) * shortest <= kHeldTravel &&
        is_held_by_loop(*system_, ode.data(), w.contact.u_row, acceleration, w.high(ode.data().tree))) {
      slide[i] = 0;
      continue;
    }
    const bool is_slow = std::abs(rate) <= slowest[i];
    // A coordinate that slides and has not reversed continues to slide.
    const bool turns = !w.contact.has_friction() || w.slide == 0 || w.slide * rate <= 0;
    if (!is_held || !is_slow || !turns) continue;
    if (mode == HingeMode::Free && w.slide == 0 && holds &&
        is_held_by_loop(*system_, ode.data(), w.contact.u_row, acceleration, w.high(ode.data().tree))) {
      slide[i] = 0;
      continue;
    }
    if (w.stop == 0 && mode == HingeMode::Free &&
        is_forced(*system_, ode.data(), w.contact.u_row, acceleration, w.high(ode.data().tree))) {
      if (slide[i] == 0) slide[i] = sign(acceleration);
      continue;
    }
    rests[i] = true;  // the impulse of locking it removes the rest of its rate
  }
  for (size_t left = joint_contacts_.size() + 1; left > 0; --left) {
    lock(ode, t, rests, y);
    for (size_t i = 0; i < joint_contacts_.size(); ++i) {
      joint_contacts_[i].rests = rests[i];
      joint_contacts_[i].slide = rests[i] ? 0 : slide[i];
      ode.data().tree.slide[joint_contacts_[i].contact.u_row] = joint_contacts_[i].slide;
    }
    const bool has_value = calc_trial(ode, t, y, y_dot_);
    double max_excess = calc_force_noise(joint_contacts_, ode.data().tree);
    size_t released = joint_contacts_.size();
    for (size_t i = 0; i < joint_contacts_.size(); ++i) {
      if (!rests[i]) continue;
      const double force = ode.data().tree.calc_constraint_force(joint_contacts_[i].contact.u_row);
      const double excess =
          std::max(force - joint_contacts_[i].high(ode.data().tree), joint_contacts_[i].low(ode.data().tree) - force);
      if (!(excess > max_excess)) continue;
      max_excess = excess;
      released = i;
    }
    if (released == joint_contacts_.size()) {
      if (!has_value) ode.calc_derivative(t, y, y_dot_);  // fails: this is no trial
      break;
    }
    rests[released] = false;
    if (joint_contacts_[released].contact.has_friction())
      slide[released] = ode.data().tree.calc_constraint_force(joint_contacts_[released].contact.u_row) > 0 ? -1 : 1;
  }
  const bool any_rests = std::find(rests.begin(), rests.end(), true) != rests.end();
  for (size_t i = 0; i < joint_contacts_.size(); ++i) {
    Watched& w = joint_contacts_[i];
    const int row = w.contact.u_row;
    // The sign of round-off is no reversal: the coordinate is tested again when a joint of its loop slips.
    if (any_rests && w.slide != 0 && std::abs(y[u + row]) <= slowest[i] &&
        is_held_by_loop(*system_, ode.data(), row, y_dot_[u + row], w.high(ode.data().tree)))
      w.slide = 0;
    if (rests[i] && !before[i])
      what.push_back(w.contact.name + (w.stop != 0 ? " comes to rest at its stop" : " sticks"));
    if (!rests[i] && before[i]) what.push_back(w.contact.name + (w.stop != 0 ? " leaves its stop" : " slips"));
  }
}

std::vector<std::string> JointContacts::settle(HybridSystem& ode, double t, double shortest, VectorXd& y) {
  std::vector<std::string> what;
  shortest_ = shortest;
  if (y_dot_.size() == 0) y_dot_ = VectorXd::Zero(ode.size());
  for (Watched& w : joint_contacts_) ode.data().tree.slide[w.contact.u_row] = w.slide;
  ode.calc_derivative(t, y, y_dot_);
  find_stops(ode, shortest, y);
  if (strike_stops(ode, t, shortest, y, what)) {
    for (Watched& w : joint_contacts_) {
      w.slide = w.contact.has_friction() ? sign(y[ode.num_q() + w.contact.u_row]) : 0;
      ode.data().tree.slide[w.contact.u_row] = w.slide;
    }
    ode.calc_derivative(t, y, y_dot_);
  }
  find_rest(ode, t, shortest, y, what);
  return what;
}

void JointContacts::demand_inside(const HybridSystem& ode, double t, double slack, const VectorXd& y) const {
  for (const Watched& w : joint_contacts_) {
    if (ode.data().tree.mode[static_cast<size_t>(w.contact.u_row)] != HingeMode::Free) continue;
    const double q = y[w.contact.q_row], stop = std::clamp(q, w.contact.lower, w.contact.upper);
    if (std::abs(q - stop) <= calc_slack(stop) + slack * std::abs(y[ode.num_q() + w.contact.u_row])) continue;
    throw ComputationError("run.beyond-stop", {},
                           w.contact.name + " comes free at " + short_text(q) + ", beyond its stop at " +
                               short_text(stop) + ", at t = " + short_text(t),
                           "keep its motion within its stops, or release it where it is");
  }
}

void JointContacts::get_memory(VectorXd& memory) const {
  for (size_t i = 0; i < joint_contacts_.size(); ++i) {
    const auto at = kMemory * static_cast<Eigen::Index>(i);
    memory[at] = joint_contacts_[i].rests ? 2 : joint_contacts_[i].slide;
    memory[at + 1] = joint_contacts_[i].stop;
    memory[at + 2] = joint_contacts_[i].hardest;
    memory[at + 3] = joint_contacts_[i].farthest;
  }
}

void JointContacts::set_memory(const VectorXd& memory, HybridSystem& ode) {
  for (size_t i = 0; i < joint_contacts_.size(); ++i) {
    const auto at = kMemory * static_cast<Eigen::Index>(i);
    Watched& w = joint_contacts_[i];
    w.rests = memory[at] == 2;
    w.slide = w.rests ? 0 : static_cast<int>(memory[at]);
    w.stop = static_cast<int>(memory[at + 1]);
    w.hardest = memory[at + 2];
    w.farthest = memory[at + 3];
    ode.data().tree.slide[w.contact.u_row] = w.slide;
  }
}

}  // namespace bough::solver
