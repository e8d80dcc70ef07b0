#pragma once
/// \file The bytes of a file, its lines, its numbers as Fortran and C write them, and where in it something is wrong.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::matrices::detail {

/// Throws InputError "matrices.cannot-open"; at most `max_bytes` bytes.
std::string read_bytes(const std::string& path, std::size_t max_bytes = std::string::npos);

/// A whole number with blanks around; nothing else.
std::optional<long> parse_integer(std::string_view text);
/// A real with blanks around: 1.5, 1.5E+3, 1.5D3, 1.5-103 (an exponent of three digits pushes the letter out), nan and
/// inf not among them.
std::optional<double> parse_real(std::string_view text);
/// Words between blanks, and `separator` too unless it is a blank.
std::vector<std::string_view> split(std::string_view line, char separator = ' ');
/// Removes blanks at both ends; a view of `text`.
std::string_view trim(std::string_view text);
/// Compares texts, letters of ASCII without regard to case.
bool equals_ignoring_case(std::string_view a, std::string_view b);
/// Numbers per line and columns per number: 3 and 23 for 1P,3E23.16.
struct NumberFormat {
  std::size_t per_line = 5, width = 16;
};
/// (1P,3E23.16), 3D23.16, (10I8): with or without parentheses, comma, scale factor; E, D, G, F or I.
std::optional<NumberFormat> parse_number_format(std::string_view text);
/// Printable letters of up to 40 characters of a line, for messages.
std::string quote(std::string_view text);

/// A text file, line by line.
class TextInput {
 public:
  TextInput(std::string path, std::string bytes) : path_(std::move(path)), bytes_(std::move(bytes)) {}

  /// False at the end. Line ends of either kind are cut off.
  bool next_line();
  /// Throws "matrices.truncated" at the end; `expected` says what should follow.
  void demand_line(const char* expected);
  /// Present line, valid until the next one is read.
  std::string_view get_line() const { return line_; }
  /// Number of the present line, from 1.
  int get_line_number() const { return number_; }
  /// The line will be read again by next_line.
  void unread() { is_unread_ = true; }
  /// The path, for messages.
  const std::string& get_path() const { return path_; }
  /// Upper bound of how many things of `bytes_each` the file can hold.
  std::size_t count_most(std::size_t bytes_each) const { return bytes_.size() / bytes_each + 1; }
  /// Throws InputError `id` at the present line.
  [[noreturn]] void fail(const char* id, const std::string& what, const std::string& advice = {}) const;
  /// fail("matrices.bad-number"): found against expected.
  [[noreturn]] void fail_line(const std::string& expected) const;

 private:
  std::string path_, bytes_;
  std::string_view line_;
  std::size_t next_ = 0;
  int number_ = 0;
  bool is_unread_ = false;
};

}  // namespace bough::matrices::detail
