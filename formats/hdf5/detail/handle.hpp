#pragma once
/// \file HDF5 identifiers that close themselves, and the error stack kept silent.
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "formats/hdf5/lost_file.hpp"

namespace bough::hdf5 {

using Dims = std::vector<hsize_t>;

/// Owns one identifier; closes it with the function that belongs to its kind.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  /// Closes the present identifier and takes that of `other`.
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      id_ = std::exchange(other.id_, -1);
      close_ = other.close_;
    }
    return *this;
  }
  ~Handle() { reset(); }

  /// The identifier, still owned by this.
  hid_t get() const { return id_; }
  /// Returns false if the call that gave the identifier failed.
  bool is_valid() const { return id_ >= 0; }
  /// Closes now; false when closing failed (a full disk shows here).
  bool reset() {
    const hid_t id = std::exchange(id_, -1);
    if (id < 0 || close_(id) >= 0) return true;
    if (close_ == &H5Fclose) note_lost_file();
    return false;
  }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// While it lives, HDF5 prints nothing: every failure is reported as a Diagnostic instead.
class QuietErrors {
 public:
  QuietErrors() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Variable-length UTF-8 string, the one string type of the files.
Handle make_string_type();

/// For reading and writing `count` strings: the library clears a buffer of 1 MB for each such dataset unless told what
/// is enough.
Handle make_string_transfer(std::size_t count);

/// Property list for opening files: no file locks, so that a file can be read while it is written, also on network
/// file systems.
Handle make_file_access();

/// File descriptor of an open file; -1 if it is not a plain file.
int get_descriptor(hid_t file);

/// Returns true if an empty file can grow by a few bytes, which are removed again; false, with errno, if not. HDF5
/// itself crashes on a file that cannot hold its first block.
bool takes_a_block(int descriptor);

/// Reserves disk space for all of the file as it is now in memory, and `more` bytes; false, with errno, when there is
/// not enough. HDF5 does not survive a write or flush that fails half-way: neither closing the file nor the end of the
/// program, so a full disk has to show before.
bool reserve_space(hid_t file, hsize_t more);

/// Reserves and flushes.
bool flush_file(hid_t file);

/// Gives up on a file whose device refuses writes: what is still to be written goes to memory, so that it can be
/// closed.
void abandon_writes(hid_t file);

/// Returns true if "/a/b/c" and all its parents exist.
bool exists(hid_t file, const std::string& path);

/// Address of an open object in its file: two names of one object have one address.
haddr_t get_address(hid_t object);

/// "3 x 4"; "scalar" for no dimension.
std::string describe_shape(const Dims& dims);

/// A string attribute as text; empty when absent or of another kind.
std::string read_text_attribute(hid_t object, const std::string& name);

/// Replaces a scalar string attribute of an open object; false on failure.
bool write_text_attribute(hid_t object, const std::string& name, const std::string& text);

}  // namespace bough::hdf5
