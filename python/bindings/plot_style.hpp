#pragma once
/// \file Choices of a plot in Python beyond its curves, checked as the command line checks them.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "analysis/plot/plot.hpp"
#include "python/bindings/requests.hpp"
#include "report/shock_spectrum.hpp"

namespace bough::python {

/// Throws ValueError for a word that is none of the choices.
inline void demand_word(const std::string& name, const std::string& word, const Strings& choices) {
  if (std::find(choices.begin(), choices.end(), word) != choices.end()) return;
  std::string list;
  for (const auto& choice : choices) list += (list.empty() ? "" : ", ") + choice;
  throw py::value_error(name + " is one of " + list + ", not " + word);
}

/// Choices of a plot that the command line has in addition.
struct PlotStyle {
  Strings inputs, outputs;  ///< with kind
  int per_rev = 0;
  std::vector<double> window;
  int segment = 256;
  std::string srs_part = "maximax";
  std::vector<double> srs_range;
  double q = 10;
  bool log_x = false, log_y = false;
  std::optional<double> y_min, y_max;
};

/// Throws ValueError as the command line refuses words and numbers.
inline void set_style(const PlotStyle& style, analysis::PlotRequest& request) {
  demand_word("srs_part", style.srs_part, report::list_shock_parts());
  if (request.linear.kind.empty() && !(style.inputs.empty() && style.outputs.empty() && style.per_rev == 0))
    throw py::value_error("inputs, outputs and per_rev go with kind");
  if (style.per_rev < 0 || style.per_rev > 100) throw py::value_error("per_rev is 1 to 100, or 0: chosen");
  if (!style.window.empty() && style.window.size() != 2) throw py::value_error("window is (from, until)");
  if (!style.srs_range.empty() && style.srs_range.size() != 2 && style.srs_range.size() != 3)
    throw py::value_error("srs_range is (from, to) or (from, to, frequencies per octave)");
  if (style.segment < 2) throw py::value_error("segment is a number of samples above 1");
  if (!(style.q > 0.5) || !std::isfinite(style.q)) throw py::value_error("q is above 0.5");
  if (style.y_min.has_value() != style.y_max.has_value()) throw py::value_error("y_min and y_max go together");
  request.linear.inputs = style.inputs;
  request.linear.outputs = style.outputs;
  request.linear.per_rev = style.per_rev;
  request.curves.window = style.window;
  request.curves.segment = style.segment;
  request.curves.srs_part = style.srs_part;
  request.curves.srs_range = style.srs_range;
  request.curves.quality = style.q;
  request.curves.log_x = style.log_x;
  request.curves.log_y = style.log_y;
  request.has_limits = style.y_min.has_value();
  request.y_min = style.y_min.value_or(0);
  request.y_max = style.y_max.value_or(0);
}

}  // namespace bough::python
