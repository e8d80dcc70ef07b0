#include "fe/linear/memory_need.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <sys/resource.h>

#include "base/diagnostic.hpp"
#include "base/platform.hpp"

namespace bough::linear {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

double calc_free_of_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
  return static_cast<double>(limit.rlim_cur) - platform::get_address_space_bytes();
}

}  // namespace

double calc_free_memory() { return std::max(0.0, std::min(platform::calc_free_bytes(), calc_free_of_address_space())); }

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

void release_freed_memory() { platform::release_freed_memory(); }

}  // namespace bough::linear
