#include "base/isolated.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <utility>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/platform.hpp"

// GCC has the macro, clang the feature; either keeps terabytes of address space.
#if defined(__has_feature)
#define BOUGH_HAS_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#else
#define BOUGH_HAS_ADDRESS_SANITIZER 0
#endif

namespace bough {

namespace {

/// Exit code of a child that ran out of memory.
constexpr int kNoMemory = 9;

void limit(decltype(RLIMIT_CPU) resource, double limit_value) {
  rlimit now{};
  getrlimit(resource, &now);
  now.rlim_cur = std::min(now.rlim_cur, static_cast<rlim_t>(limit_value));
  setrlimit(resource, &now);
}

void write_all(int descriptor, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto done = ::write(descriptor, text.data() + at, text.size() - at);
    if (done <= 0) return;
    at += static_cast<std::size_t>(done);
  }
}

[[noreturn]] void become_worker(const std::string& path, IsolatedTask task, const IsolationLimits& limits,
                                int descriptor) {
  // Signal handlers of the parent do not act here.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM, SIGHUP, SIGXCPU})
    std::signal(signal, SIG_DFL);
  if (const int null = ::open("/dev/null", O_WRONLY); null >= 0) {
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
  }
  platform::fill_fresh_memory();  // memory that was never set shows here, and not where it matters
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.seconds);
#if !defined(__SANITIZE_ADDRESS__) && !BOUGH_HAS_ADDRESS_SANITIZER
  limit(RLIMIT_AS, platform::get_address_space_bytes() + limits.bytes);
#endif
  try {
    write_all(descriptor, task(path));
  } catch (const std::bad_alloc&) {
    ::_exit(kNoMemory);
  } catch (const std::exception&) {
    ::_exit(1);
  }
  ::_exit(0);
}

/// Fault of the file that the exit status of the process shows; empty: none.
std::string describe_end(int status, const std::string& library) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFEXITED(status))
    return WEXITSTATUS(status) == kNoMemory ? "reading it takes more memory than a file of its size can need"
                                            : "reading it fails";
  if (WTERMSIG(status) == SIGXCPU) return "reading it comes to no end";
  return "the " + library + " library does not survive reading it (" + strsignal(WTERMSIG(status)) + ")";
}

IsolatedResult run_in_process(const std::string& path, IsolatedTask task, const IsolationLimits& limits,
                              const std::string& library) {
  int ends[2];
  pid_t child = -1;
  const bool has_pipe = platform::open_pipe(ends);
  if (has_pipe) child = ::fork();
  if (child == 0) become_worker(path, task, limits, ends[1]);
  if (child < 0) {
    // No process can be forked: the task is run in this one.
    if (has_pipe) {
      ::close(ends[0]);
      ::close(ends[1]);
    }
    return {task(path), {}};
  }
  ::close(ends[1]);
  IsolatedResult done;
  char buffer[4096];
  for (ssize_t n = 1; n != 0;) {
    n = ::read(ends[0], buffer, sizeof buffer);
    if (n > 0) done.output.append(buffer, static_cast<std::size_t>(n));
    if (n < 0 && errno != EINTR) break;
  }
  ::close(ends[0]);
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(child, &status, 0)) < 0 && errno == EINTR) continue;
  if (ended == child) done.end = describe_end(status, library);
  return done;
}

IsolatedRunner g_worker = run_in_process;

}  // namespace

IsolatedResult run_isolated(const std::string& path, IsolatedTask task, const IsolationLimits& limits,
                            const std::string& library) {
  return g_worker(path, task, limits, library);
}

IsolatedRunner set_isolated_runner(IsolatedRunner worker) { return std::exchange(g_worker, worker); }

}  // namespace bough
