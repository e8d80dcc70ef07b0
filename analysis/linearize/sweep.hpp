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
/// Parses several of different parameters; throws InputError("cli.bad-sweep") where a name comes twice or the grid has
/// more than 10,000 points.
std::vector<SweepRange> parse_sweeps(const std::vector<std::string>& texts);

/// One model for each point of the grid of all ranges (one range: for each value), their poles followed. Neighbours of
/// a grid are those of a path through it that turns back at the end of each row. Throws
/// ComputationError("linear.sweep-states") where a model has other states or inputs than the first; reports
/// "linear.sweep-jump" (warning) where a motion is not recognized in the next.
records::LinearSweep make_sweep(const std::vector<SweepRange>& ranges,
                                const std::function<records::LinearModel(const std::vector<double>&)>& linearize,
                                const std::string& file, Diagnostics& diagnostics,
                                const Eigen::Vector3d& spin_axis = Eigen::Vector3d::Zero());

/// Reports "linear.sweep-jump" (warning) at each value at which a motion is not recognized.
void warn_jumps(const records::LinearSweep& sweep, const std::string& file, Diagnostics& diagnostics);

}  // namespace bough::analysis
