#pragma once
/// \file Round ticks of a plot axis.
#include <string>
#include <vector>

namespace bough::report {

struct Axis {
  double min = 0, max = 1;
  std::vector<double> ticks;        ///< inside [min, max], ascending
  std::vector<std::string> labels;  ///< of each tick, divided by 10^exponent
  int exponent = 0;                 ///< a multiple of 3; 0 for numbers of everyday size
};

/// Ticks at 1, 2, 2.5 or 5 times a power of ten, about `num_ticks` of them. When `widen`, the ends move out to a little
/// more than the data; otherwise they stay. A range of no width is opened. With `base_step` ticks are at its multiples:
/// 45 degrees, 90, 180 and so on.
Axis make_axis(double min, double max, int num_ticks, bool widen, double base_step = 0);
/// Axis of log10 of the values: ticks at powers of ten, and at 2 and 5 times them for few decades.
Axis make_log_axis(double min, double max);

}  // namespace bough::report
