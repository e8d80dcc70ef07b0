#pragma once
/// \file Linear models along a parameter of the system file, or along its run.
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/linear_sweep.hpp"

namespace bough::cli {

/// "name=from:to:n" or, evenly on a logarithmic scale, "name=from:to:n:log"; n >= 2 values. Throws
/// InputError("cli.bad-sweep").
struct SweepRange {
  std::string name;
  std::vector<double> values;
};
SweepRange parse_sweep(const std::string& text);

/// One model a value, their poles followed. Throws ComputationError("linear.sweep-states") where a model has other
/// states or inputs than the first; reports "linear.sweep-jump" (warning) where a motion is not recognized in the next.
records::LinearSweep make_sweep(const std::string& name, const std::vector<double>& values,
                                const std::function<records::LinearModel(double)>& linearize, const std::string& file,
                                Diagnostics& diagnostics);

nlohmann::json make_json(const records::LinearSweep& sweep);
std::string format_sweep(const records::LinearSweep& sweep);
/// A row a value: the parameter, then real, imaginary part, frequency and damping of each branch.
std::string make_sweep_csv(const records::LinearSweep& sweep);

}  // namespace bough::cli
