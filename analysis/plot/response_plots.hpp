#pragma once
/// \file Pictures of what `frequency` and `transient` wrote.
#include <string>
#include <vector>

#include "report/svg_plot.hpp"

namespace bough::analysis {

/// Returns true if the first of the files is one of `frequency` or `transient`.
bool is_deck_response(const std::vector<std::string>& files);

/// Curves by name, quantity:grid:component, or all of quantity:grid. Over frequency magnitude (dB, or its own
/// units in decades) above phase, over time one plot. A window, if given, cuts either. Throws InputError
/// "cli.unknown-channel", "cli.bad-range" for a window without samples.
std::vector<report::Plot> make_response_plots(const std::vector<std::string>& files,
                                              const std::vector<std::string>& names,
                                              const std::vector<double>& window = {}, bool has_decades = false);

/// Spectral densities of random responses, of decks and of linear models (`response --psd`), on logarithmic axes, with
/// the RMS in the legend. Throws InputError "cli.no-random" for a file without a random response, else as
/// make_response_plots.
std::vector<report::Plot> make_density_plots(const std::vector<std::string>& files,
                                             const std::vector<std::string>& names, const std::vector<double>& window);

}  // namespace bough::analysis
