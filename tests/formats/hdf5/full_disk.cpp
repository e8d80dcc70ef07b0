#include "tests/formats/hdf5/full_disk.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

std::atomic<long> write_limit{-1};
bough::test::DiskLog* disk_log = nullptr;

using Kind = bough::test::DiskCall::Kind;

bool add_call(Kind kind, const std::string& path, std::uint64_t place, const void* data, std::size_t size) {
  if (!disk_log || path.rfind(disk_log->folder_, 0) != 0) return false;
  disk_log->calls_.push_back({kind, path, place, std::string(static_cast<const char*>(data), size)});
  return true;
}

std::string get_path(int descriptor) {
  std::array<char, 4096> path{};
  const auto link = "/proc/self/fd/" + std::to_string(descriptor);
  const auto length = ::readlink(link.c_str(), path.data(), path.size());
  return length > 0 ? std::string(path.data(), static_cast<std::size_t>(length)) : std::string();
}

bool add_call(Kind kind, int descriptor, std::uint64_t place, const void* data, std::size_t size) {
  return disk_log && add_call(kind, get_path(descriptor), place, data, size);
}

}  // namespace

// The linker lets a shared library that calls these find them here first.
extern "C" int fallocate(int descriptor, int mode, off_t offset, off_t size) {
  const long limit = write_limit;
  if (limit >= 0 && offset + size > limit) {
    errno = ENOSPC;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_fallocate, descriptor, mode, offset, size));
}

extern "C" ssize_t pwrite(int descriptor, const void* data, size_t size, off64_t offset) {
  const long limit = write_limit;
  // Files in memory, which the HDF5 library makes, have no limit; a file on a tmpfs has.
  if (limit >= 0 && offset + static_cast<off64_t>(size) > limit && get_path(descriptor).rfind("/memfd:", 0) != 0) {
    errno = ENOSPC;
    return -1;
  }
  add_call(Kind::Write, descriptor, static_cast<std::uint64_t>(offset), data, size);
  return ::syscall(SYS_pwrite64, descriptor, data, size, offset);
}

extern "C" int ftruncate(int descriptor, off64_t size) noexcept {
  add_call(Kind::Truncate, descriptor, static_cast<std::uint64_t>(size), "", 0);
  return static_cast<int>(::syscall(SYS_ftruncate, descriptor, size));
}

extern "C" int fdatasync(int descriptor) {
  if (add_call(Kind::Sync, descriptor, 0, "", 0)) return 0;
  return static_cast<int>(::syscall(SYS_fdatasync, descriptor));
}

extern "C" int fsync(int descriptor) {
  if (add_call(Kind::Sync, descriptor, 0, "", 0)) return 0;
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  add_call(Kind::Rename, std::string(to), 0, "", 0);
  return static_cast<int>(::syscall(SYS_rename, from, to));
}

namespace bough::test {

FullDisk::FullDisk(long limit) { write_limit = limit; }
FullDisk::~FullDisk() { write_limit = -1; }

DiskLog::DiskLog(std::string folder) : folder_(std::move(folder)) { disk_log = this; }
DiskLog::~DiskLog() { disk_log = nullptr; }

}  // namespace bough::test
