#include "formats/hdf5/inspect.hpp"

#include <algorithm>
#include <array>
#include <ctime>

#include <sys/stat.h>

#include "base/isolated.hpp"
#include "base/part_file.hpp"
#include "base/platform.hpp"

namespace bough::hdf5 {

namespace {

constexpr char kBetween = '\x1f', kEnd = '\x1e';
/// Limit of the processor time for a file: a constant, plus seconds per byte.
constexpr double kSeconds = 5, kSecondsPerByte = 1e-6;

/// Identity of a version of a file: device, inode, size and time of change.
using Stamp = std::array<long long, 5>;

Stamp make_stamp(const struct stat& state) {
  const auto changed = platform::get_change_time(state);
  return {static_cast<long long>(state.st_dev), static_cast<long long>(state.st_ino),
          static_cast<long long>(state.st_size), static_cast<long long>(changed.tv_sec),
          static_cast<long long>(changed.tv_nsec)};
}

/// File times have a resolution of some 10 ms: a file may change twice within it without a sign.
bool is_older(const struct stat& state, double seconds) {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  const auto changed = platform::get_change_time(state);
  return static_cast<double>(now.tv_sec - changed.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec - changed.tv_nsec) >
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

}  // namespace

std::string write_faults(const std::string& path) {
  std::string text;
  for (const auto& d : find_faults(path)) text += d.id + kBetween + d.what + kBetween + d.advice + kEnd;
  return text;
}

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
  const double size = static_cast<double>(state.st_size);
  const IsolatedResult look =
      run_isolated(path, write_faults, {kSeconds + kSecondsPerByte * size, 1e9 + 4 * size}, "HDF5");
  parse(path, look.output, found);
  if (!look.end.empty())
    found.error("hdf5.damaged", {path}, "the file is damaged: " + look.end, "copy or write it again");
  found.throw_if_errors();
  if (is_settled) g_inspected.add(stamp);
}

}  // namespace bough::hdf5
