#pragma once
/// \file Fortran's list-directed reading, read(unit,*): free format (Fortran 77, ANSI X3.9-1978, 13.6;
/// docs/formats/flx.md).
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::flx {

/// Content of a text file. Throws InputError "flx.cannot-read".
std::string read_text_file(const std::string& path);

/// Reads records of a text as list-directed input does. Each read starts at a new line and takes further lines until it
/// has its values; what is left of the last line is passed over. Values are separated by blanks, commas or line ends;
/// `3*0.5` repeats, `3*` and `,,` are null values, `/` ends the read with nulls. A null leaves the variable at zero, as
/// it is at the start of a Fortran program. Extension: comments (docs/formats/flx.md).
class ListReader {
 public:
  ListReader(std::string text, std::string file, Diagnostics& diagnostics);
  /// Throws InputError("flx.cannot-read").
  static ListReader open(const std::string& path, Diagnostics& diagnostics);

  /// Reads values.size() numbers. `item` names them in messages: "item 7 of 15: body mass". Reports "flx.bad-number"
  /// for each value that is none (it counts as zero) and, once an item, "flx.extra-values" for numbers left over on the
  /// last line. False, with "flx.short-file", when the file ends first.
  bool read(const std::string& item, std::vector<double>& values);
  bool read(const std::string& item, std::vector<int>& values);

  /// Warns with "flx.trailing-data" when a line with data is left.
  void check_end();

  /// The line where the last read began, for messages about its values.
  SourceLocation get_location() const { return {file_, first_line_}; }

 private:
  enum class Kind { Value, Null, EndOfRead, EndOfFile };
  struct Token {
    Kind kind = Kind::EndOfFile;
    std::string text;
    long repeat = 1;
  };
  template <class Number>
  bool read_values(const std::string& item, std::vector<Number>& values);
  bool start_line();
  bool is_comment(std::size_t begin, std::size_t end) const;
  void skip_blanks();
  bool find_next();
  Token next();
  void note_lines(const std::string& item);
  void warn_of_leftovers(const std::string& item, bool has_leftover);
  bool fail_short(const std::string& item, std::size_t found, std::size_t expected);

  std::string text_, file_;
  Diagnostics& diagnostics_;
  std::size_t position_ = 0, line_begin_ = 0, line_end_ = 0, next_line_ = 0;
  int line_ = 0, first_line_ = 0;
  bool after_value_ = false;
  std::string warned_item_;
  /// Lines that each read of an item took: a read that took more than the first tells where a value is missing.
  std::string rows_of_, stretched_;
  int usual_lines_ = 0;
};

}  // namespace bough::flx
