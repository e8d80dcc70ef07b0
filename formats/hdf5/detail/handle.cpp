#include "formats/hdf5/detail/handle.hpp"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

#include "base/platform.hpp"
#include "formats/hdf5/lost_file.hpp"

namespace bough::hdf5 {

namespace {
bool g_has_lost_file = false;
// Every handle closes itself; a file that could not be closed would be written again at the exit.
[[maybe_unused]] const bool g_leaves_in_peace = H5dont_atexit() >= 0;
}  // namespace

bool has_lost_file() { return g_has_lost_file; }
void note_lost_file() { g_has_lost_file = true; }

Handle make_string_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

Handle make_string_transfer(std::size_t count) {
  constexpr std::size_t kPerText = 32, kMin = 1024, kMax = 1 << 20;  // bytes; in the file 16, in memory a pointer
  Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_buffer(transfer.get(), std::clamp(kPerText * count, kMin, kMax), nullptr, nullptr);
  return transfer;
}

Handle make_file_access() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access.get(), false, true);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  // The library clears its default of 64 kB for every dataset: most of them are far smaller.
  H5Pset_sieve_buf_size(access.get(), 4096);
  return access;
}

bool takes_a_block(int descriptor) {
  const std::string block(4096, '\0');
  return ::pwrite(descriptor, block.data(), block.size(), 0) == static_cast<ssize_t>(block.size()) &&
         ::ftruncate(descriptor, 0) == 0;
}

int get_descriptor(hid_t file) {
  void* found = nullptr;
  return H5Fget_vfd_handle(file, H5P_DEFAULT, &found) < 0 || !found ? -1 : *static_cast<int*>(found);
}

bool reserve_space(hid_t file, hsize_t more) {
  hsize_t size = 0;
  const int descriptor = get_descriptor(file);
  if (descriptor < 0 || H5Fget_filesize(file, &size) < 0 || size + more == 0) return true;
  if (platform::reserve_space(descriptor, static_cast<off_t>(size + more))) return true;
  // Some file systems cannot reserve; there the write itself has to show.
  if (errno == ENOSPC || errno == EFBIG || errno == EDQUOT || errno == EIO) return false;
  errno = 0;
  return true;
}

bool flush_file(hid_t file) { return reserve_space(file, 0) && H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0; }

void abandon_writes(hid_t file) {
  const int descriptor = get_descriptor(file);
  const int memory = descriptor < 0 ? -1 : platform::open_nameless_file();
  if (memory < 0) return;
  ::dup2(memory, descriptor);
  ::close(memory);
}

bool exists(hid_t file, const std::string& path) {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end);
    if (part != "/" && H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

haddr_t get_address(hid_t object) {
  H5O_info_t info;
  return H5Oget_info2(object, &info, H5O_INFO_BASIC) < 0 ? HADDR_UNDEF : info.addr;
}

std::string describe_shape(const Dims& dims) {
  if (dims.empty()) return "scalar";
  std::string text;
  for (const auto d : dims) text += (text.empty() ? "" : " x ") + std::to_string(d);
  return text;
}

std::string read_text_attribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return {};
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1) return {};
  if (H5Tis_variable_str(type.get()) > 0) {
    const Handle memory = make_string_type();
    char* text = nullptr;
    if (H5Aread(attribute.get(), memory.get(), &text) < 0 || !text) return {};
    std::string result(text);
    H5free_memory(text);
    return result;
  }
  std::string text(H5Tget_size(type.get()), '\0');
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) return {};
  return text.substr(0, text.find('\0'));
}

bool write_text_attribute(hid_t object, const std::string& name, const std::string& text) {
  if (H5Aexists(object, name.c_str()) > 0 && H5Adelete(object, name.c_str()) < 0) return false;
  const Handle type = make_string_type();
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const char* data = text.c_str();
  return attribute.is_valid() && H5Awrite(attribute.get(), type.get(), &data) >= 0;
}

}  // namespace bough::hdf5
