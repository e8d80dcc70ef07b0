#pragma once
/// \file A line plot as a self-contained SVG: titles, axes with round ticks, grid, legend, optional reference markers.
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::report {

/// Marks of points: a disc of the paper's colour, a cross (poles), a hollow ring (zeros), none (the range only).
enum class Mark { Dot, Cross, Ring, None };

/// Colours of curves; more curves have dashes.
constexpr std::size_t kNumColors = 7;

struct Curve {
  std::string label;
  Eigen::VectorXd x, y;
  bool markers_only = false;  ///< reference points rather than a line
  int style = -1;             ///< color and dashes of the curve of this number; -1: its own
  Mark mark = Mark::Dot;
  std::string unit{};  ///< of y; label_units writes it
};
/// Text next to a point of the picture.
struct Note {
  double x = 0, y = 0;
  std::string text;
};
struct Plot {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
  double y_min = 0, y_max = 0;  ///< equal: automatic; curves are clipped to the frame
  bool has_log_x = false;       ///< decades; values that are not positive are left out
  bool has_log_y = false;
  bool is_equal = false;          ///< one scale for both axes
  bool has_zero_x = false;        ///< a line at x = 0, the boundary of stability of poles
  double x_step = 0, y_step = 0;  ///< ticks at multiples of it, doubled for wide ranges: 45 for degrees; 0: round ones
  std::vector<Curve> guides;  ///< thin lines under the curves, labelled where they leave the frame; not in the range
  std::vector<Note> notes;
};
/// log10 of what is drawn in decades, ends of the axis too; NaN where there is none.
Plot take_logarithms(Plot plot);
/// Draws curves, axes, labels and legend as one SVG element; decades where the plot selects them.
std::string draw_svg(const Plot& plot);
/// One above the other, in one picture.
std::string draw_svg(const std::vector<Plot>& plots);

}  // namespace bough::report
