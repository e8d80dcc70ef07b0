#include "tests/fuzz/looker.hpp"

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <ucontext.h>
#include <unistd.h>

#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>

namespace bough::fuzz {

namespace {

/// Files that one process may look at: calls of the library that fail leave memory behind.
constexpr int kFiles = 2000;
/// Limits of computing, and then of waiting on a busy machine. Some damaged lists have no end; a file takes 1 to 5.
constexpr int kMilliseconds = 15, kMaxMilliseconds = 2000;

/// Exit code of a process that finds a fault of Bough's own code, not of the library that it watches.
constexpr int kOwnFault = 77;

struct Server {
  pid_t process = -1;
  int to = -1, from = -1, files = 0;
};

/// The server is this program, forked: it knows a task by its address.
struct Order {
  IsolatedTask task = nullptr;
  std::string path;
};

bool send(int descriptor, const std::string& text) {
  const auto size = static_cast<std::uint32_t>(text.size());
  std::string all(reinterpret_cast<const char*>(&size), sizeof size);
  all += text;
  return ::write(descriptor, all.data(), all.size()) == static_cast<ssize_t>(all.size());
}

bool receive(int descriptor, std::string& text) {
  std::uint32_t size = 0;
  if (::read(descriptor, &size, sizeof size) != sizeof size) return false;
  text.resize(size);
  for (std::size_t at = 0; at < size;) {
    const auto n = ::read(descriptor, text.data() + at, size - at);
    if (n <= 0) return false;
    at += static_cast<std::size_t>(n);
  }
  return true;
}

bool send(int descriptor, const Order& order) {
  return ::write(descriptor, &order.task, sizeof order.task) == sizeof order.task && send(descriptor, order.path);
}

bool receive(int descriptor, Order& order) {
  return ::read(descriptor, &order.task, sizeof order.task) == sizeof order.task && receive(descriptor, order.path);
}

/// Returns true for code of Bough: of this program, except the functions by which the sanitizers replace others. Those
/// are the only ones that the dynamic linker knows.
bool is_own(const void* code) {
  Dl_info here{}, there{};
  if (::dladdr(reinterpret_cast<const void*>(&is_own), &here) == 0 || ::dladdr(code, &there) == 0) return false;
  return here.dli_fbase == there.dli_fbase && !there.dli_sname;
}

/// The first frame that is no function of the sanitizers: "    #1 0x7f.. (module+0x..)".
void see_report(const char* report) {
  const char* frame = report;
  for (int i = 0; i < 8 && (frame = std::strstr(frame, " 0x")) != nullptr; ++i, ++frame) {
    if (frame == report || frame[-1] < '0' || frame[-1] > '9') continue;
    const auto* code = reinterpret_cast<const void*>(std::strtoull(frame + 1, nullptr, 16));
    Dl_info there{};
    if (::dladdr(code, &there) != 0 && there.dli_sname && std::strstr(there.dli_fname, "fuzz_readers")) continue;
    ::_exit(is_own(code) ? kOwnFault : 1);
  }
  ::_exit(1);
}

/// Returns true if code broke that Bough did not call through a function of the sanitizers: the library frees memory
/// that it never had, and their allocator, which is in this program, breaks.
bool broke_by_itself(const void* code) {
  if (!is_own(code)) return false;
  void* frames[32];
  const int count = ::backtrace(frames, 32);
  int i = 0;
  while (i < count && frames[i] != code) ++i;
  for (; i < count; ++i) {
    if (is_own(frames[i])) continue;
    // A library that calls back, or one of the functions that replace others: whoever called that.
    Dl_info there{};
    const bool is_replaced =
        ::dladdr(frames[i], &there) != 0 && there.dli_sname && std::strstr(there.dli_fname, "fuzz_readers");
    return !is_replaced || i + 1 >= count || is_own(frames[i + 1]);
  }
  return true;
}

void see_signal(int, siginfo_t*, void* context) {
  const auto code = static_cast<const ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP];
  ::_exit(broke_by_itself(reinterpret_cast<const void*>(code)) ? kOwnFault : 1);
}

/// Faults of the library are what the process is for; faults of Bough end it otherwise. Undefined behaviour is looked
/// for in Bough alone, and ends without a report of addresses.
void watch_for_own_faults() {
  __asan_set_error_report_callback(see_report);
  __sanitizer_set_death_callback([] { ::_exit(kOwnFault); });
  void* frame = nullptr;
  ::backtrace(&frame, 1);  // loads what it needs
  static char stack[1 << 18];
  stack_t other{};
  other.ss_sp = stack;
  other.ss_size = sizeof stack;
  ::sigaltstack(&other, nullptr);
  struct sigaction action {};
  action.sa_sigaction = see_signal;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) ::sigaction(signal, &action, nullptr);
}

[[noreturn]] void serve(int in, int out) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGABRT, SIGINT, SIGTERM, SIGPROF, SIGXCPU}) std::signal(signal, SIG_DFL);
  watch_for_own_faults();
  if (const int null = ::open("/dev/null", O_WRONLY); null >= 0) {
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
  }
  ::mallopt(M_PERTURB, 0x5A);
  Order order;
  while (receive(in, order)) {
    const itimerval most{{0, 0}, {0, 1000 * kMilliseconds}};
    ::setitimer(ITIMER_PROF, &most, nullptr);
    try {
      if (!send(out, order.task(order.path))) break;
    } catch (const std::exception&) {
      break;
    }
  }
  ::_exit(1);
}

/// Returns true if Bough's own code was at fault.
bool stop(Server& server) {
  if (server.process < 0) return false;
  ::close(server.to);
  ::close(server.from);
  ::kill(server.process, SIGKILL);
  int status = 0;
  ::waitpid(server.process, &status, 0);
  server = {};
  return WIFEXITED(status) && WEXITSTATUS(status) == kOwnFault;
}

void start(Server& server) {
  int to[2], from[2];
  if (::pipe2(to, O_CLOEXEC) != 0 || ::pipe2(from, O_CLOEXEC) != 0) std::abort();
  const pid_t child = ::fork();
  if (child < 0) std::abort();
  if (child == 0) {
    ::close(to[1]);
    ::close(from[0]);
    serve(to[0], from[1]);
  }
  ::close(to[0]);
  ::close(from[1]);
  server = {child, to[1], from[0], 0};
}

}  // namespace

IsolatedResult work_by_one_process(const std::string& path, IsolatedTask task, const IsolationLimits&,
                                   const std::string&) {
  static Server server;
  std::signal(SIGPIPE, SIG_IGN);
  if (server.files >= kFiles) stop(server);
  // Where the library broke the memory of the process at an earlier file, anybody's code may stumble over it: what
  // counts is what a new process does.
  for (const bool is_new : {server.process < 0, true}) {
    if (server.process < 0) start(server);
    ++server.files;
    IsolatedResult done;
    pollfd wait{server.from, POLLIN, 0};
    if (send(server.to, Order{task, path}) && ::poll(&wait, 1, kMaxMilliseconds) > 0 &&
        receive(server.from, done.output))
      return done;
    if (!stop(server)) break;
    if (is_new) {
      std::fputs("what looks at the file broke by itself\n", stderr);
      std::abort();
    }
  }
  return {{}, "the process that looked at it ended"};
}

}  // namespace bough::fuzz
