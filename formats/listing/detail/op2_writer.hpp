#pragma once
/// \file Words, records and tables of OUTPUT2 files. Internal.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

namespace bough::listing::detail {

/// Words of 4 bytes.
class Words {
 public:
  /// Appends a 32-bit integer.
  void add(int value) { add_bits(static_cast<std::uint32_t>(value)); }
  /// No number: 1 as an integer, as Nastran has it.
  void add(double value) { add_bits(std::isnan(value) ? 1U : std::bit_cast<std::uint32_t>(static_cast<float>(value))); }
  /// Appends `size` characters of a text, filled with blanks; other characters than those of ASCII become "?".
  void add(const std::string& text, std::size_t size) {
    std::string padded = text.substr(0, size);
    for (char& c : padded)
      if (static_cast<unsigned char>(c) > '~') c = '?';
    padded.resize(size, ' ');
    bytes_ += padded;
  }
  /// Replaces the word at an index by an integer.
  void set(std::size_t index, int value) { set_bits(index, static_cast<std::uint32_t>(value)); }
  /// Replaces the word at an index by a real.
  void set(std::size_t index, double value) {
    set_bits(index, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  }
  /// Number of words.
  int count() const { return static_cast<int>(bytes_.size() / 4); }
  /// The bytes of all words, in the order of the processor.
  const std::string& bytes() const { return bytes_; }

 private:
  static std::array<char, 4> split(std::uint32_t bits) {
    return {static_cast<char>(bits & 255U), static_cast<char>(bits >> 8U & 255U), static_cast<char>(bits >> 16U & 255U),
            static_cast<char>(bits >> 24U & 255U)};
  }
  void add_bits(std::uint32_t bits) {
    const auto four = split(bits);
    bytes_.append(four.data(), four.size());
  }
  void set_bits(std::size_t index, std::uint32_t bits) {
    const auto four = split(bits);
    bytes_.replace(4 * index, 4, four.data(), four.size());
  }
  std::string bytes_;
};

/// Tables of records after the header of the file.
class Op2Writer {
 public:
  Op2Writer() {
    Words date;
    for (const int part : {1, 1, 0}) date.add(part);  // the same input gives the same file
    put_block(date);
    Words tape;
    tape.add("NASTRAN FORT TAPE ID CODE - ", 28);
    put_block(tape);
    Words label;
    label.add("XXXXXXXX", 8);
    put_block(label);
    put_key(-1);
    put_key(0);
  }

  /// Starts a table. \param name  of 8 characters at most. \param inner  name in its header record.
  void begin_table(const std::string& name, const std::string& inner) {
    Words words;
    words.add(name, 8);
    put_block(words);
    put_key(-1);
    Words trailer;
    for (const int word : {102, 0, 0, 0, 512, 0, 0}) trailer.add(word);
    put_block(trailer);
    next_ = -2;
    begin_record();
    Words head;
    head.add(inner, 8);
    for (const int word : {1, 1, 0, 0, 1}) head.add(word);
    put_block(head);
  }
  /// Appends a record with all its words.
  void add_record(const Words& words) {
    begin_record();
    put_block(words);
  }
  /// Ends the table after its last record.
  void end_table() {
    begin_record();
    put_key(0);
  }
  /// Ends the file and moves its bytes out; this is empty afterwards.
  std::string finish() {
    put_key(0);
    return std::move(bytes_);
  }

 private:
  void put_record(const std::string& data) {
    Words length;
    length.add(static_cast<int>(data.size()));
    bytes_ += length.bytes() + data + length.bytes();
  }
  void put_key(int key) {
    Words word;
    word.add(key);
    put_record(word.bytes());
  }
  void put_block(const Words& words) {
    put_key(words.count());
    put_record(words.bytes());
  }
  /// -n ends the record before; the first word of the next says that it belongs to a table.
  void begin_record() {
    put_key(next_--);
    Words kind;
    kind.add(0);
    put_block(kind);
  }

  std::string bytes_;
  int next_ = -2;
};

}  // namespace bough::listing::detail
