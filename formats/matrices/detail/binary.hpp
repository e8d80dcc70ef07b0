#pragma once
/// \file Fortran's unformatted sequential records of either byte order: length, bytes, length again.
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "base/diagnostic.hpp"

namespace bough::matrices::detail {

/// Bytes of a file whose integers have 4 or 8 bytes; every fault is reported with its offset.
class BinaryInput {
 public:
  BinaryInput(std::string path, std::string bytes) : path_(std::move(path)), bytes_(std::move(bytes)) {}

  /// Sets byte order and word size of the file, which the caller finds from its first record.
  void set_layout(bool is_swapped, bool is_64_bit) {
    is_swapped_ = is_swapped;
    word_ = is_64_bit ? 8 : 4;
  }
  /// Finds byte order and word size by the length of the first record, with words of 4 and of 8 bytes; false if it has
  /// neither. `head`: the first four bytes of the file. Throws "matrices.truncated".
  bool find_layout(std::string_view head, std::int32_t length_4, std::int32_t length_8) {
    if (head.size() < 4) fail("matrices.truncated", 0, "the file ends within a record");
    for (const bool is_swapped : {false, true}) {
      set_layout(is_swapped, false);
      const auto length = get<std::int32_t>(head, 0);
      if (length != length_4 && length != length_8) continue;
      set_layout(is_swapped, length == length_8);
      return true;
    }
    return false;
  }
  /// Returns true if integers and reals have 8 bytes.
  bool is_64_bit() const { return word_ == 8; }
  /// [bytes] of an integer, 4 or 8.
  std::size_t get_word_size() const { return word_; }
  /// [bytes] of the file.
  std::size_t get_size() const { return bytes_.size(); }
  /// Returns true after the last record.
  bool is_at_end() const { return next_ >= bytes_.size(); }
  /// Offset [bytes] of the next record.
  std::size_t get_offset() const { return next_; }
  /// The path, for messages.
  const std::string& get_path() const { return path_; }

  /// Reads one record; the cursor is after it. Throws "matrices.truncated", "matrices.record".
  std::string_view read_record() {
    const std::size_t begin = next_;
    const auto length = read_marker(begin, begin);
    if (length < 0 || static_cast<std::size_t>(length) > bytes_.size() ||
        begin + 8 + static_cast<std::size_t>(length) > bytes_.size())
      fail("matrices.truncated", begin,
           "the record has " + std::to_string(length) + " bytes, the file has " + std::to_string(bytes_.size()),
           "copy or write the file again");
    const std::size_t end = begin + 4 + static_cast<std::size_t>(length);
    if (const auto closing = read_marker(end, begin); closing != length)
      fail("matrices.record", begin,
           "the record begins with the length " + std::to_string(length) + " and ends with " + std::to_string(closing),
           "write the file again");
    next_ = end + 4;
    return std::string_view(bytes_).substr(begin + 4, static_cast<std::size_t>(length));
  }

  /// Item `index` of a record taken as integers of the file's word.
  long get_integer(std::string_view record, std::size_t index) const {
    if (word_ == 8) return static_cast<long>(get<std::int64_t>(record, 8 * index));
    return get<std::int32_t>(record, 4 * index);
  }
  /// `offset` in bytes. With 64 bits the reals of both precisions have 8 bytes.
  double get_real(std::string_view record, std::size_t offset, bool is_double) const {
    return is_double || word_ == 8 ? get<double>(record, offset) : static_cast<double>(get<float>(record, offset));
  }

  /// Throws InputError `id` with the offset in its text.
  [[noreturn]] void fail(const char* id, std::size_t offset, const std::string& what,
                         const std::string& advice = {}) const {
    throw InputError(id, {path_}, "at byte " + std::to_string(offset) + ": " + what, advice);
  }

  /// Returns the value of sizeof(T) bytes at `offset`, in the byte order of the processor. \pre The record is long
  /// enough.
  template <class T>
  T get(std::string_view record, std::size_t offset) const {
    BOUGH_DEMAND(offset + sizeof(T) <= record.size());
    unsigned char raw[sizeof(T)];
    std::memcpy(raw, record.data() + offset, sizeof(T));
    if (is_swapped_)
      for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

 private:
  long read_marker(std::size_t at, std::size_t record) const {
    if (at + 4 > bytes_.size())
      fail("matrices.truncated", record, "the file ends within a record", "copy or write the file again");
    return get<std::int32_t>(std::string_view(bytes_), at);
  }

  std::string path_, bytes_;
  std::size_t next_ = 0, word_ = 4;
  bool is_swapped_ = false;
};

}  // namespace bough::matrices::detail
