#pragma once
/// \file This program's own calls to the system that write files: refused past a place, or logged.
#include <cstdint>
#include <string>
#include <vector>

#include "base/non_copyable.hpp"

namespace bough::test {

/// While it lives, writes that end past `limit` bytes fail with ENOSPC.
class FullDisk : private NonCopyable {
 public:
  explicit FullDisk(long limit);
  ~FullDisk();
};

/// One call that changed, or synced, a file or folder.
struct DiskCall {
  enum Kind { Write, Truncate, Sync, Rename } kind = Write;
  std::string path;         ///< at the time of the call; of Rename the new name
  std::uint64_t place = 0;  ///< of Truncate the size
  std::string data;
};

/// While it lives, calls that concern files below `folder` are logged, and syncs do nothing else.
class DiskLog {
 public:
  explicit DiskLog(std::string folder);
  ~DiskLog();
  DiskLog(const DiskLog&) = delete;
  DiskLog& operator=(const DiskLog&) = delete;
  const std::vector<DiskCall>& calls() const { return calls_; }
  std::vector<DiskCall> calls_;
  std::string folder_;
};

}  // namespace bough::test
