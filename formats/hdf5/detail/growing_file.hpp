#pragma once
/// \file An HDF5 file whose datasets grow by rows, readable while it is written.
#include <cstdint>
#include <string>

#include "formats/hdf5/detail/handle.hpp"

namespace bough::hdf5 {

/// Rows per chunk of a column of this many numbers a row: some 16 k numbers, so that long runs make few chunks and
/// short ones waste little.
hsize_t get_rows_per_chunk(int size);

/// Every function throws ComputationError "hdf5.write", with the system's reason.
class GrowingFile {
 public:
  explicit GrowingFile(std::string path) : path_(std::move(path)) {}
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// A new file, not the old one emptied: who is reading the old one keeps it. Locked, and so is the one to go:
  /// InputError "hdf5.busy" while another process writes it.
  void create();
  /// Keeps other processes from writing the existing file for as long as this object lives: InputError "hdf5.busy".
  void lock();
  /// That the file is still to be found under its name: what is written would be lost otherwise.
  void check_name();
  /// After lock().
  void open();
  /// After the columns are closed, and the lock with it; false when that failed.
  bool close();
  bool is_open() const { return file_.is_valid(); }
  bool has_failed() const { return failed_; }
  hid_t get() const { return file_.get(); }
  const std::string& path() const { return path_; }

  /// Gives up on the file and throws unless `ok`.
  void check(bool ok, const std::string& what);
  /// Everything to the disk.
  void flush() { check(flush_file(file_.get()), "the file cannot be written"); }
  /// An integer attribute of the type, made where it is absent.
  void write_integer(hid_t object, const char* name, std::int64_t value, hid_t type);

  /// A dataset of rows of `size` numbers, or of one column of `type`.
  Handle make_column(const std::string& path, int size, hid_t type, const std::string& description,
                     const std::string& dims);
  Handle open_column(const std::string& path);
  /// Rows `first` to first + rows - 1.
  void append(Handle& column, hsize_t first, hsize_t rows, int size, hid_t type, const void* data);
  /// Leaves the first rows.
  void cut(Handle& column, hsize_t rows);

 private:
  bool lock_once(bool creates);

  std::string path_;
  std::string target_;  ///< what the path leads to by symbolic links
  int lock_ = -1;       ///< descriptor that holds the lock
  bool failed_ = false;
  Handle file_;
};

}  // namespace bough::hdf5
