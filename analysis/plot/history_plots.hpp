#pragma once
/// \file Pictures of results, of campaigns, and what is done to curves over time before they are drawn.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "report/svg_plot.hpp"

namespace bough::analysis {

struct CurveChoice {
  std::string x;               ///< channel or column instead of the time
  std::vector<double> window;  ///< from and until; empty: all
  bool psd = false, spectrum = false, difference = false, subplots = false, log_x = false, log_y = false;
  int segment = 256;  ///< psd: samples
  std::string srs;    ///< kind of a shock response spectrum; empty: none
  std::string srs_part = "maximax";
  std::vector<double> srs_range;  ///< from, to [1/T] and frequencies per octave; empty: chosen from the samples
  double quality = 10;
};

/// Channels of results files against time, or against the channel `x`. Throws InputError "cli.unknown-channel",
/// "cli.one-channel" when `x` names several. With `difference` each further file minus the first one, at its samples
/// that lie in the time of both; where their times differ, linear between samples, with the note "cli.interpolated".
report::Plot make_history_plot(const std::vector<std::string>& files, const std::vector<std::string>& sensors,
                               const CurveChoice& choice, Diagnostics& diagnostics);

/// Columns of outcomes.h5: a point a case against the column `x`; without it the values in order against the percentage
/// of the cases that lie below. Cases without a value are left out: note "cli.cases-left-out".
report::Plot make_campaign_plot(const std::vector<std::string>& files, const std::vector<std::string>& names,
                                const CurveChoice& choice, Diagnostics& diagnostics);

/// Adds cli.shock-input (warning): a shock response spectrum of a curve that is no acceleration. \param is  "of
/// dimensions L".
void warn_of_shock_input(const std::string& file, const std::string& curve, const std::string& is,
                         Diagnostics& diagnostics);

/// Takes spectra, shock response spectra too, sets logarithmic axes, and with `subplots` gives each curve a separate
/// plot. Throws InputError "cli.uneven-samples" where a spectrum is asked of samples that are not evenly spaced; the
/// note "cli.short-segment" where there are fewer of them than a segment wants.
std::vector<report::Plot> shape_plots(std::vector<report::Plot> plots, const CurveChoice& choice, bool is_over_time,
                                      Diagnostics& diagnostics);

}  // namespace bough::analysis
