#pragma once
/// \file Encoders of the HDF5 File Format Specification, Version 3.0: datatypes, dataspaces, attributes, object
/// headers.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "formats/hdf5/detail/handle.hpp"

namespace bough::hdf5 {

using Address = std::uint64_t;  ///< [bytes] from the beginning of the file
inline constexpr Address kUndefined = ~Address{0};

/// Little-endian numbers of 1 to 8 bytes.
void append_number(std::string& to, std::uint64_t value, int size);
/// Writes a little-endian number of `size` bytes at `at`.
void set_number(char* at, std::uint64_t value, int size);
/// Bits of a double in IEEE 754.
std::uint64_t get_bits(double value);

/// Jenkins' lookup3 (hashlittle), the checksum of metadata blocks.
std::uint32_t calc_lookup3(const char* data, std::size_t size);
/// Replaces the last four bytes of a block by the checksum of the others.
void seal(char* block, std::size_t size);

/// Datatypes (IV.A.2.d).
std::string encode_real();
std::string encode_integer(int size);
/// UTF-8 of variable length: 16 bytes in the file, a reference into a global heap.
std::string encode_text();
/// Texts of `size` bytes, ended by zero.
std::string encode_fixed_text(std::size_t size);
/// References to objects, 8 bytes each.
std::string encode_object_reference();
/// A list of variable length of object references.
std::string encode_reference_list();
/// {dataset: object reference, dimension: int32} in 16 bytes.
std::string encode_scale_user();

/// Dataspace (IV.A.2.b); `max` empty: as the shape, and a scalar for no dimension.
std::string encode_space(const Dims& shape, const Dims& max = {});

/// A header message.
struct Message {
  int type = 0;
  std::string body;
};
namespace message {
inline constexpr int kSpace = 0x01, kLinkInfo = 0x02, kType = 0x03, kFill = 0x05, kLink = 0x06, kLayout = 0x08,
                     kGroupInfo = 0x0a, kAttribute = 0x0c, kContinuation = 0x10, kSymbolTable = 0x11, kBtreeK = 0x13;
}
/// Bytes of the messages that the size field of a header message can hold.
inline constexpr std::size_t kMaxMessage = 65535;

/// Message of an attribute, version 3; `type` and `space` are encoded messages.
Message make_attribute(const std::string& name, const std::string& type, const std::string& space,
                       const std::string& data);
/// Message of a hard link to the object header at `target`.
Message make_link(const std::string& name, Address target);
/// A group whose links are messages.
std::vector<Message> make_group_messages();
/// The fill value of the library, storage allocated as data comes.
Message make_fill();
/// Storage in one piece; kUndefined where there are no data.
Message make_contiguous(Address data, std::uint64_t size);
/// Chunks found by a B-tree of version 1, whose address is at kTreeInLayout of the body.
Message make_chunked(Address tree, const Dims& chunk, int element_size);
inline constexpr std::size_t kTreeInLayout = 3;

/// An object header (version 2) of one block, sealed.
std::string encode_header(const std::vector<Message>& messages);
/// A continuation block, sealed.
std::string encode_continuation(const std::vector<Message>& messages);
/// Bytes before the first message, and before the body of a message.
inline constexpr std::size_t kHeaderPrefix = 10, kMessagePrefix = 4;
/// [bytes] of an object header with these messages.
std::size_t calc_header_size(const std::vector<Message>& messages);

}  // namespace bough::hdf5
