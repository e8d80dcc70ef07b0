#include "analysis/common/events.hpp"

namespace bough::analysis {

void add_messages(const Diagnostics& diagnostics, Events& events) {
  for (const auto& item : diagnostics.items()) events.add_message(item);
}

}  // namespace bough::analysis
