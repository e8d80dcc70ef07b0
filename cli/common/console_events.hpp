#pragma once
/// \file Events of a request on the console.
#include "analysis/common/events.hpp"
#include "cli/common/console.hpp"

namespace bough::cli {

/// Shows progress at once and keeps the messages: they are printed together, shortened.
class ConsoleEvents final : public analysis::Events {
 public:
  explicit ConsoleEvents(Console& console) : console_(console) {}
  void add_message(const Diagnostic& message) override { messages_.add(message); }
  void show_progress(const std::string& stage) override { console_.show_stage(stage); }
  /// Messages so far, not printed yet.
  const Diagnostics& get_messages() const { return messages_; }

 private:
  Console& console_;
  Diagnostics messages_;
};

}  // namespace bough::cli
