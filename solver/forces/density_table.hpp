#pragma once
/// \file Density of an atmosphere by a table of altitudes.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace bough::solver {

/// ln ρ is linear in the altitude between the points, as in a standard atmosphere of layers of constant scale height;
/// outside the table the end intervals go on.
class DensityTable {
 public:
  DensityTable() = default;
  /// \param altitude  [L] ascending, two or more.  \param density  [M/L³] above zero.
  DensityTable(std::vector<double> altitude, const std::vector<double>& density) : altitude_(std::move(altitude)) {
    for (const double rho : density) log_density_.push_back(std::log(rho));
  }
  /// Returns true if there is no table.
  bool empty() const { return altitude_.empty(); }
  /// First and last altitude; zeros without points.
  std::pair<double, double> range() const {
    return empty() ? std::pair(0.0, 0.0) : std::pair(altitude_.front(), altitude_.back());
  }
  /// [M/L³] density at an altitude. No allocation.
  double calc(double altitude) const {
    const auto next = std::upper_bound(altitude_.begin() + 1, altitude_.end() - 1, altitude);
    const auto i = static_cast<std::size_t>(next - altitude_.begin());
    const double share = (altitude - altitude_[i - 1]) / (altitude_[i] - altitude_[i - 1]);
    return std::exp(log_density_[i - 1] + share * (log_density_[i] - log_density_[i - 1]));
  }

 private:
  std::vector<double> altitude_, log_density_;
};

}  // namespace bough::solver
