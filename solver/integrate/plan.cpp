#include "solver/integrate/plan.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace bough::solver {
namespace {

bool check_simulation(const records::SimulationRecord& s, Diagnostics& diagnostics) {
  const int errors = diagnostics.num_errors();
  const std::vector<std::string> known = {"adams", "bdf", "rk", "rk4"};
  if (std::find(known.begin(), known.end(), s.integrator) == known.end()) {
    const std::string near = find_nearest(s.integrator, known);
    diagnostics.error("run.unknown-integrator", s.at, "the integrator '" + s.integrator + "' is unknown",
                      near.empty() ? "use adams, bdf, rk or rk4" : "did you mean '" + near + "'?");
  }
  const auto demand = [&](bool condition, const std::string& what, const std::string& advice) {
    if (!condition) diagnostics.error("run.bad-simulation", s.at, what, advice);
  };
  demand(std::isfinite(s.start), "start is not a finite number", "give start = 0 or another time");
  demand(std::isfinite(s.duration) && s.duration > 0, "duration is not a positive number", "give duration > 0");
  demand(std::isfinite(s.output_step) && s.output_step >= 0, "output_step is not a positive number",
         "give output_step > 0, or leave it out for a thousandth of the duration");
  demand(!(s.output_step > 0 && s.duration / s.output_step > 1e8), "output_step asks for more than 1e8 samples",
         "give a longer output_step");
  demand(std::isfinite(s.step) && s.step >= 0, "step is not a positive number", "give step > 0");
  demand(s.integrator != "rk4" || s.step > 0, "rk4 has no step", "give step = SECONDS in [simulation]");
  if (s.integrator != "rk4") {
    demand(s.relative_tolerance > 0 && s.relative_tolerance < 1, "relative_tolerance is not between 0 and 1",
           "give 1e-6 to 1e-12");
    demand(s.absolute_tolerance > 0 && std::isfinite(s.absolute_tolerance), "absolute_tolerance is not positive",
           "give a small positive value");
  }
  demand(s.divergence_limit > 0, "divergence_limit is not positive", "give a large positive value");
  return diagnostics.num_errors() == errors;
}

}  // namespace

RunPlan make_run_plan(const records::SimulationRecord& s, const std::vector<double>& breakpoints,
                      Diagnostics& diagnostics) {
  RunPlan plan;
  if (!check_simulation(s, diagnostics)) return plan;
  const double end = s.start + s.duration;
  plan.output_step = s.output_step > 0 ? std::min(s.output_step, s.duration) : s.duration / 1000;
  const long count = std::max(1L, std::lround(std::ceil(s.duration / plan.output_step - 1e-9)));
  for (long i = 0; i < count; ++i) plan.outputs.push_back(s.start + static_cast<double>(i) * plan.output_step);
  plan.outputs.push_back(end);

  plan.step = s.step;
  if (s.integrator == "rk4") {
    const double steps = std::ceil(plan.output_step / s.step * (1 - 1e-9));
    plan.step = plan.output_step / std::max(1.0, steps);
    if (std::abs(plan.step - s.step) > 1e-9 * s.step) {
      std::ostringstream what;
      what << "the step " << s.step << " does not divide output_step " << plan.output_step << "; " << plan.step
           << " is taken";
      diagnostics.note("run.step-adjusted", s.at, what.str(), "choose a step that divides output_step");
    }
  }

  const double close = 1e-12 * s.duration;
  std::vector<double> jumps = breakpoints;
  std::sort(jumps.begin(), jumps.end());
  double start = s.start;
  for (size_t i = 0; i < jumps.size(); ++i) {
    if (jumps[i] <= s.start + close || jumps[i] >= end - close) continue;
    const double first = jumps[i];
    while (i + 1 < jumps.size() && jumps[i + 1] - first <= close) ++i;
    plan.segments.push_back({start, jumps[i], std::nextafter(first, s.start)});
    start = jumps[i];
  }
  plan.segments.push_back({start, end, end});
  return plan;
}

}  // namespace bough::solver
