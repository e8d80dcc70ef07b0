#pragma once
/// \file Functions of time: [[function]] of a system file.
#include <limits>
#include <map>
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
  /// Value with its first and second derivative at t; at a jump that of the right limit.
  virtual Value calc(double t) const = 0;
  /// Times at which f or a derivative jumps: where f is a motion, the integrator stops and restarts there. Ascending.
  virtual std::vector<double> jump_times() const { return {}; }
  /// Jump times at which the integrator restarts where f is a force; none for points of a table of a smooth curve.
  virtual std::vector<double> force_jump_times() const { return jump_times(); }
  /// Times that no step may pass over, so that none misses a short event in a long rest. No restarts. Ascending.
  virtual std::vector<double> mesh_times() const { return {}; }
  /// Returns true if f_dot and f_ddot are known. Else they are NaN, and f cannot prescribe a motion.
  virtual bool has_derivatives() const { return true; }
  /// A copy for another thread; nullptr: calc() writes nothing, so that threads can share the function.
  virtual std::unique_ptr<const TimeFunction> clone() const { return nullptr; }
};

/// The functions of a system as one thread evaluates them: copies of those that threads cannot share.
class FunctionCopies {
 public:
  FunctionCopies() = default;
  explicit FunctionCopies(const std::vector<const TimeFunction*>& functions);
  /// The copy of a function of the system, or the function itself where threads can share it.
  const TimeFunction& operator[](const TimeFunction& f) const { return copies_.empty() ? f : find(f); }

 private:
  const TimeFunction& find(const TimeFunction& f) const;
  std::vector<std::pair<const TimeFunction*, std::shared_ptr<const TimeFunction>>> copies_;  ///< by address
};

/// Functions by name; one that failed maps to nullptr.
using FunctionMap = std::map<std::string, const TimeFunction*>;

/// Start and end of the run, for functions that jump periodically.
struct TimeSpan {
  double start = 0, end = 0;
};

/// Types: constant(value) | step(value, at = 0, before = 0) | ramp(value, from = 0, to): 0 before, linear, value after
/// | pulse(value, at = 0, width) | doublet(value, at = 0, width): value, then -value, each for width |
/// sine(amplitude, frequency_hz or omega, phase = 0, offset = 0) | sawtooth(amplitude, frequency_hz, rise = 1, at = 0,
/// offset = 0) | chirp, sweep(amplitude, from_hz, to_hz, at = 0, duration, phase = 0, offset = 0; law of the sweep) |
/// table(x, y, interpolation): linear, or a cubic spline (not-a-knot); the end values hold outside | spinup(rate,
/// duration): θ(t) of NASA-CR-202063, 4.1.4.1 | expression(expression, rate, acceleration: formulas of t; x: times of
/// its jumps and kinks) | sum(of, weights) | product(of, gain = 1), of `others`. At a jump the value after it holds
/// (right-continuous). Reports unknown types, missing or unknown parameters (with the nearest match), NaN or unsorted
/// tables. Returns nullptr when it reported an error.
std::unique_ptr<const TimeFunction> make_time_function(const records::FunctionRecord& record, Diagnostics& diagnostics,
                                                       const TimeSpan& run = {}, const FunctionMap& others = {});

}  // namespace bough::solver
