#pragma once
/// \file A line plot as text of a terminal: dots of Braille, two by four in each character.
#include <string>

#include "report/svg_plot.hpp"

namespace bough::report {

/// No line is wider than `width` characters (40 at least); `height` lines are the frame. Curves differ by colour where
/// has_color.
std::string draw_text(const Plot& plot, int width, int height, bool has_color);

}  // namespace bough::report
