#pragma once
/// \file Retained modes and the cost of the truncation.
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
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

/// Files that the selection reads, those of the body and of the systems first. Throws InputError "cli.no-file",
/// "cli.wrong-file".
std::vector<std::string> list_select_inputs(const SelectRequest& request);

/// Ranks the modes of `body`, which `request.body` names, chooses those to keep and computes the loss without the
/// others. Warnings: select.always-kept, select.most-is-lost. `diagnostics`: messages from reading the body.
/// \throws InputError "select.no-signals", "select.unknown-mode" and those of the weighings.
Selection select_modes(const SelectRequest& request, const records::FlexBody& body, Events& events,
                       Diagnostics diagnostics = {});

/// The body with the modes kept; `files` are added to its source. Throws InputError "select.nothing-kept".
records::FlexBody keep_selected(const SelectRequest& request, const records::FlexBody& body, const Selection& selection,
                                const std::vector<std::string>& files);

}  // namespace bough::analysis
