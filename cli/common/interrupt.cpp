#include "cli/common/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "base/part_file.hpp"
#include "cli/common/console.hpp"

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
  ::_exit(kComputationFailed);
}

}  // namespace

void take_signals(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    if (signal == SIGHUP && ::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN) continue;  // nohup
    std::signal(signal, handler);
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
  if (Console::get_launch_rank() != 0) says_it = 0;
}

void end_in_silence() { says_it = 0; }

void secure_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) (void)!::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

}  // namespace bough::cli
