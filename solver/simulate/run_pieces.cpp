// A run in pieces: what is set from outside between them, and its whole state.
#include <cmath>
#include <limits>

#include "solver/simulate/run.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {

/// Numbers of a run in one order, to a section of a state or from it.
class Numbers {
 public:
  void add(double value) { values_.push_back(value); }
  void add(const VectorXd& v) { values_.insert(values_.end(), v.data(), v.data() + v.size()); }
  VectorXd get() const { return Eigen::Map<const VectorXd>(values_.data(), std::ssize(values_)); }

 private:
  std::vector<double> values_;
};

class Taker {
 public:
  explicit Taker(const VectorXd& from) : from_(from) {}
  void take(double& value) { value = from_[at_++]; }
  template <class Integer>
  void take(Integer& value) {
    value = static_cast<Integer>(from_[at_++]);
  }
  void take(VectorXd& v) {
    v = from_.segment(at_, v.size());
    at_ += v.size();
  }

 private:
  const VectorXd& from_;
  Eigen::Index at_ = 0;
};

}  // namespace

/// Calls `action` with all that save_state() keeps in addition to the sections of a checkpoint, in one order.
template <class Action>
void Run::for_each_kept(const Action& action) {
  for (double* value : {&time_, &scanned_, &last_sample_, &crossed_, &changed_, &last_event_time_, &settled_,
                        &expected_energy_, &expected_at_})
    action(*value);
  for (int* value : {&num_quick_, &num_tiny_, &num_short_steps_, &num_settled_, &ended_by_}) action(*value);
  for (double* value : {&next_event_.time, &next_event_.left}) action(*value);
  for (bool* value : {&is_led_, &is_at_event_, &next_event_.is_jump, &needs_restart_, &is_inside_, &has_stepped_,
                      &has_changed_, &has_switched_})
    action(*value);
  for (VectorXd* v :
       {&last_events_.kinks, &last_events_.switches, &last_events_.contacts, &last_events_.signals, &largest_kinks_})
    action(*v);
}

const VectorXd& Run::memory() const { return ode_.data().signals.memory; }

void Run::put_memory(int row, double value) { ode_.data().signals.memory[row] = value; }

void Run::set_held(const std::vector<std::pair<int, double>>& rows) {
  VectorXd& memory = ode_.data().signals.memory;
  bool has_jumped = false;
  for (const auto& [row, value] : rows) {
    has_jumped = has_jumped || memory[row] != value;
    memory[row] = value;
  }
  if (!has_jumped || outcome_) return;
  expected_at_ = -std::numeric_limits<double>::infinity();
  if (!settle_jump()) return;
  const bool is_within_step = is_inside_ && integrator_->time() != time_;
  if (!is_within_step && !has_changed_ && !integrator_->has_history()) return;
  needs_restart_ = true;
  is_inside_ = false;
}

records::Checkpoint Run::save_state() {
  fill_checkpoint(time_);
  records::Checkpoint saved = checkpoint_;
  Numbers pieces;
  for_each_kept([&](const auto& kept) { pieces.add(kept); });
  saved.memory.emplace_back("pieces", pieces.get());
  // A pause within a step keeps the state from which the step is repeated.
  const bool is_within_step = is_inside_ && !integrator_->has_history() && integrator_->time() != time_;
  VectorXd step(is_within_step ? 2 + ode_.size() : 0);
  if (is_within_step) {
    step[0] = integrator_->last_time();
    step[1] = integrator_->time();
    integrator_->calc_state(step[0], step.tail(ode_.size()));
  }
  saved.memory.emplace_back("step", step);
  return saved;
}

void Run::restore_state(const records::Checkpoint& saved) {
  const VectorXd* pieces = saved.find("pieces");
  const VectorXd* step = saved.find("step");
  Eigen::Index expected = 0;
  for_each_kept([&](const auto& kept) {
    Numbers one;
    one.add(kept);
    expected += one.get().size();
  });
  const bool is_whole = pieces && pieces->size() == expected && step &&
                        (step->size() == 0 || step->size() == 2 + ode_.size()) && saved.state.size() == ode_.size() &&
                        saved.state.allFinite() && is_memory_good(saved);
  if (!is_whole)
    throw InputError("run.bad-checkpoint", spec_.simulation.at, "the state does not belong to this system",
                     "restore what a simulation of the same system, integrator and times has saved");
  checkpoint_.state = y_ = saved.state;
  checkpoint_.time = saved.time;
  outcome_.reset();
  waiting_.clear();
  has_look_ = false;
  switching_.clear();
  evaluated_.number = -1;
  monitor_.set_memory(*saved.find("energy"));
  setup_.recorder.quaternions = *saved.find("quaternions");
  limit_.set_memory(*saved.find("limits"));
  ode_.set_memory(*saved.find("discrete"));
  if (!ode_.system().num_levels.empty()) set_variant();
  joint_contacts_.set_memory(*saved.find("latches"), ode_);
  set_control_memory(*saved.find("control"));
  const VectorXd& events = *saved.find("events");
  passed_ = events[0];
  setup_.triggers.signs = events.tail(events.size() - 1);
  Taker taker(*pieces);
  for_each_kept([&](auto& kept) { taker.take(kept); });
  time_events_.skip_outputs(time_);
  // The end of the run is not a time event if a longer run continues from the state.
  if (std::isfinite(next_event_.time) && !time_events_.find_at(next_event_.time)) find_next_stop();
  if (ended_by_ >= 0) {
    const Occurrence end{time_, static_cast<size_t>(ended_by_)};
    outcome_ = SimulateOutcome{true, time_, describe_end(end), progress_, monitor_.worst(), true};
    return;
  }
  if (is_led_ || integrator_->has_history() || time_ >= time_events_.end()) {
    needs_restart_ = true;
    is_inside_ = false;
    return;
  }
  stop_ = time_events_.find_next(time_);
  Eigen::Vector4d memory = *saved.find("stepper");
  if (step->size() > 0) {
    integrator_->reset((*step)[0], step->tail(ode_.size()), stop_.time, stop_.left);
    memory[3] -= 1;
    integrator_->set_memory(memory);
    guard([&] { integrator_->step(memory[1]); });
  } else {
    integrator_->reset(time_, y_, stop_.time, stop_.left);
    integrator_->set_memory(memory);
  }
  is_started_ = true;
}

}  // namespace bough::solver
