#include "formats/hdf5/detail/growing_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/diagnostic.hpp"
#include "base/platform.hpp"

namespace bough::hdf5 {

void GrowingFile::close() {
  part_.reset();
  if (old_ >= 0) ::close(std::exchange(old_, -1));
}

bool GrowingFile::is_at_target(int descriptor) const {
  struct stat named {
  }, opened{};
  return ::lstat(target_.c_str(), &named) == 0 && ::fstat(descriptor, &opened) == 0 && named.st_dev == opened.st_dev &&
         named.st_ino == opened.st_ino;
}

void GrowingFile::lock() {
  std::error_code failed;
  target_ = find_target(path_, failed);
  // A user library may change the working folder while the run writes.
  if (!failed) target_ = std::filesystem::absolute(target_, failed).string();
  errno = failed.value();
  check(!failed, "the file cannot be opened for writing");
  // A file that is not there is reported by the reader.
  while (std::filesystem::exists(target_, failed)) {
    old_ = ::open(target_.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (old_ < 0 && errno == ENOENT) continue;
    check(old_ >= 0, "the file cannot be opened for writing");
    if (lock_file(old_) == LockState::Busy)
      throw InputError("hdf5.busy", {path_}, "another process writes this file",
                       "wait until it ends, or choose another");
    if (is_at_target(old_)) return;
    ::close(std::exchange(old_, -1));
  }
}

void GrowingFile::create() {
  if (old_ < 0) lock();
  if (old_ >= 0) {
    struct stat old {};
    errno = ::fstat(old_, &old) == 0 && !S_ISREG(old.st_mode) ? EEXIST : 0;
    check(errno == 0, "the file cannot be created");
  }
  part_.emplace(target_);
  errno = part_->error().value();
  check(!part_->error(), "the file cannot be created");
}

void GrowingFile::publish() {
  if (old_ >= 0) {
    const bool is_there = is_at_target(old_);
    ::close(std::exchange(old_, -1));
    errno = 0;
    check(is_there, "the file has been removed or replaced since the run began");
  }
  const bool is_done = part_->publish();
  errno = part_->error().value();
  check(is_done, "the file cannot be written");
  is_published_ = true;
}

void GrowingFile::write(std::uint64_t place, const char* data, std::size_t size) {
  const auto end = place + size;
  while (size > 0) {
    errno = 0;
    const auto done = ::pwrite(part_->get_descriptor(), data, size, static_cast<off_t>(place));
    if (done < 0 && errno == EINTR) continue;
    check(done > 0, "the file cannot be written");
    data += done;
    place += static_cast<std::uint64_t>(done);
    size -= static_cast<std::size_t>(done);
  }
  size_ = std::max(size_, end);
}

void GrowingFile::extend(std::uint64_t size) {
  const char zero = 0;
  if (size > size_) write(size - 1, &zero, 1);
}

bool GrowingFile::try_extend(std::uint64_t size) {
  const char zero = 0;
  if (size > size_ && ::pwrite(part_->get_descriptor(), &zero, 1, static_cast<off_t>(size - 1)) != 1) return false;
  size_ = std::max(size_, size);
  return true;
}

void GrowingFile::truncate(std::uint64_t size) {
  errno = 0;
  check(::ftruncate(part_->get_descriptor(), static_cast<off_t>(size)) == 0, "the file cannot be written");
  size_ = size;
}

void GrowingFile::sync() {
  errno = 0;
  check(platform::sync_data(part_->get_descriptor()) || errno == EINVAL, "the file cannot be written");
}

void GrowingFile::check_name() {
  if (!is_published_ || is_at_target(part_->get_descriptor())) return;
  errno = 0;
  struct stat named {};
  check(false, ::lstat(target_.c_str(), &named) == 0 ? "another file has taken its place since the run began"
                                                     : "the file has been removed or renamed since the run began");
}

void GrowingFile::check(bool ok, const std::string& what) {
  if (ok) return;
  failed_ = true;
  const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : std::string();
  throw ComputationError("hdf5.write", {path_}, what + reason, "check the folder, its permissions and the free space");
}

}  // namespace bough::hdf5
