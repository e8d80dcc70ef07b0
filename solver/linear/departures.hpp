#pragma once
/// \file Small departures of a system with samples: x = [δ; δu; δz], and m, the memory of what is sampled.
#include <functional>
#include <vector>

#include "solver/linear/plant.hpp"
#include "solver/signals/graph.hpp"

namespace bough::solver {

/// The shortest time that is a whole multiple of each, to 1e-9 of it, and of less than 1000 of any; 0: there is none.
double find_common_period(const std::vector<double>& cycles);

/// Instants of samples in [from, from + period), each once, counted from `from`.
std::vector<double> list_instants(const std::vector<SampleTimes>& samples, double from, double period);

class Departures {
 public:
  Departures(Plant& plant, const OperatingPoint& point);
  int num_x() const { return 2 * n_ + nz_; }
  int num_m() const { return static_cast<int>(plant_.sampled_rows().size()); }
  /// num_x + num_m.
  std::vector<std::string> list_names() const;
  void set_time(double t) { point_.t = t; }
  const OperatingPoint& point() const { return point_; }

  /// E: num_x x num_m, of ẋ = A x + E m.
  MatrixXd calc_held() const;
  /// [S_x S_m]: num_m x (num_x + num_m), of m⁺ = S_x x + S_m m by the samples due at the time set.
  MatrixXd calc_sample() const;
  /// ∂f/∂[x; m], columns first to last (without it); what is below its own error is 0.
  MatrixXd differentiate_all(const std::function<VectorXd(const OperatingPoint&)>& f, int first, int last) const;

 private:
  OperatingPoint move(int j, double h) const;
  double step(int j) const;
  Plant& plant_;
  OperatingPoint point_;
  int n_, nz_;
};

}  // namespace bough::solver
