#pragma once
/// \file Events of a run, as text for a reader.
#include <string>
#include <vector>

#include "formats/records/results.hpp"

namespace bough::cli {

/// One line per event, time first; of many the first and the last, and how many are between. Empty for none.
std::string format_events(const std::vector<records::EventRecord>& events);

}  // namespace bough::cli
