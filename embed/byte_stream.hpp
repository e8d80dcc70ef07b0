#pragma once
/// \file Numbers one after the other in memory, in the byte order of this machine.
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace bough::embed {

/// Appends values to bytes.
class ByteWriter {
 public:
  /// Appends `size` bytes.
  void write(const void* from, std::size_t size) {
    const auto* bytes = static_cast<const std::byte*>(from);
    all.insert(all.end(), bytes, bytes + size);
  }
  /// Appends the eight bytes of a double.
  void write(double value) { write(&value, sizeof value); }
  /// Appends the eight bytes of an integer.
  void write(std::uint64_t value) { write(&value, sizeof value); }

  std::vector<std::byte> all;  ///< what was written
};

/// Takes values from bytes, which must outlive it.
class ByteReader {
 public:
  /// \param fail  throws an error with this text
  ByteReader(std::span<const std::byte> bytes, void (*fail)(const char* what)) : bytes_(bytes), fail_(fail) {}

  /// Takes `size` bytes; an error if fewer are left.
  void read(void* to, std::size_t size) {
    if (size > num_left()) fail_("the state ends early");
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }
  /// Takes the bytes of a value of a plain type.
  template <class T>
  T read() {
    T value{};
    read(&value, sizeof value);
    return value;
  }
  /// Reads a number of things that follow; an error if it is above the limit.
  std::uint64_t read_count(std::uint64_t limit) {
    const auto value = read<std::uint64_t>();
    if (value > limit) fail_("the state is damaged");
    return value;
  }
  /// Number of bytes taken so far.
  std::size_t at() const { return at_; }
  /// Number of bytes that are left.
  std::size_t num_left() const { return bytes_.size() - at_; }

 private:
  std::span<const std::byte> bytes_;
  void (*fail_)(const char*);
  std::size_t at_ = 0;
};

}  // namespace bough::embed
