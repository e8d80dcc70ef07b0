#pragma once
/// \file Labels of axes: the quantity with its unit in brackets.
#include <string>

#include "report/svg_plot.hpp"

namespace bough::report {

/// "tip:y [m]"; without a unit the name alone.
std::string make_label(const std::string& name, const std::string& unit);
/// "frequency [Hz]" for a time in seconds or without a label, "frequency [kHz]" for ms, "frequency [1/min]".
std::string label_frequency(const std::string& time_unit);
/// Unit of a spectral density over the frequencies of label_frequency(): "m^2/Hz", "(m/s)^2/kHz", "N^2 min"; empty if
/// the unit of the curve is.
std::string make_density_unit(const std::string& unit, const std::string& time_unit);

/// Writes the powers of units for a picture: "kg m^2/s" becomes "kg m²/s". Files and tables of text keep "^".
std::string write_powers(std::string label);

/// Puts the unit of the curves on the y axis; if curves have several units, into their labels.
void label_units(Plot& plot);

}  // namespace bough::report
