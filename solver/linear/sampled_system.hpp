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

/// Jacobian, a column for each entry of [δ; δu; δz; m]. Entries that are round-off are 0, and their errors too.
struct Jacobian {
  MatrixXd value, error;
  MatrixXd kink;               ///< half of the difference between the one-sided derivatives
  std::vector<LawKink> kinks;  ///< functions that make it
};

/// Error bound of derivatives.
struct Uncertainty {
  double relative = 0;         ///< the largest error or kink, relative to the scale of its row
  std::vector<LawKink> kinks;  ///< functions with two slopes

  /// Rows with scale 0 are left out.
  void add(const Jacobian& jacobian, const VectorXd& scale);
  /// Joins another bound; the larger of both is kept.
  void add(const Uncertainty& other);
};

/// The largest entry of each row.
VectorXd calc_row_scales(const MatrixXd& value);

/// First displacement of a difference by dof i: its step, of a translation calc_far_step at least. After an evaluation
/// of the plant.
double choose_displacement(const Plant& plant, int i);

/// A sum of length 1 of [δ; δu; δz; m] is changed by h; the step that suits column j.
OperatingPoint displace_by_column(const Plant& plant, const OperatingPoint& point, int j, double h);
double choose_step(const Plant& plant, const OperatingPoint& point, int j);

/// ∂f/∂[δ; δu; δz; m], columns first to last (without it), with steps of `factor` times what suits them.
Jacobian differentiate_columns(Plant& plant, const OperatingPoint& point,
                               const std::function<VectorXd(const OperatingPoint&)>& f, int first, int last,
                               double factor = 1);
/// The derivative by one number, a column.
Jacobian differentiate_column(Plant& plant, const std::function<VectorXd(double)>& f, double step);

class SampledSystem {
 public:
  /// Sets the operating point; a controller without a sample yet gets its first one, so that differences are those of
  /// later samples.
  SampledSystem(Plant& plant, const OperatingPoint& point);
  /// Number of rows of x.
  int num_x() const { return 2 * n_ + nz_; }
  /// Number of rows of m.
  int num_m() const { return static_cast<int>(plant_.sampled_rows().size()); }
  /// num_x + num_m.
  std::vector<std::string> list_names() const;
  /// Sets the time of the operating point.
  void set_time(double t) { point_.t = t; }
  /// The operating point; its memory may be that after the first sample.
  const OperatingPoint& point() const { return point_; }

  /// E: num_x x num_m, of ẋ = A x + E m.
  MatrixXd calc_held();
  /// [S_x S_m]: num_m x (num_x + num_m), of m⁺ = S_x x + S_m m by the samples due at the time set.
  MatrixXd calc_sample();
  /// ∂f/∂[x; m], columns first to last (without it).
  MatrixXd differentiate_all(const std::function<VectorXd(const OperatingPoint&)>& f, int first, int last);
  /// ∂f by one number.
  VectorXd differentiate_one(const std::function<VectorXd(double)>& f, double step);

  /// Error bound of all derivatives so far.
  const Uncertainty& uncertainty() const { return uncertainty_; }

 private:
  Uncertainty uncertainty_;
  Plant& plant_;
  OperatingPoint point_;
  int n_, nz_;
};

}  // namespace bough::solver
