#pragma once
/// \file A file that one process writes piece by piece while others read it.
#include <cstdint>
#include <optional>
#include <string>

#include "base/part_file.hpp"

namespace bough::hdf5 {

/// Bytes at places, syncs, and the name. Every function throws ComputationError "hdf5.write", with the system's reason.
class GrowingFile {
 public:
  explicit GrowingFile(std::string path) : path_(std::move(path)) {}
  ~GrowingFile() { close(); }
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// Keeps other processes from writing the existing file for as long as this object lives: InputError "hdf5.busy".
  void lock();
  /// A new file next to the old one, which is locked as by lock() and stays until publish().
  void create();
  /// The new file, synced, gets the name now.
  void publish();
  /// Returns true after publish().
  bool is_published() const { return is_published_; }
  /// Returns true until the file is closed.
  bool is_open() const { return part_.has_value(); }
  /// Returns true after a function has thrown.
  bool has_failed() const { return failed_; }
  /// The path as given, before symbolic links are followed.
  const std::string& path() const { return path_; }

  /// Writes `size` bytes at the offset `place`, beyond the end too; repeats interrupted and partial writes.
  void write(std::uint64_t place, const char* data, std::size_t size);
  /// To at least this size, with zeros.
  void extend(std::uint64_t size);
  /// False where the device takes no file of this size.
  bool try_extend(std::uint64_t size);
  /// Shortens the file to this size.
  void truncate(std::uint64_t size);
  /// [bytes] written so far, zeros of extend() included.
  std::uint64_t size() const { return size_; }
  /// Bytes written so far survive a power cut.
  void sync();
  /// Throws if the name leads to another file or to none: the results would be lost.
  void check_name();
  /// Throws unless `ok`.
  void check(bool ok, const std::string& what);
  /// Removes the file if it has not been published.
  void close();

 private:
  bool is_at_target(int descriptor) const;

  std::string path_;
  std::string target_;  ///< what the path leads to by symbolic links
  std::optional<PartFile> part_;
  int old_ = -1;  ///< descriptor that holds the lock of the file to be replaced
  bool failed_ = false, is_published_ = false;
  std::uint64_t size_ = 0;
};

}  // namespace bough::hdf5
