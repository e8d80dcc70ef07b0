#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "solver/simulate/run.hpp"
#include "solver/system/system.hpp"
#include "solver/tree/coordinates.hpp"
#include "solver/tree/gimbal_lock.hpp"

namespace bough::solver {
namespace {
constexpr double kLocked = 0.05;  // sine between axes of a hinge: nearer ones are why a run stalls
/// Amplitude of a slosh pendulum beyond which it is why a run stalls: its bob, a point, nears the hinge's first axis.
constexpr double kLargestSlosh = 1.2;

/// "the slosh of tank 'lox' has an amplitude of 90 deg"; empty: none is that large.
std::string find_large_slosh(const Tree& tree, const TreeData& data) {
  for (const Tank& tank : tree.tanks) {
    for (const TreeBody& tb : tree.bodies) {
      if (tank.reserve <= 0 || tb.name != tank.name + ".slosh" || is_length(tb, 0)) continue;
      const double cosine = std::cos(data.q[tb.q_offset]) * std::cos(data.q[tb.q_offset + 1]);
      const double amplitude = std::acos(std::clamp(cosine, -1.0, 1.0));
      if (amplitude > kLargestSlosh)
        return "the slosh of tank '" + tank.name + "' has an amplitude of " +
               std::to_string(std::lround(amplitude * 180 / std::numbers::pi)) + " deg";
    }
  }
  return {};
}
}  // namespace

std::string short_text(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

void Run::fail_as_thrown() {
  try {
    throw;
  } catch (const StepFailure& failure) {
    if (failure.kind == StepFailure::Kind::Stalled) fail_stalled(failure.time, failure.detail, failure.row);
    fail_non_finite(failure.time, failure.tried);
  } catch (const ComputationError& failure) {
    sink_.end(false, failure.what());
    auto items = failure.items();
    for (Diagnostic& item : items) {
      if (item.where.file.empty()) item.where = spec_.simulation.at;
      if (item.what.find(" at t = ") == std::string::npos)
        item.what += " at t = " + short_text(is_started_ ? integrator_->time() : time_events_.start());
    }
    throw ComputationError(std::move(items));
  } catch (const Failure& failure) {
    sink_.end(false, failure.what());
    throw;
  }
}

void Run::fail_non_finite(double t, double tried) {
  const VectorXd y = integrator_->state();
  std::string what;
  try {
    what = ode_.name_first_non_finite(tried, y);
    if (what.empty()) what = ode_.name_first_non_finite(t, y);
  } catch (const Failure&) {
    // The equations fail at the accepted state: the trial state adds nothing.
  }
  if (what.empty()) {
    int row = 0;
    y.head(ode_.num_coordinates()).cwiseAbs().maxCoeff(&row);
    what = "no step from there gives finite accelerations; the largest state is " + ode_.name_row(row) + ", " +
           short_text(y[row]);
  } else {
    what += " is not a finite number";
  }
  fail_diverged(std::max(t, tried), what);
}

void Run::fail_diverged(double t, const std::string& what) {
  finish_failed(t, "run.diverged", "the run diverged at t = " + short_text(t) + ": " + what,
                "look for an unstable system, missing stiffening or a step that is too long; [simulation] "
                "divergence_limit sets the limit");
}

void Run::fail_cycle(const Occurrence& firing) {
  finish_failed(firing.time, "run.event-cycle",
                "events follow each other without end at t = " + short_text(firing.time) + ", last " +
                    setup_.triggers.describe(firing.trigger),
                "what one event does makes another come at once: give them values that lie apart, or a direction");
}

void Run::fail_stalled(double t, const std::string& detail, int row) {
  const System& system = ode_.system();
  if (const auto found = find_gimbal_lock(system.tree, ode_.data().tree, kLocked); found.body >= 0)
    finish_failed(t, "run.stalled",
                  "the integrator makes no progress at t = " + short_text(t) + ": " + detail + "; " + found.lock,
                  kGimbalAdvice);
  if (const std::string slosh = find_large_slosh(system.tree, ode_.data().tree); !slosh.empty())
    finish_failed(t, "run.stalled",
                  "the integrator makes no progress at t = " + short_text(t) + ": " + slosh +
                      ", at which its pendulum is no model of the liquid",
                  "end the run where the acceleration along the tank ends, give slosh_damping, or take slosh = false "
                  "for what coasts");
  const std::string loops = system.num_constraints() == 0
                                ? ""
                                : "look whether a driven or locked hinge takes a loop past its reach (constraint '" +
                                      system.constraint_name(0) + "'), or ";
  const std::string usual =
      setup_.integrator != "bdf"
          ? "loosen relative_tolerance, or use integrator = \"bdf\" when fast modes are damped out"
          : "loosen relative_tolerance, or leave out the fastest modes";
  const std::string state = row < 0 ? "" : "; it is " + ode_.name_row(row) + " that asks for them most";
  finish_failed(t, "run.stalled", "the integrator makes no progress at t = " + short_text(t) + ": " + detail + state,
                loops + usual);
}

void Run::finish_failed(double t, const char* id, const std::string& what, const std::string& advice) {
  sink_.write_event({t, what});
  sink_.write_energy_error(monitor_.worst());
  sink_.end(false, what);
  throw ComputationError(id, spec_.simulation.at, what, advice);
}

}  // namespace bough::solver
