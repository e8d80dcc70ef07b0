#include "cli/common/event_list.hpp"

#include <fmt/format.h>

namespace bough::cli {

namespace {

/// Lines that a reader still looks through, before and after the gap.
constexpr std::size_t kMaxFirst = 20, kMaxLast = 5;

}  // namespace

std::string format_events(const std::vector<records::EventRecord>& events) {
  if (events.empty()) return {};
  std::string text = "events:\n";
  const bool is_long = events.size() > kMaxFirst + kMaxLast;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (is_long && i == kMaxFirst) {
      i = events.size() - kMaxLast;
      text += fmt::format("  ... {} more, all of them with bough export --to csv --channel events\n", i - kMaxFirst);
    }
    text += fmt::format("  t = {:<12.9g} {}\n", events[i].time, events[i].what);
  }
  return text;
}

}  // namespace bough::cli
