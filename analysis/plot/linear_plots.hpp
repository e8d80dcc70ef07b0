#pragma once
/// \file Pictures of linear models and of their sweeps.
#include <string>
#include <vector>

#include "report/svg_plot.hpp"

namespace bough::analysis {

/// "bode", "nichols", "sigma", "poles" of linear models, "campbell", "locus" of sweeps.
const std::vector<std::string>& list_plot_kinds();

struct LinearPlotChoice {
  std::string kind;
  std::vector<std::string> inputs, outputs;  ///< empty: all
  int per_rev =
      0;  ///< "campbell": lines of 1 to per_rev times the parameter, a rate in rad/T; 0: if it is found to be one
};

/// Reads the files, which go into one picture of several stacked plots. Throws InputError "cli.plot-kind" where a file
/// is of another format, "linear.unknown-input", "linear.unknown-output".
std::vector<report::Plot> make_linear_plots(const std::vector<std::string>& files, const LinearPlotChoice& choice);

}  // namespace bough::analysis
