#include "cli/common/user_code.hpp"

#include <unistd.h>

#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "base/foreign_call.hpp"
#include "base/part_file.hpp"
#include "base/platform.hpp"
#include "cli/common/console.hpp"

namespace bough::cli {

namespace {

struct CrashSignal {
  int number;
  const char* text;
};
constexpr CrashSignal kCrashes[] = {{SIGSEGV, "SIGSEGV, invalid memory access"},
                                    {SIGBUS, "SIGBUS, memory that does not exist"},
                                    {SIGFPE, "SIGFPE, integer division"},
                                    {SIGILL, "SIGILL, invalid instruction"},
                                    {SIGABRT, "SIGABRT, abort()"},
                                    {SIGTRAP, "SIGTRAP, trap"},
                                    {SIGSYS, "SIGSYS, forbidden system call"}};
constexpr std::size_t kNumCrashes = sizeof kCrashes / sizeof kCrashes[0];

struct sigaction g_before[kNumCrashes];
pid_t g_process = 0;
/// A stack that has overflowed runs no handler.
alignas(16) char g_stack[1 << 16];

/// The call in progress of this process; null in a child that a library has forked.
const ForeignCall* find_own_call() noexcept { return ::getpid() == g_process ? ForeignCall::find_current() : nullptr; }

/// One line on stderr in the format of every message, then the end.
[[noreturn]] void report_and_leave(const ForeignCall& call, const char* what, const char* detail, const char* advice,
                                   const char* id) noexcept {
  remove_parts();
  char text[2000];
  std::size_t size = 0;
  const auto add = [&](const char* more, std::size_t length) {
    if (length > sizeof text - 1 - size) length = sizeof text - 1 - size;
    std::memcpy(text + size, more, length);
    size += length;
  };
  const auto add_text = [&](const char* more) { add(more, std::strlen(more)); };
  const auto& place = call.get_place();
  if (!place.file.empty()) {
    add(place.file.data(), place.file.size());
    char number[16];
    if (place.line > 0) {
      add_text(":");
      add(number, static_cast<std::size_t>(std::to_chars(number, number + sizeof number, place.line).ptr - number));
    }
    add_text(": ");
  }
  add_text("error: ");
  char described[1000];
  add(described, call.describe(described, sizeof described));
  for (const char* more : {what, detail, "; ", advice, " [", id, "]"}) add_text(more);
  text[size++] = '\n';
  (void)!::write(STDERR_FILENO, text, size);
  leave_at_once(kComputationFailed);
}

void on_crash(int signal, siginfo_t* info, void*) {
  std::size_t i = 0;
  while (i + 1 < kNumCrashes && kCrashes[i].number != signal) ++i;
  if (const auto* call = find_own_call())
    report_and_leave(*call, " crashed: ", kCrashes[i].text, "correct the library; a debugger shows the place",
                     "control.library-crashed");
  // Not caused by a library: restore the previous handler. A fault recurs; a sent signal must be raised again.
  ::sigaction(signal, &g_before[i], nullptr);
  if (info == nullptr || info->si_code <= 0) ::raise(signal);
}

void install() {
  g_process = ::getpid();
  stack_t stack{};
  if (::sigaltstack(nullptr, &stack) == 0 && (stack.ss_flags & SS_DISABLE) != 0) {
    stack = {};
    stack.ss_sp = g_stack;
    stack.ss_size = sizeof g_stack;
    ::sigaltstack(&stack, nullptr);
  }
  for (std::size_t i = 0; i < kNumCrashes; ++i) {
    struct sigaction own {};
    own.sa_sigaction = on_crash;
    own.sa_flags = SA_SIGINFO | SA_ONSTACK;
    ::sigaction(kCrashes[i].number, &own, &g_before[i]);
  }
  std::atexit([] { end_if_in_user_code("exit()"); });
  std::at_quick_exit([] { end_if_in_user_code("quick_exit()"); });
}

}  // namespace

void guard_user_code() { ForeignCall::set_guard(install); }

void end_if_in_user_code(const char* call) noexcept {
  if (const auto* current = find_own_call())
    report_and_leave(*current, " ended the program by ", call, "return a number other than 0 for a failure",
                     "control.library-exited");
}

void leave_at_once(int code) noexcept { platform::end_process(code); }

}  // namespace bough::cli
