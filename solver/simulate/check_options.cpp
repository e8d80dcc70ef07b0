#include <algorithm>
#include <cmath>
#include <sstream>

#include "solver/simulate/time_events.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {
namespace {

/// Limit of the number of steps, for any system.
constexpr double kMaxSteps = 1e11;

bool check_simulation(const records::SimulationRecord& s, Diagnostics& diagnostics) {
  const int errors = diagnostics.num_errors();
  const std::vector<std::string> known = {"adams", "bdf", "rk", "radau", "rk4", "implicit", "auto"};
  if (std::find(known.begin(), known.end(), s.integrator) == known.end()) {
    diagnostics.error("run.unknown-integrator", s.at, "the integrator '" + s.integrator + "' is unknown",
                      suggest_name(s.integrator, known, "use adams, bdf, rk, radau, rk4, implicit or auto"));
  }
  const auto demand = [&](bool condition, const std::string& what, const std::string& advice) {
    if (!condition) diagnostics.error("run.bad-simulation", s.at, what, advice);
    return condition;
  };
  const bool starts = demand(std::isfinite(s.start), "start is not a finite number", "give start = 0 or another time");
  const bool lasts =
      demand(std::isfinite(s.duration) && s.duration > 0, "duration is not a positive number", "give duration > 0");
  const bool steps = demand(std::isfinite(s.output_step) && s.output_step >= 0, "output_step is not a positive number",
                            "give output_step > 0, or leave it out for a thousandth of the duration");
  const bool good = starts && lasts && steps;
  std::ostringstream longer;
  longer << "output_step " << s.output_step << " is longer than duration " << s.duration;
  demand(!good || s.output_step <= s.duration * (1 + 1e-12), longer.str(), "give a shorter output_step");
  demand(!(s.output_step > 0 && s.duration / s.output_step > 1e8), "output_step asks for more than 1e8 samples",
         "give a longer output_step");
  const bool good_step = demand(std::isfinite(s.step) && s.step >= 0, "step is not a positive number", "give step > 0");
  const bool is_fixed = s.integrator == "rk4" || s.integrator == "implicit";
  demand(!is_fixed || s.step > 0, s.integrator + " has no step", "give step = SECONDS in [simulation]");
  demand(!(good && good_step && s.step > 0 && s.duration / s.step > kMaxSteps), "step asks for more than 1e11 steps",
         is_fixed ? "give a longer step" : "give a longer largest step, or leave it out");
  // Steps much shorter than the output step must still change t.
  const double interval = s.output_step > 0 ? s.output_step : s.duration / 1000;
  const double finest =
      std::numeric_limits<double>::epsilon() * std::max(std::abs(s.start), std::abs(s.start + s.duration));
  std::ostringstream far;
  const bool is_start = std::abs(s.start) > s.duration;
  if (is_start)
    far << "start = " << s.start << " is too far from zero";
  else
    far << "duration = " << s.duration << " is too long";
  far << ": times there are " << finest << " apart, samples " << interval;
  demand(!good || 1e3 * finest < interval, far.str(),
         is_start ? "count time from a nearer start" : "give a shorter duration, or a longer output_step");
  if (!is_fixed) {
    demand(s.relative_tolerance > 0 && s.relative_tolerance < 1, "relative_tolerance is not between 0 and 1",
           "give 1e-6 to 1e-12");
    demand(s.absolute_tolerance > 0 && std::isfinite(s.absolute_tolerance), "absolute_tolerance is not positive",
           "give a small positive value");
    demand(s.absolute_tolerance_modes >= 0 && std::isfinite(s.absolute_tolerance_modes),
           "absolute_tolerance_modes is not positive", "give a small positive value");
  }
  demand(s.rk_order == 5 || s.rk_order == 8, "rk_order is " + std::to_string(s.rk_order), "give 5 or 8");
  demand(s.divergence_limit > 0, "divergence_limit is not positive", "give a large positive value");
  demand(s.energy_error_limit > 0, "energy_error_limit is not positive", "give a small positive value, as 0.01");
  demand(s.output_every >= 1, "output_every is not positive", "give 1 for every sample");
  demand(
      !good || (s.output_from <= s.start + s.duration && s.output_until >= s.start && s.output_from <= s.output_until),
      "output_from and output_until leave no sample", "give times within the run");
  return diagnostics.num_errors() == errors;
}

}  // namespace

RunPlan make_run_plan(const records::SimulationRecord& s, Diagnostics& diagnostics) {
  RunPlan plan;
  if (!check_simulation(s, diagnostics)) return plan;
  plan.start = s.start;
  plan.end = s.start + s.duration;
  plan.output_step = s.output_step > 0 ? std::min(s.output_step, s.duration) : s.duration / 1000;
  plan.step = s.step;
  if (s.integrator == "rk4" || s.integrator == "implicit") {
    const double steps = std::ceil(plan.output_step / s.step * (1 - 1e-9));
    plan.step = plan.output_step / std::max(1.0, steps);
    if (std::abs(plan.step - s.step) > 1e-9 * s.step) {
      std::ostringstream what;
      what << "the step " << s.step << " does not divide output_step " << plan.output_step << "; " << plan.step
           << " is taken";
      diagnostics.note("run.step-adjusted", s.at, what.str(), "choose a step that divides output_step");
    }
  }
  return plan;
}

}  // namespace bough::solver
