#pragma once
/// \file The samples of a run for the script, within a budget of bytes.
#include <string>

#include "report/history_chapter.hpp"

namespace bough::report {

/// Every so many samples are on the page, of channels that people read (sensors, hinges, energy ...) and of the others
/// (bodies, reactions, mass): 1 where all fit.
struct Strides {
  long first = 1, others = 1;
};
Strides choose_strides(const History& history);

std::string make_data(const History& history, const Strides& strides);

}  // namespace bough::report
