#pragma once
/// \file Linear models along a parameter of the system file, or along its run.
#include <functional>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/linear_sweep.hpp"

namespace bough::analysis {

/// "name=from:to:n" or, evenly on a logarithmic scale, "name=from:to:n:log"; n >= 2 values. Throws
/// InputError("cli.bad-sweep").
struct SweepRange {
  std::string name;
  std::vector<double> values;
};
/// Parses the value of --sweep; both end values are in the range exactly.
SweepRange parse_sweep(const std::string& text);

/// One model a value, their poles followed. Throws ComputationError("linear.sweep-states") where a model has other
/// states or inputs than the first; reports "linear.sweep-jump" (warning) where a motion is not recognized in the next.
records::LinearSweep make_sweep(const std::string& name, const std::vector<double>& values,
                                const std::function<records::LinearModel(double)>& linearize, const std::string& file,
                                Diagnostics& diagnostics, const Eigen::Vector3d& spin_axis = Eigen::Vector3d::Zero());

/// Reports "linear.sweep-jump" (warning) at each value at which a motion is not recognized.
void warn_jumps(const records::LinearSweep& sweep, const std::string& file, Diagnostics& diagnostics);

}  // namespace bough::analysis
