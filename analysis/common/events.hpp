#pragma once
/// \file Messages and progress of a request while it is worked on.
#include <string>

#include "base/diagnostic.hpp"

namespace bough::analysis {

/// Receives what a command reports besides its records. Every function is called on the thread of the request.
class Events {
 public:
  virtual ~Events() = default;
  /// A note or a warning of a request that succeeds. Messages of one that fails are in its Failure.
  virtual void add_message(const Diagnostic& /*message*/) {}
  /// The present stage of the work; empty: the stages so far are over.
  virtual void show_progress(const std::string& /*stage*/) {}
};

/// Passes every message to Events::add_message().
void add_messages(const Diagnostics& diagnostics, Events& events);

}  // namespace bough::analysis
