#include "full_disk.hpp"

#include <atomic>
#include <cerrno>

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {
std::atomic<long> write_limit{-1};
}

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
  const bool is_in_memory = ::fcntl(descriptor, F_GET_SEALS) >= 0;
  if (limit >= 0 && !is_in_memory && offset + static_cast<off64_t>(size) > limit) {
    errno = ENOSPC;
    return -1;
  }
  return ::syscall(SYS_pwrite64, descriptor, data, size, offset);
}

namespace bough::test {

FullDisk::FullDisk(long limit) { write_limit = limit; }
FullDisk::~FullDisk() { write_limit = -1; }

}  // namespace bough::test
