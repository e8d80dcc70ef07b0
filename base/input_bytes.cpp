#include "base/input_bytes.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "base/file_roles.hpp"

namespace bough {
namespace {

/// Beyond this many bytes in all, what is kept is dropped: a server lives long.
constexpr std::size_t kMaxKept = std::size_t{1} << 31;

/// Limit of a text that is read whole for its first bytes: a larger one may be a list of results that is no input.
constexpr std::size_t kMaxText = std::size_t{1} << 29;

/// Device, number, size and time of a file: they change when it is written or replaced.
using FileState = std::tuple<dev_t, ino_t, off_t, std::filesystem::file_time_type>;

bool find_state(const std::string& path, FileState& state) {
  struct stat s {};
  if (::stat(path.c_str(), &s) != 0 || !S_ISREG(s.st_mode)) return false;
  std::error_code failed;
  state = {s.st_dev, s.st_ino, s.st_size, std::filesystem::last_write_time(path, failed)};
  return !failed;
}

struct Input {
  FileState state;
  std::shared_ptr<const std::string> bytes;
};
using Inputs = std::map<std::string, Input>;  ///< by make_key
std::string make_key(const std::string& path) { return std::filesystem::path(path).lexically_normal().string(); }

/// The inputs of each FileRoles, the innermost last.
struct Store {
  std::mutex mutex;
  std::vector<Inputs> levels;
  std::size_t num_kept_bytes = 0, num_opened = 0;
};
Store& get_store() {
  static Store store;
  return store;
}

/// With the lock of the store.
std::shared_ptr<const std::string> find_kept(const Store& store, const std::string& key, const FileState& state) {
  for (auto level = store.levels.rbegin(); level != store.levels.rend(); ++level)
    if (const auto found = level->find(key); found != level->end() && found->second.state == state)
      return found->second.bytes;
  return nullptr;
}

/// Appends up to `count` bytes of a stream.
void append_bytes(std::istream& in, std::size_t count, std::string& bytes) {
  const auto before = bytes.size();
  bytes.resize(before + count);
  in.read(bytes.data() + before, static_cast<std::streamsize>(count));
  bytes.resize(before + static_cast<std::size_t>(in.gcount()));  // less if the file is cut while it is read
}

/// The kept bytes of a file, or those that are read now.
/// \param num_needed  of a binary file, and if nothing is kept, the rest may be left out.
std::shared_ptr<const std::string> read_kept(const std::string& path, const FileState& state, std::size_t num_needed) {
  constexpr std::size_t kHead = 4096;
  auto& store = get_store();
  const std::lock_guard lock(store.mutex);
  const auto key = make_key(path);
  if (auto kept = find_kept(store, key, state)) return kept;
  std::ifstream in(path, std::ios::binary);
  ++store.num_opened;
  if (!in) return nullptr;
  const auto size = static_cast<std::size_t>(std::get<2>(state));
  auto bytes = std::make_shared<std::string>();
  append_bytes(in, std::min(size, kHead), *bytes);
  const bool is_text = size <= kMaxText && bytes->find('\0') == std::string::npos;
  if (num_needed <= bytes->size() && (!is_text || store.levels.empty())) return bytes;
  append_bytes(in, size - std::min(size, bytes->size()), *bytes);
  if (in.bad()) return nullptr;
  if (store.levels.empty()) return bytes;
  store.num_kept_bytes += bytes->size();
  if (store.num_kept_bytes > kMaxKept) {
    for (auto& level : store.levels) level.clear();
    store.num_kept_bytes = bytes->size();
  }
  store.levels.back()[key] = {state, bytes};
  return bytes;
}

}  // namespace

std::shared_ptr<const std::string> find_input(const std::string& path) {
  FileState state;
  if (!find_state(path, state)) return nullptr;
  auto& store = get_store();
  const std::lock_guard lock(store.mutex);
  return find_kept(store, make_key(path), state);
}

std::shared_ptr<const std::string> read_input(const std::string& path) {
  FileState state;
  if (!find_state(path, state)) return nullptr;
  note_input(path);
  return read_kept(path, state, std::numeric_limits<std::size_t>::max());
}

std::string read_input_head(const std::string& path, std::size_t size) {
  FileState state;
  const auto bytes = find_state(path, state) ? read_kept(path, state, size) : nullptr;
  return bytes ? bytes->substr(0, size) : std::string();
}

std::size_t count_opened_inputs() {
  auto& store = get_store();
  const std::lock_guard lock(store.mutex);
  return store.num_opened;
}

void detail::begin_keeping_inputs() {
  auto& store = get_store();
  const std::lock_guard lock(store.mutex);
  store.levels.emplace_back();
}

void detail::end_keeping_inputs() {
  auto& store = get_store();
  const std::lock_guard lock(store.mutex);
  for (const auto& [path, input] : store.levels.back())
    store.num_kept_bytes -= std::min(store.num_kept_bytes, input.bytes->size());
  store.levels.pop_back();
}

}  // namespace bough
