#pragma once
/// \file Functions of time: [[function]] of a system file.
#include <memory>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/system_spec.hpp"

namespace bough::solver {

/// A scalar function of time with its first two derivatives (prescribed hinges need them).
class TimeFunction {
 public:
  virtual ~TimeFunction() = default;
  struct Value {
    double f = 0, f_dot = 0, f_ddot = 0;
  };
  virtual Value calc(double t) const = 0;
  /// Times at which f or a derivative jumps: where f is a motion, the integrator stops and restarts there. Ascending.
  virtual std::vector<double> breakpoints() const { return {}; }
  /// Those among them at which it restarts where f is a force. Points of a table that samples a smooth curve are none.
  virtual std::vector<double> corners() const { return breakpoints(); }
  /// Times that no step may pass over, so that none misses a short event in a long rest. No restarts. Ascending.
  virtual std::vector<double> landmarks() const { return {}; }
};

/// Types: constant(value) | step(value, at = 0, before = 0) | ramp(value, from = 0, to): 0 before, linear, value after
/// | pulse(value, at = 0, width) | sine(amplitude, frequency_hz or omega, phase = 0, offset = 0) | table(x, y,
/// interpolation): linear, or a cubic spline (not-a-knot); the end values hold outside | spinup(rate,
/// duration): θ(t) of NASA-CR-202063, 4.1.4.1. At a jump the value after it holds (right-continuous). Reports unknown
/// types, missing or unknown parameters (with the nearest match), NaN or unsorted tables. Returns nullptr when it
/// reported an error.
std::unique_ptr<const TimeFunction> make_time_function(const records::FunctionRecord& record, Diagnostics& diagnostics);

}  // namespace bough::solver
