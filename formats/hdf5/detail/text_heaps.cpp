#include "formats/hdf5/detail/text_heaps.hpp"

#include <cstring>

#include <sys/stat.h>
#include <unistd.h>

namespace bough::hdf5 {

namespace {

/// Leaves the bytes as they are in the file.
herr_t keep_bytes(hid_t, hid_t, H5T_cdata_t* conversion, std::size_t, std::size_t, std::size_t, void*, void*, hid_t) {
  if (conversion->command == H5T_CONV_INIT) conversion->need_bkg = H5T_BKG_NO;
  return 0;
}

/// Whole numbers of up to 8 bytes, the lowest byte first; of those that are larger than any file only that matters.
double get_number(const char* at, std::size_t size) {
  double number = 0;
  for (std::size_t i = size; i-- > 0;) number = 256 * number + static_cast<unsigned char>(at[i]);
  return number;
}

double round_up(double size) { return size + static_cast<double>((8 - static_cast<std::size_t>(size) % 8) % 8); }

}  // namespace

TextHeaps::TextHeaps(hid_t file) : descriptor_(get_descriptor(file)) {
  const Handle creation(H5Fget_create_plist(file), H5Pclose);
  hsize_t user_block = 0;
  H5Pget_sizes(creation.get(), &address_size_, &length_size_);
  H5Pget_userblock(creation.get(), &user_block);
  begin_ = static_cast<double>(user_block);
  type_ = Handle(H5Tcreate(H5T_OPAQUE, reference_size()), H5Tclose);
  const Handle text = make_string_type();
  // The conversion is registered by class: any string of variable length to any opaque bytes.
  H5Tregister(H5T_PERS_SOFT, "text_reference", text.get(), type_.get(), keep_bytes);
}

bool TextHeaps::holds(const std::vector<char>& references) {
  for (std::size_t at = 0; at + reference_size() <= references.size(); at += reference_size()) {
    const char* reference = references.data() + at;
    const double address = get_number(reference + 4, address_size_);
    if (address == 0) continue;
    const auto& heap = get_heap(address);
    const auto object = heap.find(static_cast<unsigned>(get_number(reference + 4 + address_size_, 4)));
    if (object == heap.end() || object->second != get_number(reference, 4)) return false;
  }
  return true;
}

const TextHeaps::Sizes& TextHeaps::get_heap(double address) {
  const auto [heap, is_new] = heaps_.try_emplace(address);
  if (is_new) heap->second = read_heap(address);
  return heap->second;
}

/// Nothing if there is no sound heap.
TextHeaps::Sizes TextHeaps::read_heap(double address) const {
  struct stat state {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &state) != 0) return {};
  const double place = begin_ + address, file_size = static_cast<double>(state.st_size);
  const std::size_t head = 8 + length_size_;
  const auto read = [this](double from, double size) {
    std::vector<char> bytes(static_cast<std::size_t>(size));
    const auto done = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(from));
    if (done != static_cast<ssize_t>(bytes.size())) bytes.clear();
    return bytes;
  };
  if (place + static_cast<double>(head) > file_size) return {};
  const auto begin = read(place, static_cast<double>(head));
  if (begin.empty() || std::memcmp(begin.data(), "GCOL\1", 5) != 0) return {};
  const double size = get_number(begin.data() + 8, length_size_);
  if (size < static_cast<double>(head) || place + size > file_size) return {};
  const auto bytes = read(place, size);
  if (bytes.empty()) return {};

  Sizes sizes;
  for (double at = round_up(static_cast<double>(head)); at + static_cast<double>(head) <= size;) {
    const char* object = bytes.data() + static_cast<std::size_t>(at);
    const auto number = static_cast<unsigned>(get_number(object, 2));
    const double length = get_number(object + 8, length_size_), left = size - at;
    if (length > left) return {};
    const double whole = number == 0 ? length : round_up(static_cast<double>(head)) + round_up(length);
    if (whole > left || whole < static_cast<double>(head)) return {};
    if (number > 0 && !sizes.emplace(number, length).second) return {};
    at += whole;
  }
  return sizes;
}

}  // namespace bough::hdf5
