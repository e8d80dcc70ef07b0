#pragma once
/// \file Events of a run, as text for a reader and as CSV.
#include <string>
#include <vector>

#include "formats/records/results.hpp"

namespace bough::cli {

/// One line per event, time first; of many the first and the last, and how many are between. Empty for none.
std::string format_events(const std::vector<records::EventRecord>& events);
/// time, what, source; texts in quotes (RFC 4180).
std::string make_events_csv(const std::vector<records::EventRecord>& events);

}  // namespace bough::cli
