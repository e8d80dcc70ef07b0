#pragma once
/// \file The samples of a run for the script, within a budget of bytes.
#include <string>

#include "report/history_chapter.hpp"

namespace bough::report {

/// One of several samples is on the page, of channels that people read (sensors, hinges, energy ...) and of the others
/// (bodies, reactions, mass): 1 where all fit.
struct Strides {
  long first = 1, others = 1;
};
/// Selects the smallest strides for which all samples fit the budget of 4.1e6 characters; channels of bodies, reactions
/// and mass are thinned first.
Strides choose_strides(const History& history);

/// Writes time, channels, components and events as the JSON that the script of the page reads.
std::string make_data(const History& history, const Strides& strides);

}  // namespace bough::report
