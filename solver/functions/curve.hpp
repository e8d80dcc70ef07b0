#pragma once
/// \file A tabulated y(x) with its integral and slope: forces over a length, a deflection or a speed.
#include <memory>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/state/dual.hpp"

namespace bough::solver {

class Curve {
 public:
  struct Value {
    double y = 0, slope = 0;
    double integral = 0;  ///< of y from x = 0
  };
  /// From a [[function]] of type table, linear or cubic as it says; outside it the end values hold. Reports
  /// "system.not-a-table" for another type and what make_time_function reports, and returns nullptr then.
  static std::unique_ptr<const Curve> make(const records::FunctionRecord& record, const SourceLocation& where,
                                           const std::string& user, Diagnostics& diagnostics);
  /// Value, slope and integral from 0 at x.
  Value calc(double x) const;
  /// y with its one-sided slope along x.
  struct DualValue {
    Dual y;
  };
  /// y and its derivative along x.dx, one-sided at a point of the table.
  DualValue calc(Dual x) const { return {Dual(calc(x.x).y, calc_slope(x.x, x.dx < 0) * x.dx)}; }

 private:
  double calc_slope(double x, bool from_below) const;
  Value calc_from_start(double x) const;

  std::vector<double> x_, y_, slope_left_, slope_right_;  ///< of each interval at its two ends
  std::vector<double> integral_;                          ///< from the first point
  double at_zero_ = 0;
};

}  // namespace bough::solver
