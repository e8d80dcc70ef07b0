#pragma once
/// \file Curves of results against time, responses, campaigns and linear models.
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/plot/history_plots.hpp"
#include "analysis/plot/linear_plots.hpp"

namespace bough::analysis {

struct PlotRequest {
  std::vector<std::string> files;    ///< HDF5 files of one kind
  std::vector<std::string> sensors;  ///< channels, columns of a campaign, items of a response of a deck
  std::vector<std::string> labels;   ///< of the curves, in their order
  std::vector<std::string> points;   ///< CSV files with reference points
  std::string title, x_label, y_label;
  double y_min = 0, y_max = 0;  ///< if has_limits
  bool has_limits = false;
  bool has_csv = false;  ///< the numbers of the curves too
  LinearPlotChoice linear;
  CurveChoice curves;
};

struct PlotAnswer {
  std::vector<report::Plot> plots;  ///< one above the other
  std::string csv;                  ///< "curve,x,y": every curve as it is drawn, all digits
  std::string name;                 ///< of the picture, without folder and extension
};

/// Throws InputError "cli.nothing-to-plot", "cli.bad-range", "cli.plot-option", "cli.bad-points", and what
/// make_linear_plots(), make_history_plot(), make_campaign_plot() and make_response_plots() throw.
PlotAnswer make_plots(const PlotRequest& request, Events& events);

/// Writes .svg as it is, .png and .pdf by rsvg-convert. Throws ComputationError "cli.write", "cli.no-converter".
void write_picture(const std::string& path, const std::string& svg);

}  // namespace bough::analysis
