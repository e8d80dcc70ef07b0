#pragma once
/// \file Functions that a deck gives as tables. Source: MSC Nastran Quick Reference Guide, TABLED1 to TABLED4, TABLEM1
/// to TABLEM4.
#include <utility>
#include <vector>

#include "formats/records/card_location.hpp"

namespace bough::records {

/// TABLED1 to TABLED4 of frequency or time, TABLEM1 to TABLEM4 of temperature.
struct FunctionTable {
  int id = 0, kind = 1;
  bool is_log_x = false, is_log_y = false;        ///< TABLED1
  bool is_flat = false;                           ///< TABLED1: beyond its ends it keeps its end values
  double x1 = 0, x2 = 1, x3 = 0, x4 = 0;          ///< TABLED2 (x1), TABLED3 (x1, x2), TABLED4
  std::vector<std::pair<double, double>> points;  ///< ascending x; equal ones are a jump
  std::vector<double> coefficients;               ///< TABLED4
  CardLocation at;
};

/// Where a function jumps it has two values: before, after, or the mean of them.
enum class Side { Before, After, Mean };

/// y(x). Beyond its ends the table goes on along the line of its last two points (TABLED4: it keeps its end value).
/// `reach`: points of the table within it of x count as x.
double evaluate(const FunctionTable& table, double x, Side side = Side::Mean, double reach = 0);

}  // namespace bough::records
