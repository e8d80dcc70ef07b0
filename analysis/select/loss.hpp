#pragma once
/// \file Loss of a model by the truncation of modes: mean square, largest and steady gain of the difference.
#include <string>
#include <vector>

#include "analysis/select/weighing.hpp"

namespace bough::analysis {

/// Cost of the truncation in one configuration.
struct Loss {
  std::string name;
  double total = 0;           ///< V
  double other = 0;           ///< of it by the rest of the system
  double lost = 0;            ///< mean square of the difference of the outputs, to V
  double peak = 0;            ///< peak gain of the full model, of its stable part
  double error = 0;           ///< largest gain of the difference: its H-infinity norm
  double error_hz = 0;        ///< where
  double balanced_bound = 0;  ///< 2 Σ of the Hankel singular values that a balanced model of as many states loses
  double steady_error = 0;    ///< of the gain at frequency 0 of the stable part, relative
  Eigen::VectorXd frequency_hz, before, after, difference;  ///< largest singular values
};

/// Computes the loss of a configuration with these modes only.
Loss weigh_loss(const Weighing& weighing, const std::vector<int>& kept);

/// Mean square of the difference of the outputs, to V: the largest of the configurations.
double calc_lost(const std::vector<Weighing>& weighings, const std::vector<int>& kept);

}  // namespace bough::analysis
