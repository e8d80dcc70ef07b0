#include "formats/hdf5/detail/inspect.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fstream>
#include <new>
#include <utility>

#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/part_file.hpp"

// GCC has the macro, clang the feature; either keeps terabytes of address space.
#if defined(__has_feature)
#define BOUGH_HAS_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#else
#define BOUGH_HAS_ADDRESS_SANITIZER 0
#endif

namespace bough::hdf5 {

namespace {

constexpr char kBetween = '\x1f', kEnd = '\x1e';
/// Seconds of computing that a file may take, and those it may take more for each of its bytes.
constexpr double kSeconds = 5, kSecondsPerByte = 1e-7;

/// Exit code of a child that ran out of memory.
constexpr int kNoMemory = 9;

/// Which state of a file was looked at.
using Stamp = std::array<long long, 5>;

Stamp make_stamp(const struct stat& state) {
  return {static_cast<long long>(state.st_dev), static_cast<long long>(state.st_ino),
          static_cast<long long>(state.st_size), static_cast<long long>(state.st_mtim.tv_sec),
          static_cast<long long>(state.st_mtim.tv_nsec)};
}

/// Clocks of files tick some hundred times a second: a file may change twice within a tick and look the same.
bool is_older(const struct stat& state, double seconds) {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<double>(now.tv_sec - state.st_mtim.tv_sec) +
             1e-9 * static_cast<double>(now.tv_nsec - state.st_mtim.tv_nsec) >
         seconds;
}

/// The states of files last found good, by whatever name; few, so that a worker of many cases does not grow.
class Inspected {
 public:
  bool has(const Stamp& stamp) const { return std::find(stamps_.begin(), stamps_.end(), stamp) != stamps_.end(); }
  void add(const Stamp& stamp) { stamps_[next_++ % stamps_.size()] = stamp; }

 private:
  std::array<Stamp, 256> stamps_{};
  std::size_t next_ = 0;
};
Inspected g_inspected;

void limit(decltype(RLIMIT_CPU) resource, double most) {
  rlimit now{};
  getrlimit(resource, &now);
  now.rlim_cur = std::min(now.rlim_cur, static_cast<rlim_t>(most));
  setrlimit(resource, &now);
}

[[maybe_unused]] double get_memory() {
  std::ifstream in("/proc/self/statm");
  double pages = 0;
  in >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

void write_all(int descriptor, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto done = ::write(descriptor, text.data() + at, text.size() - at);
    if (done <= 0) return;
    at += static_cast<std::size_t>(done);
  }
}

[[noreturn]] void become_reader(const std::string& path, double size, int descriptor) {
  // Nobody handles a crash here, or cleans up for the parent.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM, SIGHUP, SIGXCPU})
    std::signal(signal, SIG_DFL);
  if (const int null = ::open("/dev/null", O_WRONLY); null >= 0) {
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
  }
  ::mallopt(M_PERTURB, 0x5A);  // memory that was never set shows here, and not where it matters
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, kSeconds + kSecondsPerByte * size);
#if !defined(__SANITIZE_ADDRESS__) && !BOUGH_HAS_ADDRESS_SANITIZER
  limit(RLIMIT_AS, get_memory() + 1e9 + 4 * size);
#endif
  try {
    write_all(descriptor, write_faults(path));
  } catch (const std::bad_alloc&) {
    ::_exit(kNoMemory);
  } catch (const std::exception&) {
    ::_exit(1);
  }
  ::_exit(0);
}

void parse(const std::string& path, const std::string& text, Diagnostics& found) {
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find(kEnd, at), text.size());
    const auto first = text.find(kBetween, at), second = text.find(kBetween, first + 1);
    if (second < end)
      found.error(text.substr(at, first - at), {path}, text.substr(first + 1, second - first - 1),
                  text.substr(second + 1, end - second - 1));
    at = end + 1;
  }
}

/// What the way in which the reader ended says of the file; empty: nothing.
std::string describe_end(int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFEXITED(status))
    return WEXITSTATUS(status) == kNoMemory ? "reading it takes more memory than a file of its size can need"
                                            : "reading it fails";
  if (WTERMSIG(status) == SIGXCPU) return "reading it comes to no end";
  return std::string("the HDF5 library does not survive reading it (") + strsignal(WTERMSIG(status)) + ")";
}

Look look_in_a_process(const std::string& path, double size) {
  int ends[2];
  pid_t child = -1;
  const bool has_pipe = ::pipe2(ends, O_CLOEXEC) == 0;
  if (has_pipe) child = ::fork();
  if (child == 0) become_reader(path, size, ends[1]);
  if (child < 0) {
    // No process to be had: better looked at here than not.
    if (has_pipe) {
      ::close(ends[0]);
      ::close(ends[1]);
    }
    return {write_faults(path), {}};
  }
  ::close(ends[1]);
  Look look;
  char buffer[4096];
  for (ssize_t n = 1; n != 0;) {
    n = ::read(ends[0], buffer, sizeof buffer);
    if (n > 0) look.faults.append(buffer, static_cast<std::size_t>(n));
    if (n < 0 && errno != EINTR) break;
  }
  ::close(ends[0]);
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(child, &status, 0)) < 0 && errno == EINTR) continue;
  if (ended == child) look.end = describe_end(status);
  return look;
}

Looker g_looker = look_in_a_process;

}  // namespace

std::string write_faults(const std::string& path) {
  std::string text;
  for (const auto& d : find_faults(path)) text += d.id + kBetween + d.what + kBetween + d.advice + kEnd;
  return text;
}

Looker set_looker(Looker looker) { return std::exchange(g_looker, looker); }

void trust_file(const std::string& path) {
  struct stat state {};
  if (::stat(path.c_str(), &state) == 0 && S_ISREG(state.st_mode)) g_inspected.add(make_stamp(state));
}

void inspect_file(const std::string& path) {
  struct stat state {};
  if (::stat(path.c_str(), &state) != 0) return;
  if (is_file_locked(path)) return;  // a run of Bough writes it now: between two looks it is another file
  const auto stamp = make_stamp(state);
  const bool is_settled = is_older(state, 0.1);
  if (g_inspected.has(stamp)) return;

  Diagnostics found;
  const Look look = g_looker(path, static_cast<double>(state.st_size));
  parse(path, look.faults, found);
  if (!look.end.empty())
    found.error("hdf5.damaged", {path}, "the file is damaged: " + look.end, "copy or write it again");
  found.throw_if_errors();
  if (is_settled) g_inspected.add(stamp);
}

}  // namespace bough::hdf5
