#pragma once
/// \file Pictures of what `frequency` and `transient` wrote.
#include <string>
#include <vector>

#include "formats/report/svg_plot.hpp"

namespace bough::cli {

/// Whether the first of the files is one of these.
bool is_deck_response(const std::vector<std::string>& files);

/// Curves by name, quantity:grid:component, or all of quantity:grid. Over frequency magnitude (dB) above phase, over
/// time one plot. Throws InputError "cli.unknown-channel".
std::vector<report::Plot> make_response_plots(const std::vector<std::string>& files,
                                              const std::vector<std::string>& names);

}  // namespace bough::cli
