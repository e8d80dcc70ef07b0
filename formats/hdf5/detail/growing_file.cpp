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
#include "base/file_roles.hpp"
#include "base/part_file.hpp"

namespace bough::hdf5 {

namespace {

/// Metadata stay in memory between flushes: a killed run then leaves the file as the last flush made it.
Handle make_growing_access() {
  Handle access = make_file_access();
  H5AC_cache_config_t config;
  config.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  H5Pget_mdc_config(access.get(), &config);
  config.evictions_enabled = false;
  config.incr_mode = H5C_incr__off;
  config.flash_incr_mode = H5C_flash_incr__off;
  config.decr_mode = H5C_decr__off;
  H5Pset_mdc_config(access.get(), &config);
  return access;
}

/// No chunk cache: samples go to the file as they are written, so that a full disk shows there and not in a flush.
Handle make_uncached_access() {
  Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.get(), 1, 0, 1.0);
  return access;
}

}  // namespace

hsize_t get_rows_per_chunk(int size) { return static_cast<hsize_t>(std::clamp(16384 / std::max(1, size), 16, 1024)); }

GrowingFile::~GrowingFile() { close(); }

bool GrowingFile::close() {
  const bool ok = file_.reset();
  if (lock_ >= 0) ::close(std::exchange(lock_, -1));
  return ok;
}

/// Opens and locks the file at the target, a new one or the one there; false when it is not at the name any more.
bool GrowingFile::lock_once(bool creates) {
  lock_ =
      ::open(target_.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | (creates ? O_CREAT | O_EXCL : 0), 0666);
  if (lock_ < 0 && errno == (creates ? EEXIST : ENOENT)) return false;
  check(lock_ >= 0, creates ? "the file cannot be created" : "the file cannot be opened for writing");
  if (lock_file(lock_) == LockState::Busy)
    throw InputError("hdf5.busy", {path_}, "another process writes this file", "wait until it ends, or choose another");
  struct stat named {
  }, opened{};
  if (::stat(target_.c_str(), &named) == 0 && ::fstat(lock_, &opened) == 0 && named.st_dev == opened.st_dev &&
      named.st_ino == opened.st_ino)
    return true;
  ::close(lock_);
  lock_ = -1;
  return false;
}

void GrowingFile::lock() {
  std::error_code failed;
  target_ = find_target(path_, failed);
  errno = failed.value();
  check(!failed, "the file cannot be opened for writing");
  // A file that is not there is told by who reads it next.
  while (std::filesystem::exists(target_, failed) && !lock_once(false)) continue;
}

void GrowingFile::create() {
  note_output(path_);
  std::error_code failed;
  target_ = find_target(path_, failed);
  errno = failed.value();
  check(!failed, "the file cannot be created");
  bool is_made = false;
  for (int attempt = 0; !is_made && attempt < 10; ++attempt) {
    if (std::filesystem::is_regular_file(target_, failed) && lock_once(false)) {
      ::unlink(target_.c_str());
      ::close(std::exchange(lock_, -1));
    }
    is_made = lock_once(true);
  }
  errno = is_made ? 0 : EBUSY;
  const bool has_space = is_made && takes_a_block(lock_);
  if (is_made && !has_space) {
    const int cause = errno;
    ::unlink(target_.c_str());
    errno = cause;
  }
  check(has_space, "the file cannot be created");
  const Handle access = make_growing_access();
  file_ = Handle(H5Fcreate(target_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
  check(file_.is_valid(), "the file cannot be created");
}

void GrowingFile::check_name() {
  struct stat named {
  }, opened{};
  if (lock_ < 0) return;
  const bool is_there = ::lstat(target_.c_str(), &named) == 0;
  if (is_there && ::fstat(lock_, &opened) == 0 && named.st_dev == opened.st_dev && named.st_ino == opened.st_ino)
    return;
  errno = 0;
  check(false, is_there ? "another file has taken its place since the run began"
                        : "the file has been removed or renamed since the run began");
}

void GrowingFile::open() {
  BOUGH_DEMAND(lock_ >= 0);
  const Handle access = make_growing_access();
  file_ = Handle(H5Fopen(target_.c_str(), H5F_ACC_RDWR, access.get()), H5Fclose);
  check(file_.is_valid(), "the file cannot be opened for writing");
}

void GrowingFile::check(bool ok, const std::string& what) {
  if (ok) return;
  failed_ = true;
  const int cause = errno;
  if (file_.is_valid()) abandon_writes(file_.get());
  errno = cause;
  const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : std::string();
  throw ComputationError("hdf5.write", {path_}, what + reason, "check the folder, its permissions and the free space");
}

void GrowingFile::write_integer(hid_t object, const char* name, std::int64_t value, hid_t type) {
  const std::string what = std::string("attribute ") + name + " cannot be written";
  if (H5Aexists(object, name) > 0) {
    const Handle old(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    const Handle old_space(H5Aget_space(old.get()), H5Sclose);
    if (H5Sget_simple_extent_npoints(old_space.get()) != 1) check(H5Adelete(object, name) >= 0, what);
  }
  if (H5Aexists(object, name) <= 0) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle made(H5Acreate2(object, name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    check(made.is_valid(), what);
  }
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  check(H5Awrite(attribute.get(), H5T_NATIVE_INT64, &value) >= 0, what);
}

Handle GrowingFile::make_column(const std::string& path, int size, hid_t type, const std::string& description,
                                const std::string& dims) {
  const int rank = size == 1 ? 1 : 2;
  const hsize_t shape[2] = {0, static_cast<hsize_t>(size)};
  const hsize_t most[2] = {H5S_UNLIMITED, shape[1]};
  const hsize_t chunk[2] = {get_rows_per_chunk(size), std::max<hsize_t>(1, shape[1])};
  const Handle space(H5Screate_simple(rank, shape, most), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(creation.get(), rank, chunk);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.get(), 1);
  const Handle access = make_uncached_access();
  Handle dataset(H5Dcreate2(file_.get(), path.c_str(), type, space.get(), links.get(), creation.get(), access.get()),
                 H5Dclose);
  check(dataset.is_valid(), "dataset " + path + " cannot be written");
  check(write_text_attribute(dataset.get(), "description", description) &&
            write_text_attribute(dataset.get(), "dims", dims),
        "the attributes of " + path + " cannot be written");
  return dataset;
}

Handle GrowingFile::open_column(const std::string& path) {
  const Handle uncached = make_uncached_access();
  return Handle(H5Dopen2(file_.get(), path.c_str(), uncached.get()), H5Dclose);
}

void GrowingFile::append(Handle& column, hsize_t first, hsize_t rows, int size, hid_t type, const void* data) {
  const int rank = size == 1 ? 1 : 2;
  const hsize_t shape[2] = {first + rows, static_cast<hsize_t>(size)};
  const hsize_t start[2] = {first, 0}, block[2] = {rows, static_cast<hsize_t>(size)};
  bool ok = H5Dset_extent(column.get(), shape) >= 0;
  if (ok && size == 0) return;  // a rigid body's eta: rows without entries
  const Handle file_space(H5Dget_space(column.get()), H5Sclose);
  const Handle memory_space(H5Screate_simple(rank, block, nullptr), H5Sclose);
  ok = ok && H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start, nullptr, block, nullptr) >= 0;
  ok = ok && H5Dwrite(column.get(), type, memory_space.get(), file_space.get(), H5P_DEFAULT, data) >= 0;
  check(ok, "samples cannot be written");
}

void GrowingFile::cut(Handle& column, hsize_t rows) {
  const Handle space(H5Dget_space(column.get()), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  check(rank == 1 || rank == 2, "the file cannot be cut back to the checkpoint");
  hsize_t shape[2] = {0, 0};
  H5Sget_simple_extent_dims(space.get(), shape, nullptr);
  shape[0] = rows;
  check(H5Dset_extent(column.get(), shape) >= 0, "the file cannot be cut back to the checkpoint");
}

}  // namespace bough::hdf5
