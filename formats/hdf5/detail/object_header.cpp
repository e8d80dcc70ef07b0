#include "formats/hdf5/detail/object_header.hpp"

#include <cstring>

#include "base/diagnostic.hpp"

namespace bough::hdf5 {

namespace {

std::uint32_t rotate(std::uint32_t x, int bits) { return (x << bits) | (x >> (32 - bits)); }

void append_messages(std::string& to, const std::vector<Message>& messages) {
  for (const auto& m : messages) {
    BOUGH_DEMAND(m.body.size() <= kMaxMessage);
    append_number(to, static_cast<std::uint64_t>(m.type), 1);
    append_number(to, m.body.size(), 2);
    append_number(to, 0, 1);
    to += m.body;
  }
}

std::string finish(std::string block) {
  append_number(block, 0, 4);
  seal(block.data(), block.size());
  return block;
}

/// Class and version, three bytes of bits, size.
std::string begin_type(int kind, int version, std::uint64_t bits, std::uint64_t size) {
  std::string type;
  append_number(type, static_cast<std::uint64_t>(version << 4 | kind), 1);
  append_number(type, bits, 3);
  append_number(type, size, 4);
  return type;
}

std::string encode_fixed_point(int size, bool is_signed) {
  std::string type = begin_type(0, 1, is_signed ? 8 : 0, static_cast<std::uint64_t>(size));
  append_number(type, 0, 2);
  append_number(type, static_cast<std::uint64_t>(8 * size), 2);
  return type;
}

}  // namespace

void append_number(std::string& to, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) to.push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

void set_number(char* at, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) at[i] = static_cast<char>(value >> (8 * i) & 0xff);
}

std::uint64_t get_bits(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

std::uint32_t calc_lookup3(const char* data, std::size_t size) {
  std::uint32_t a = 0xdeadbeef + static_cast<std::uint32_t>(size), b = a, c = a;
  const auto* k = reinterpret_cast<const unsigned char*>(data);
  const auto get_word = [](const unsigned char* at, std::size_t bytes) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < bytes; ++i) word |= std::uint32_t{at[i]} << (8 * i);
    return word;
  };
  while (size > 12) {
    a += get_word(k, 4);
    b += get_word(k + 4, 4);
    c += get_word(k + 8, 4);
    a = (a - c) ^ rotate(c, 4), c += b;
    b = (b - a) ^ rotate(a, 6), a += c;
    c = (c - b) ^ rotate(b, 8), b += a;
    a = (a - c) ^ rotate(c, 16), c += b;
    b = (b - a) ^ rotate(a, 19), a += c;
    c = (c - b) ^ rotate(b, 4), b += a;
    size -= 12;
    k += 12;
  }
  if (size == 0) return c;
  a += get_word(k, std::min<std::size_t>(size, 4));
  if (size > 4) b += get_word(k + 4, std::min<std::size_t>(size - 4, 4));
  if (size > 8) c += get_word(k + 8, size - 8);
  c = (c ^ b) - rotate(b, 14);
  a = (a ^ c) - rotate(c, 11);
  b = (b ^ a) - rotate(a, 25);
  c = (c ^ b) - rotate(b, 16);
  a = (a ^ c) - rotate(c, 4);
  b = (b ^ a) - rotate(a, 14);
  return (c ^ b) - rotate(b, 24);
}

void seal(char* block, std::size_t size) { set_number(block + size - 4, calc_lookup3(block, size - 4), 4); }

std::string encode_real() {
  std::string type = begin_type(1, 1, 0x3f20, 8);  // sign at bit 63, the leading digit of the mantissa implied
  append_number(type, 0, 2);
  append_number(type, 64, 2);
  for (const int x : {52, 11, 0, 52}) append_number(type, static_cast<std::uint64_t>(x), 1);
  append_number(type, 1023, 4);
  return type;
}

std::string encode_integer(int size) { return encode_fixed_point(size, true); }

std::string encode_text() { return begin_type(9, 1, 0x101, 16) + encode_fixed_point(1, false); }

std::string encode_fixed_text(std::size_t size) { return begin_type(3, 1, 0, size); }

std::string encode_object_reference() { return begin_type(7, 1, 0, 8); }

std::string encode_reference_list() { return begin_type(9, 1, 0, 16) + encode_object_reference(); }

std::string encode_scale_user() {
  std::string type = begin_type(6, 3, 2, 16);
  type += std::string("dataset") + '\0' + '\0' + encode_object_reference();
  type += std::string("dimension") + '\0' + '\x08' + encode_integer(4);
  return type;
}

std::string encode_space(const Dims& shape, const Dims& max) {
  std::string space;
  append_number(space, 2, 1);
  append_number(space, shape.size(), 1);
  append_number(space, max.empty() ? 0 : 1, 1);
  append_number(space, shape.empty() ? 0 : 1, 1);
  for (const auto d : shape) append_number(space, d, 8);
  for (const auto d : max) append_number(space, d, 8);
  return space;
}

Message make_attribute(const std::string& name, const std::string& type, const std::string& space,
                       const std::string& data) {
  std::string body;
  append_number(body, 3, 1);
  append_number(body, 0, 1);
  append_number(body, name.size() + 1, 2);
  append_number(body, type.size(), 2);
  append_number(body, space.size(), 2);
  append_number(body, 1, 1);  // the name is UTF-8
  body += name + '\0';
  return {message::kAttribute, body + type + space + data};
}

Message make_link(const std::string& name, Address target) {
  const int length_size = name.size() > 255 ? 2 : 1;
  std::string body;
  append_number(body, 1, 1);
  append_number(body, 0x10 | (length_size - 1), 1);
  append_number(body, 1, 1);  // the name is UTF-8
  append_number(body, name.size(), length_size);
  body += name;
  append_number(body, target, 8);
  return {message::kLink, body};
}

std::vector<Message> make_group_messages() {
  std::string body(2, '\0');
  append_number(body, kUndefined, 8);
  append_number(body, kUndefined, 8);
  return {{message::kLinkInfo, body}, {message::kGroupInfo, std::string(2, '\0')}};
}

Message make_fill() { return {message::kFill, "\x03\x0b"}; }

Message make_contiguous(Address data, std::uint64_t size) {
  std::string body = "\x03\x01";
  append_number(body, data, 8);
  append_number(body, size, 8);
  return {message::kLayout, body};
}

Message make_chunked(Address tree, const Dims& chunk, int element_size) {
  std::string body = "\x03\x02";
  append_number(body, chunk.size() + 1, 1);
  append_number(body, tree, 8);
  for (const auto d : chunk) append_number(body, d, 4);
  append_number(body, static_cast<std::uint64_t>(element_size), 4);
  return {message::kLayout, body};
}

std::size_t calc_header_size(const std::vector<Message>& messages) {
  std::size_t size = kHeaderPrefix + 4;
  for (const auto& m : messages) size += kMessagePrefix + m.body.size();
  return size;
}

std::string encode_header(const std::vector<Message>& messages) {
  std::string block = "OHDR\x02\x02";
  append_number(block, calc_header_size(messages) - kHeaderPrefix - 4, 4);
  append_messages(block, messages);
  return finish(std::move(block));
}

std::string encode_continuation(const std::vector<Message>& messages) {
  std::string block = "OCHK";
  append_messages(block, messages);
  return finish(std::move(block));
}

}  // namespace bough::hdf5
