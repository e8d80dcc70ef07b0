#pragma once
/// \file Signals that ask the program to end.
#include <array>
#include <csignal>

namespace bough::cli {

/// SIGINT, SIGTERM and SIGHUP end the program with exit code 3 and leave no half-written file; a signal that was
/// ignored from the start stays so. In force before main() begins. Commands that can stop in good order (run, batch)
/// replace these handlers (SignalScope).
void end_cleanly_on_signals();

/// Makes only the first of several ranks report a signal. Before main() the environment is not available yet.
void leave_word_to_first_rank();

/// Silences further messages after a failure: the signal by which mpirun ends the other ranks is not reported.
void end_in_silence();

/// For such commands: SIGINT, SIGTERM and SIGHUP call `handler` while the object exists; a hangup that was ignored
/// (nohup) stays ignored. A SIGINT after any of the three ends the process at once, exit code 3. One object at a time.
/// The destructor restores the handlers of a host program.
class SignalScope {
 public:
  explicit SignalScope(void (*handler)(int));
  ~SignalScope();
  SignalScope(const SignalScope&) = delete;
  SignalScope& operator=(const SignalScope&) = delete;

 private:
  static constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_{};
};

/// Standard streams that the caller has closed lead to where every write fails, and not into the next file opened.
void secure_streams();

}  // namespace bough::cli
