#include "fe/linear/memory_need.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

#include "base/diagnostic.hpp"

namespace bough::linear {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// The number after `key` in a file of such lines; nothing if there is none ("max" of a control group).
double read_number(const std::string& path, const std::string& key, double otherwise) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    double number = 0;
    if (!key.empty() && (!(words >> word) || word != key)) continue;
    return words >> number ? number : otherwise;
  }
  return otherwise;
}

double calc_free_of_system() {
  const double available = read_number("/proc/meminfo", "MemAvailable:", kUnknown);
  return 1024 * (available + read_number("/proc/meminfo", "SwapFree:", 0));
}

double calc_free_of_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
  const double used = read_number("/proc/self/statm", "", 0) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  return static_cast<double>(limit.rlim_cur) - used;
}

double calc_free_of_groups() {
  std::ifstream file("/proc/self/cgroup");
  std::string group;
  for (std::string line; std::getline(file, line);)
    if (line.rfind("0::/", 0) == 0) group = line.substr(3);
  double free = kUnknown;
  while (!group.empty()) {
    const std::string folder = "/sys/fs/cgroup" + (group == "/" ? "" : group) + "/";
    const double group_limit = read_number(folder + "memory.max", "", kUnknown);
    const double used =
        read_number(folder + "memory.current", "", 0) - read_number(folder + "memory.stat", "inactive_file", 0);
    free = std::min(free, group_limit - used);
    group = group == "/" ? "" : group.substr(0, std::max<std::size_t>(group.rfind('/'), 1));
  }
  return free;
}

}  // namespace

double calc_free_memory() {
  return std::max(0.0, std::min({calc_free_of_system(), calc_free_of_address_space(), calc_free_of_groups()}));
}

std::string format_bytes(double bytes) {
  constexpr double kStep = 1000;
  const char* const units[] = {"kB", "MB", "GB", "TB"};
  double number = bytes / kStep;
  int unit = 0;
  for (; unit < 3 && number >= kStep; ++unit) number /= kStep;
  std::ostringstream text;
  text.precision(number < 10 ? 2 : 3);
  text << (number < 10 ? number : std::round(number)) << ' ' << units[unit];
  return text.str();
}

double calc_factor_bytes(double num_entries) { return 1.15 * sizeof(double) * num_entries; }

void require_memory(double num_equations, double num_entries, double free_bytes) {
  const double needed = calc_factor_bytes(num_entries);
  if (!(needed > free_bytes)) return;
  throw ComputationError("fe.out-of-memory", {},
                         "the factor of " + std::to_string(static_cast<long long>(num_equations)) +
                             " equations needs about " + format_bytes(needed) + ", " + format_bytes(free_bytes) +
                             " of memory are free",
                         "use a coarser mesh, or run on more processes of a larger machine (mpirun -n 2 bough ...)");
}

void release_freed_memory() {
#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 33)
  // The system takes pages back and gives them out again, cleared, for longer than a small model takes.
  constexpr std::size_t kWorthIt = std::size_t{16} << 20;
  if (::mallinfo2().fordblks < kWorthIt) return;
#endif
  malloc_trim(0);
#endif
}

}  // namespace bough::linear
