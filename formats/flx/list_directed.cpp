#include "formats/flx/list_directed.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/file_roles.hpp"
#include "base/platform.hpp"

namespace bough::flx {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// "12", "+12", "-3".
bool parse(std::string_view text, int& value) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  if (text.empty() || (text[0] == '-' && text.size() == 1)) return false;
  const auto [end, error] = platform::read_number(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && (text[0] == '-' || is_digit(text[0]));
}

/// "1", "1.", ".5", "1D-3", "1.5e+3", "1.5+3" (exponent without its letter).
bool parse(std::string_view text, double& value) {
  std::string plain;
  bool has_exponent = false, has_digit = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_digit(c) || c == '.') {
      has_digit |= is_digit(c);
      plain += c;
    } else if (c == 'E' || c == 'e' || c == 'D' || c == 'd' || c == 'Q' || c == 'q') {
      if (has_exponent || !has_digit) return false;
      has_exponent = true;
      plain += 'e';
      if (i + 1 < text.size() && (text[i + 1] == '+' || text[i + 1] == '-')) {
        if (text[++i] == '-') plain += '-';
      }
    } else if (c == '+' || c == '-') {
      if (i > 0) {
        if (has_exponent || !has_digit) return false;
        has_exponent = true;
        plain += 'e';
      }
      if (c == '-') plain += '-';
    } else {
      return false;
    }
  }
  if (!has_digit) return false;
  const auto [end, error] = platform::read_number(plain.data(), plain.data() + plain.size(), value);
  // Too small for a double: zero, as Fortran has it. Too large stays an error.
  if (error == std::errc::result_out_of_range && end == plain.data() + plain.size()) {
    const auto exponent = plain.find('e');
    if (exponent == std::string::npos || plain[exponent + 1] != '-') return false;
    value = 0;
    return true;
  }
  return error == std::errc{} && end == plain.data() + plain.size();
}

const char* name_kind(int) { return "an integer"; }
const char* name_kind(double) { return "a number"; }

}  // namespace

ListReader::ListReader(std::string text, std::string file, Diagnostics& diagnostics)
    : text_(std::move(text)), file_(std::move(file)), diagnostics_(diagnostics) {}

std::string read_text_file(const std::string& path) {
  std::error_code failed;
  std::ifstream in;
  if (std::filesystem::is_regular_file(path, failed)) in.open(path, std::ios::binary);
  note_input(path);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in.is_open() || text.fail())
    throw InputError("flx.cannot-read", {path}, "the file cannot be read or is empty", "check its path and contents");
  return text.str();
}

ListReader ListReader::open(const std::string& path, Diagnostics& diagnostics) {
  return {read_text_file(path), path, diagnostics};
}

bool ListReader::is_comment(std::size_t begin, std::size_t end) const {
  std::size_t i = begin;
  while (i < end && is_blank(text_[i])) ++i;
  if (i == end) return true;
  if (std::string_view("!#%$").find(text_[i]) != std::string_view::npos) return true;
  // Fortran's own comment lines: c, C or * in the first column. No number starts so.
  return i == begin && (text_[i] == 'c' || text_[i] == 'C' || text_[i] == '*');
}

/// Goes to the next line with data.
bool ListReader::start_line() {
  while (next_line_ < text_.size()) {
    line_begin_ = next_line_;
    const auto newline = text_.find('\n', line_begin_);
    line_end_ = newline == std::string::npos ? text_.size() : newline;
    next_line_ = newline == std::string::npos ? text_.size() : newline + 1;
    ++line_;
    position_ = line_begin_;
    if (!is_comment(line_begin_, line_end_)) return true;
  }
  position_ = line_begin_ = line_end_ = text_.size();
  return false;
}

void ListReader::skip_blanks() {
  while (position_ < line_end_ && is_blank(text_[position_])) ++position_;
  if (position_ < line_end_ && text_[position_] == '!') position_ = line_end_;
}

/// On to the next character of the record, over blanks, comments and line ends; false at the end of the file.
bool ListReader::find_next() {
  for (;;) {
    skip_blanks();
    if (position_ < line_end_) return true;
    if (!start_line()) return false;
  }
}

ListReader::Token ListReader::next() {
  if (!find_next()) return {};
  if (after_value_ && text_[position_] == ',') {
    ++position_;
    if (!find_next()) return {};
  }
  after_value_ = true;
  if (text_[position_] == '/') return {Kind::EndOfRead, {}, 1};
  if (text_[position_] == ',') return {Kind::Null, {}, 1};
  const std::size_t begin = position_;
  while (position_ < line_end_ && !is_blank(text_[position_]) &&
         std::string_view(",/!").find(text_[position_]) == std::string_view::npos)
    ++position_;
  Token token{Kind::Value, text_.substr(begin, position_ - begin), 1};
  const auto star = token.text.find('*');
  int repeat = 0;
  if (star == std::string::npos || !is_digit(token.text[0]) || !parse(token.text.substr(0, star), repeat)) return token;
  if (repeat < 1) return token;  // "0*1" is no number: the caller reports it
  token.repeat = repeat;
  token.text.erase(0, star + 1);
  if (token.text.empty()) token.kind = Kind::Null;
  return token;
}

template <class Number>
bool ListReader::read_values(const std::string& item, std::vector<Number>& values) {
  std::fill(values.begin(), values.end(), Number{});
  position_ = line_end_;
  after_value_ = false;
  if (values.empty()) return true;
  const bool begins = find_next();
  bool has_leftover = false;
  first_line_ = line_;
  for (std::size_t i = 0; i < values.size();) {
    const Token token = begins ? next() : Token{};
    if (token.kind == Kind::EndOfFile) return fail_short(item, i, values.size());
    if (token.kind == Kind::EndOfRead) break;
    Number value{};
    if (token.kind == Kind::Value && (!parse(token.text, value) || !std::isfinite(static_cast<double>(value)))) {
      value = {};
      diagnostics_.error("flx.bad-number", {file_, line_},
                         item + ": value " + std::to_string(i + 1) + " of " + std::to_string(values.size()) +
                             " is not " + name_kind(value) + ", found \"" + token.text + "\"",
                         "put values in the order of docs/formats/flx.md; mark remarks with !");
    }
    const auto room = static_cast<long>(values.size() - i);
    has_leftover = token.repeat > room;
    std::fill_n(values.begin() + static_cast<long>(i), std::min(room, token.repeat), value);
    i += static_cast<std::size_t>(std::min(room, token.repeat));
  }
  note_lines(item);
  warn_of_leftovers(item, has_leftover);
  return true;
}

bool ListReader::read(const std::string& item, std::vector<double>& values) { return read_values(item, values); }
bool ListReader::read(const std::string& item, std::vector<int>& values) { return read_values(item, values); }

/// Warns of numbers in the rest of a line, which Fortran skips: the count may be wrong. Words are comments.
void ListReader::warn_of_leftovers(const std::string& item, bool has_leftover) {
  skip_blanks();
  if (position_ < line_end_ && text_[position_] == ',') ++position_;
  skip_blanks();
  std::size_t end = position_;
  while (end < line_end_ && !is_blank(text_[end]) && text_[end] != ',') ++end;
  std::string word = text_.substr(position_, end - position_);
  if (const auto star = word.find('*'); star != std::string::npos && is_digit(word[0])) word.erase(0, star + 1);
  double number = 0;
  const std::string name = item.substr(0, item.find(','));
  if ((!has_leftover && !parse(word, number)) || name == warned_item_) return;
  warned_item_ = name;
  diagnostics_.warning("flx.extra-values", {file_, line_}, item + ": more numbers on the line are not read",
                       "check the counts in the first line of the model file; mark remarks with !");
}

/// A row with a value too few takes the first of the next row, and so on to the end of the file: keep the place.
void ListReader::note_lines(const std::string& item) {
  const std::string name = item.substr(0, item.find(','));
  const int lines = line_ - first_line_ + 1;
  if (name != rows_of_) {
    rows_of_ = name;
    usual_lines_ = lines;
  } else if (lines > usual_lines_ && stretched_.empty()) {
    stretched_ = item + " took " + std::to_string(lines) + " lines from line " + std::to_string(first_line_) +
                 " on, the first of its kind " + std::to_string(usual_lines_) + ": is a value missing there?";
  }
}

bool ListReader::fail_short(const std::string& item, std::size_t found, std::size_t expected) {
  diagnostics_.error(
      "flx.short-file", {file_, line_},
      item + ": the file ends after " + std::to_string(found) + " of " + std::to_string(expected) + " values",
      stretched_.empty() ? "add what is missing, or correct the counts" : "add what is missing; " + stretched_);
  return false;
}

void ListReader::check_end() {
  if (start_line())
    diagnostics_.warning("flx.trailing-data", {file_, line_}, "data after the last item are not read",
                         "check the counts in the first line of the model file");
}

}  // namespace bough::flx
