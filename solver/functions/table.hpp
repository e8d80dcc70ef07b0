#pragma once
/// \file Tabulated functions of time. Outside the table the end values hold.
#include <vector>

#include "solver/functions/function.hpp"

namespace bough::solver {

/// A point wherever y has changed by a quarter of its range since the last one, and the point before the first change
/// of each such stretch. x ascending, as many y; y that are not finite are passed over.
std::vector<double> find_mesh_times(const std::vector<double>& x, const std::vector<double>& y);

/// Straight lines between the points. x ascending strictly, as many y; checked by make_time_function.
class LinearTable final : public TimeFunction {
 public:
  LinearTable(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {}
  Value calc(double t) const override;
  /// Every point: the slope jumps there.
  std::vector<double> jump_times() const override { return x_; }
  /// Points that stand off the line of their neighbours by more than 1 % of the table's range, and the ends.
  std::vector<double> force_jump_times() const override;
  std::vector<double> mesh_times() const override;

 private:
  std::vector<double> x_, y_;
};

/// Cubic spline with not-a-knot ends (de Boor, "A practical guide to splines", ch. IV): C² inside, exact for cubics, no
/// invented end slopes. Three points give the parabola through them, two a line.
class CubicTable final : public TimeFunction {
 public:
  CubicTable(std::vector<double> x, std::vector<double> y);
  Value calc(double t) const override;
  /// The two ends: the slope jumps there. Inside only the third derivative does, which a restart would not help.
  std::vector<double> jump_times() const override { return {x_.front(), x_.back()}; }
  std::vector<double> mesh_times() const override;

 private:
  std::vector<double> x_, y_;
  std::vector<double> second_;  ///< f'' at the points
};

}  // namespace bough::solver
