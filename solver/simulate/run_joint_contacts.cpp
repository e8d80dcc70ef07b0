// Dry friction and rigid stops (docs/theory/forces.md): steps of every method end when a contact sticks, slips or
// strikes.
#include "solver/simulate/run.hpp"

namespace bough::solver {
namespace {
/// Shortest bounce, relative to the run; a contact that bounces less sticks.
constexpr double kShortestBounce = 1e-9;
/// Limit of the contact changes at one time.
constexpr int kMaxContactChanges = 100;
}  // namespace

void Run::iterate_contacts(double t) {
  if (joint_contacts_.empty()) return;
  const double shortest = kShortestBounce * (time_events_.end() - time_events_.start());
  if (latches_before_.size() == 0) latches_before_ = latches_after_ = joint_contacts_.make_memory();
  joint_contacts_.get_memory(latches_before_);
  guard([&] {
    const auto what = joint_contacts_.settle(ode_, t, shortest, y_);
    for (const auto& line : what) sink_.write_event({t, line});
    joint_contacts_.get_memory(latches_after_);
    if (!what.empty() || latches_before_ != latches_after_) has_switched_ = true;
  });
  calc_contacts(t);
  last_events_.contacts = events_.contacts;
  num_settled_ = t - settled_ <= time_events_.resolution() ? num_settled_ + 1 : 0;
  settled_ = t;
  if (num_settled_ > kMaxContactChanges)
    finish_failed(t, "run.endless-impacts", "dry friction and stops find no rest at t = " + short_text(t),
                  "give friction a smoothing, or stops a stiffness");
}

}  // namespace bough::solver
