#pragma once
/// \file When a run samples and where it restarts, from [simulation] and the jumps of its functions.
#include <vector>

#include "formats/records/system_spec.hpp"

namespace bough::solver {

/// A stretch without jumps. Its right-hand side is asked for times up to `latest` < end only, so that the last step
/// sees the values before the jump; the next segment starts at `end` with those after it.
struct Segment {
  double start = 0, end = 0, latest = 0;
};

struct RunPlan {
  std::vector<double> outputs;  ///< start, start + output_step, ..., exactly the end
  std::vector<Segment> segments;
  double output_step = 0;
  double step = 0;  ///< rk4: effective step; others: the largest step, 0 = free
};

/// Checks [simulation]: "run.unknown-integrator", "run.bad-simulation"; note "run.step-adjusted" when rk4's step does
/// not divide output_step. Jumps closer together than 1e-12 of the duration are one.
RunPlan make_run_plan(const records::SimulationRecord& simulation, const std::vector<double>& breakpoints,
                      Diagnostics& diagnostics);

}  // namespace bough::solver
