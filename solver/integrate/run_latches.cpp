// Dry friction and rigid stops (docs/theory/forces.md): steps of every method end where something sticks or comes
// loose.
#include "solver/integrate/locate.hpp"
#include "solver/integrate/run.hpp"

namespace bough::solver {
namespace {
/// Of the run: bounces shorter than that come to rest.
constexpr double kShortestBounce = 1e-9;
/// Changes without any progress that are too many.
constexpr int kMostTimes = 100;
}  // namespace

void Run::settle_latches(double t) {
  if (latches_.empty()) return;
  const double shortest = kShortestBounce * (timeline_.end() - timeline_.start());
  VectorXd before = latches_.make_memory(), after = before;
  latches_.get_memory(before);
  guard([&] {
    const auto what = latches_.settle(ode_, t, shortest, y_);
    for (const auto& line : what) sink_.write_event({t, line});
    latches_.get_memory(after);
    if (!what.empty() || before != after) has_switched_ = true;
    ode_.calc_derivative(t, y_, y_dot_);
    latches_.calc_guards(ode_.data(), latch_guards_);
  });
  last_latch_guards_ = latch_guards_;
  num_settled_ = t - settled_ <= timeline_.resolution() ? num_settled_ + 1 : 0;
  settled_ = t;
  if (num_settled_ > kMostTimes)
    finish_failed(t, "run.endless-impacts", "dry friction and stops find no rest at t = " + short_text(t),
                  "give friction a smoothing, or stops a stiffness");
}

std::optional<double> Run::find_latch(const Stop& stop, double to) {
  if (latches_.empty()) return {};
  const double from = stepper_->last_time();
  const auto calc = [&](double t) -> const VectorXd& {
    guard([&] {
      stepper_->calc_state(t, y_);
      ode_.calc_derivative(std::min(t, stop.latest), y_, y_dot_);
      latches_.calc_guards(ode_.data(), latch_guards_);
    });
    return latch_guards_;
  };
  const VectorXd at_end = calc(to);
  std::optional<double> first;
  for (Eigen::Index i = 0; i < at_end.size(); ++i) {
    if (!(at_end[i] > 0)) continue;
    // Where it has just left what it was at, rounding may have it on either side: it is taken for this one.
    const double before = std::min(last_latch_guards_[i], -1e-9 * at_end[i]);
    const double at =
        locate_crossing([&](double t) { return calc(t)[i]; }, from, before, to, at_end[i], timeline_.resolution());
    first = std::min(first.value_or(to), at);
  }
  last_latch_guards_ = at_end;
  return first;
}

}  // namespace bough::solver
