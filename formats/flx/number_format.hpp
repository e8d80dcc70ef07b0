#pragma once
/// \file Formats of numbers in a layout: C's %16.8E, %5d and Fortran's 5E16.8, 1P5E16.8, ES16.8, D24.16, F12.4, I5.
#include <optional>
#include <string>

namespace bough::flx {

class NumberFormat {
 public:
  /// Empty when the text is no such format.
  static std::optional<NumberFormat> parse(const std::string& text);

  /// One number in its columns. Empty when it does not fit its width (Fortran would print stars).
  std::optional<std::string> print(double value) const;
  /// One whole number in its columns; with a format of reals as a real.
  std::optional<std::string> print_integer(long value) const;

  /// Returns true for %d and I, which take whole numbers.
  bool is_integer() const { return style_ == 'd'; }
  /// Returns true if the format gives a width in columns.
  bool has_width() const { return width_ > 0; }
  /// Fortran's repeat count: values on a line; 0 when none is given.
  int per_line() const { return repeat_; }

 private:
  std::optional<std::string> fit(std::string text) const;
  std::string print_fortran(double value) const;

  bool is_fortran_ = false;
  char style_ = 'e';   ///< e f g d; the letter's case is in letter_
  char letter_ = 'E';  ///< what marks the exponent: E e D
  std::string flags_;  ///< C only
  int width_ = 0, precision_ = 6, scale_ = 0, repeat_ = 0;
};

}  // namespace bough::flx
