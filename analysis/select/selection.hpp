#pragma once
/// \file Retained modes and the cost of the truncation.
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

struct Selection {
  statespace::ModeRanking ranking;  ///< of the worst configuration for each mode
  std::vector<statespace::Choice> choices;
  std::vector<int> kept;
  double dropped = 0;        ///< part of V
  double lost = 0;           ///< the worst of the configurations
  double static_error = -1;  ///< of a body alone
  Eigen::VectorXd modal_hankel;
  std::vector<Loss> losses;
};

/// The modes by the rules; of a rule by tolerance as many as every configuration allows.
Selection select_modes(const SelectRequest& o, const records::FlexBody& body, const std::vector<Weighing>& weighings);
/// Fills losses.
void weigh_losses(const std::vector<Weighing>& weighings, Selection& selection);

}  // namespace bough::analysis
