#pragma once
/// \file Record of the call into a user library that is in progress, for handlers of signals and of exit().
#include <cstddef>
#include <limits>
#include <string>

#include "base/diagnostic.hpp"

namespace bough {

/// Marks, for its lifetime, a call of this thread into a function that the user supplies. Calls may nest.
class ForeignCall {
 public:
  /// All references must outlive the object.
  ///
  /// \param at        place in the system file.
  /// \param label     block that calls, as "controller 'law'".
  /// \param language  of the host that lends the function ("Python"); empty: a shared library.
  /// \param function  name in bough_controller.h, or a description.
  /// \param time      time of the simulation; NaN: none.
  ForeignCall(const SourceLocation& at, const std::string& label, const std::string& language, const char* function,
              double time = std::numeric_limits<double>::quiet_NaN());
  ~ForeignCall();
  ForeignCall(const ForeignCall&) = delete;
  ForeignCall& operator=(const ForeignCall&) = delete;

  /// Returns the line of the input file that names the user library.
  const SourceLocation& get_place() const { return at_; }
  /// Writes "controller 'law': bough_controller_outputs at t = 0.3", without a terminating zero; returns the length.
  /// Async-signal-safe.
  std::size_t describe(char* to, std::size_t size) const noexcept;
  /// Returns the same text as a string; allocates, hence not in a signal handler.
  std::string describe() const;

  /// Innermost call in progress on this thread, or, on a thread that marks none, on the thread of the first call of the
  /// process; null if there is none. Async-signal-safe.
  static const ForeignCall* find_current() noexcept;
  /// Calls `install` once, before the next call into user code: a program protects itself only when it has reason to.
  static void set_guard(void (*install)()) noexcept;

 private:
  const SourceLocation& at_;
  const std::string& label_;
  const std::string& language_;
  const char* function_;
  double time_;
  const ForeignCall* outer_;
};

}  // namespace bough
