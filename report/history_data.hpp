#pragma once
/// \file The samples of a run for the script, within a budget of bytes.
#include <string>

#include "report/history_chapter.hpp"

namespace bough::report {

/// The page has the smallest and the largest of each 2 `first` samples of channels that people read (sensors, hinges,
/// energy ...) and of each 2 `others` samples of the others (bodies, reactions, mass), and 1 of `others` samples of
/// what the motion is drawn from; a stride of 1: all samples.
struct Strides {
  long first = 1, others = 1;
};
/// Selects the smallest strides for which all samples fit the budget of 4.1e6 characters; channels of bodies, reactions
/// and mass are thinned first.
Strides choose_strides(const History& history);

/// Writes time, channels, components and events as the JSON that the script of the page reads.
std::string make_data(const History& history, const Strides& strides);

}  // namespace bough::report
