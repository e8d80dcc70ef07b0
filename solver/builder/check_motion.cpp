// A prescribed motion may jump in its rate, which is an impulse, but not in its place.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "solver/builder/build.hpp"

namespace bough::solver {

namespace {
constexpr double kSamePlace = 1e-9;  // of the largest value at a jump
}

void check_motion(const records::HingeRecord& record, const records::SimulationRecord& simulation, const TreeBody& tb,
                  Diagnostics& diagnostics) {
  const double end = simulation.start + simulation.duration;
  for (size_t i = 0; i < tb.motion.size(); ++i) {
    if (tb.motion[i] == nullptr) continue;
    const auto at = [&](double t) { return tb.motion[i]->calc(t).f; };
    double scale = std::max(std::abs(at(simulation.start)), std::abs(at(end)));
    for (const double t : tb.motion[i]->jump_times()) scale = std::max(scale, std::abs(at(t)));
    for (const double t : tb.motion[i]->jump_times()) {
      const double before = at(std::nextafter(t, t - 1)), after = at(t);
      if (t <= simulation.start || t >= end || std::abs(after - before) <= kSamePlace * scale) continue;
      std::ostringstream what;
      what << "hinge '" << record.name << "': the prescribed motion of coordinate " << i + 1 << " jumps from " << before
           << " to " << after << " at t = " << t;
      diagnostics.error("system.motion-jumps", record.at, what.str(),
                        "nothing moves so far in no time: use a ramp, a table or spinup; a jump of the rate alone is "
                        "an impulse");
      break;
    }
  }
}

}  // namespace bough::solver
