#pragma once
/// \file A disk that fills up: this program's own pwrite refuses to write past a place in any file on disk.
namespace bough::test {

/// While it lives, writes that end past `limit` bytes fail with ENOSPC.
class FullDisk {
 public:
  explicit FullDisk(long limit);
  ~FullDisk();
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
};

}  // namespace bough::test
