#include "base/part_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "base/file_roles.hpp"
#include "base/platform.hpp"

namespace bough {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMark = ".bough-part-";
/// Longest name of a file; the end of a longer part's name gives way.
constexpr std::size_t kMaxLetters = 255;
/// Offsets far after the end of any file: locked while a file grows under its own name, and while a part is open. A
/// complete file is never seen locked, though its part is until it is closed.
constexpr off_t kGrowingByte = off_t{1} << 62, kPartByte = kGrowingByte + 1;

/// Names of the parts that are open: a signal handler can reach nothing but static storage.
std::array<std::atomic<char*>, 64>& get_parts() {
  static std::array<std::atomic<char*>, 64> parts{};
  return parts;
}

int add_part(const std::string& name) {
  char* copy = ::strdup(name.c_str());
  auto& parts = get_parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    char* none = nullptr;
    if (parts[i].compare_exchange_strong(none, copy)) return static_cast<int>(i);
  }
  std::free(copy);
  return -1;
}

void drop_part(int slot) {
  if (slot >= 0) std::free(get_parts()[static_cast<std::size_t>(slot)].exchange(nullptr));
}

LockState lock_byte(int descriptor, off_t byte) {
  if (platform::lock_byte(descriptor, byte)) return LockState::Held;
  return errno == EAGAIN || errno == EACCES ? LockState::Busy : LockState::Unsupported;
}

/// Parts whose process is gone hold no lock. Only files of this user, with only digits after the mark.
void remove_stale(const fs::path& folder, const std::string& stem) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const auto name = entry.path().filename().string();
    if (name.size() <= stem.size() || name.compare(0, stem.size(), stem) != 0) continue;
    if (name.find_first_not_of("0123456789", stem.size()) != std::string::npos) continue;
    const int found = ::open(entry.path().c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (found < 0) continue;
    struct stat state {};
    const bool is_own = ::fstat(found, &state) == 0 && S_ISREG(state.st_mode) && state.st_uid == ::geteuid();
    if (is_own && lock_byte(found, kPartByte) == LockState::Held) ::unlink(entry.path().c_str());
    ::close(found);
  }
}

/// Returns true if the name still refers to the open file.
bool is_same_file(const std::string& name, int descriptor) {
  struct stat a {
  }, b{};
  return ::lstat(name.c_str(), &a) == 0 && ::fstat(descriptor, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

}  // namespace

std::string find_target(const std::string& path, std::error_code& failed) {
  failed.clear();
  struct stat state {};
  // The system's own rules about links come first: it follows none that another user laid in a shared folder.
  if (::stat(path.c_str(), &state) != 0 && (errno == EACCES || errno == ELOOP)) {
    failed = std::error_code(errno, std::generic_category());
    return path;
  }
  fs::path target = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, error)); ++links) {
    const fs::path next = fs::read_symlink(target, error);
    if (error || links > 40) {
      failed = error ? error : std::make_error_code(std::errc::too_many_symbolic_link_levels);
      return path;
    }
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target.string();
}

PartFile::PartFile(const std::string& path) {
  note_output(path);
  target_ = find_target(path, error_);
  if (error_) return;
  // Absolute, since the working directory may have changed when it is removed.
  target_ = fs::absolute(target_, error_).string();
  if (error_) return;
  const fs::path target(target_);
  const auto process = std::to_string(::getpid());
  const auto stem = target.filename().string().substr(0, kMaxLetters - std::strlen(kMark) - 12) + kMark;
  remove_stale(target.parent_path(), stem);
  name_ = (target.parent_path() / (stem + process)).string();
  for (int attempt = 0; attempt < 3; ++attempt) {
    slot_ = add_part(name_);
    descriptor_ = ::open(name_.c_str(), O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR | O_CLOEXEC, 0666);
    error_ = std::error_code(descriptor_ < 0 ? errno : 0, std::generic_category());
    if (!error_ && lock_byte(descriptor_, kPartByte) != LockState::Busy && is_same_file(name_, descriptor_)) return;
    // Another part of this process, or of one with its number on another machine.
    const bool is_taken = !error_ || error_ == std::errc::file_exists;
    if (!error_) error_ = std::make_error_code(std::errc::file_exists);
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
    drop_part(slot_);
    slot_ = -1;
    if (!is_taken) return;
    name_ = (target.parent_path() / (stem + process + std::to_string(attempt))).string();
  }
}

PartFile::~PartFile() { abandon(); }

bool PartFile::fail() {
  error_ = std::error_code(errno != 0 ? errno : EIO, std::generic_category());
  return false;
}

bool PartFile::write(const char* data, std::size_t size) {
  if (error_) return false;
  while (size > 0) {
    errno = 0;
    const auto done = ::write(descriptor_, data, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return fail();
    data += done;
    size -= static_cast<std::size_t>(done);
  }
  return true;
}

void PartFile::start_sync() {
  if (!error_) platform::start_sync(descriptor_);
}

bool PartFile::commit() {
  if (!replace_target()) return false;
  ::close(descriptor_);
  descriptor_ = -1;
  return true;
}

bool PartFile::publish() {
  if (error_) return false;
  lock_file(descriptor_);
  return replace_target();
}

bool PartFile::replace_target() {
  if (error_) return false;
  // A run writes the file of that name; after the replacement it would write a file without a name.
  if (is_file_locked(target_)) {
    errno = EBUSY;
    return fail();
  }
  errno = 0;
  struct stat old {};
  if (::stat(target_.c_str(), &old) == 0 && ::fchmod(descriptor_, old.st_mode & 07777) != 0) return fail();
  errno = 0;
  if (::fsync(descriptor_) != 0 && errno != EINVAL) return fail();
  if (::rename(name_.c_str(), target_.c_str()) != 0) return fail();
  is_published_ = true;
  drop_part(slot_);
  slot_ = -1;
  return sync_folder(target_) || fail();
}

void PartFile::abandon() {
  if (descriptor_ < 0) return;
  if (!is_published_) ::unlink(name_.c_str());
  drop_part(slot_);
  slot_ = -1;
  ::close(descriptor_);
  descriptor_ = -1;
}

bool sync_folder(const std::string& path) {
  const auto folder = fs::path(path).parent_path();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // A folder may be writable without being readable.
  if (descriptor < 0) return true;
  const bool is_synced = ::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS || errno == ENOTSUP;
  const int cause = errno;
  ::close(descriptor);
  errno = cause;
  return is_synced;
}

void remove_parts() noexcept {
  for (auto& part : get_parts())
    if (const char* name = part.load()) ::unlink(name);
}

LockState lock_file(int descriptor) { return lock_byte(descriptor, kGrowingByte); }

bool is_file_locked(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_locked = platform::is_byte_locked(descriptor, kGrowingByte);
  ::close(descriptor);
  return is_locked;
}

}  // namespace bough
