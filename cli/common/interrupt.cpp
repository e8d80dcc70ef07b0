#include "cli/common/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "analysis/common/ranks.hpp"
#include "base/foreign_call.hpp"
#include "base/part_file.hpp"
#include "cli/common/console.hpp"
#include "cli/common/user_code.hpp"

namespace bough::cli {

namespace {

/// Ranks of one launch end together: the first one says so, unless it has said why.
volatile std::sig_atomic_t says_it = 1;

/// Calls nothing that a handler may not.
void end_on_signal(int signal) {
  remove_parts();
  const char* text = signal == SIGINT ? "error: interrupted; nothing was written [cli.interrupted]\n"
                                      : "error: told to end; nothing was written [cli.interrupted]\n";
  if (says_it) (void)!::write(STDERR_FILENO, text, std::strlen(text));
  leave_at_once(kComputationFailed);
}

/// Handler of the active SignalScope.
void (*volatile g_handler)(int) = nullptr;
volatile std::sig_atomic_t g_is_told = 0;

/// Time in s that a user library has to return after the first signal.
constexpr unsigned kPatience = 5;

/// Ends a command that has not reached a check for signals; the message names the user library in which it is.
[[noreturn]] void end_where_it_is(const char* why) {
  remove_parts();
  char text[1200];
  std::size_t size = 0;
  const auto add = [&](const char* more) {
    std::memcpy(text + size, more, std::strlen(more));
    size += std::strlen(more);
  };
  add("error: ");
  add(why);
  if (const auto* call = ForeignCall::find_current()) {
    add(" in ");
    size += call->describe(text + size, 1000);
  }
  add("; what was not flushed is lost [cli.interrupted]\n");
  if (says_it) (void)!::write(STDERR_FILENO, text, size);
  leave_at_once(kComputationFailed);
}

/// Ends the program after one signal if no second one follows (a time limit, a service manager).
void on_patience_over(int) {
  if (ForeignCall::find_current()) end_where_it_is("told to end 5 s ago and still");
}

void on_signal_of_scope(int signal) {
  if (signal == SIGINT && g_is_told) end_where_it_is("interrupted a second time");
  g_is_told = 1;
  std::signal(SIGALRM, on_patience_over);
  ::alarm(kPatience);
  if (const auto handler = g_handler) handler(signal);
}

}  // namespace

SignalScope::SignalScope(void (*handler)(int)) {
  g_is_told = 0;
  g_handler = handler;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], nullptr, &before_[i]);
    if (kSignals[i] == SIGHUP && before_[i].sa_handler == SIG_IGN) continue;  // nohup
    std::signal(kSignals[i], on_signal_of_scope);
  }
}

SignalScope::~SignalScope() {
  ::alarm(0);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    // The program is ending: a further signal must not report that nothing was written.
    if (before_[i].sa_handler == end_on_signal) continue;
    ::sigaction(kSignals[i], &before_[i], nullptr);
  }
}

void end_cleanly_on_signals() {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit of file sizes is an error of the write, which has a message
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler == SIG_IGN) continue;
    struct sigaction own {};
    own.sa_handler = end_on_signal;
    ::sigaction(signal, &own, nullptr);
  }
}

void leave_word_to_first_rank() {
  if (analysis::get_launch_rank() != 0) says_it = 0;
}

void end_in_silence() { says_it = 0; }

void secure_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) (void)!::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

}  // namespace bough::cli
