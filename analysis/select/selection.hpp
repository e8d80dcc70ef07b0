#pragma once
/// \file Retained modes and the cost of the truncation.
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/select/loss.hpp"

namespace bough::analysis {

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

/// Modes of one body, or of several, in the order of their ranking.
struct RankedModes {
  std::string file;  ///< of the body or the first system, for messages
  std::vector<statespace::ModeTraits> traits;
  std::vector<std::string> names;  ///< words of --keep: "3", of a system "boom:3"
};

/// Chooses the modes to keep and measures the loss without the others in every configuration. Warnings:
/// select.always-kept, select.most-is-lost. Throws InputError "select.unknown-mode".
Selection choose_and_measure(const SelectRequest& request, const RankedModes& modes,
                             const std::vector<Weighing>& weighings, Events& events, Diagnostics& diagnostics);

/// Adds select.third-order (warning) if the body, of which modes are dropped, has third order.
void warn_of_lost_order(const records::FlexBody& body, const std::string& file, Diagnostics& diagnostics);

/// Throws InputError "cli.bad-value" for numbers out of their range.
void demand_select_numbers(const SelectRequest& request);

/// Files that the selection reads, those of the body and of the systems first. Throws InputError "cli.no-file",
/// "cli.wrong-file".
std::vector<std::string> list_select_inputs(const SelectRequest& request);

/// Ranks the modes of `body`, which `request.body` names, chooses those to keep and computes the loss without the
/// others. Warnings: those of choose_and_measure(). `diagnostics`: messages from reading the body.
/// \throws InputError "select.no-signals", "select.unknown-mode" and those of the weighings.
Selection select_modes(const SelectRequest& request, const records::FlexBody& body, Events& events,
                       Diagnostics diagnostics = {});

/// The body with the modes kept; `files` are added to its source. Throws InputError "select.nothing-kept".
records::FlexBody keep_selected(const SelectRequest& request, const records::FlexBody& body, const Selection& selection,
                                const std::vector<std::string>& files);

}  // namespace bough::analysis
