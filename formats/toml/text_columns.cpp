#include "formats/toml/detail/text_columns.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/file_roles.hpp"

namespace bough::toml_files {
namespace {

bool is_separator(char c) { return c == ',' || c == ';' || c == '\t' || c == '\r' || c == ' '; }

/// Words between separators; a name in quotation marks may hold them.
std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < line.size();) {
    if (is_separator(line[i])) {
      ++i;
    } else if (line[i] == '"') {
      const std::size_t end = std::min(line.find('"', i + 1), line.size());
      words.push_back(line.substr(i + 1, end - i - 1));
      i = end + 1;
    } else {
      const std::size_t end = static_cast<std::size_t>(
          std::find_if(line.begin() + static_cast<std::ptrdiff_t>(i), line.end(), is_separator) - line.begin());
      words.push_back(line.substr(i, end - i));
      i = end;
    }
  }
  return words;
}

/// Names in a heading: with tabs, semicolons or commas, blanks belong to the names ("time (s),thrust (N)").
std::vector<std::string> split_names(const std::string& line) {
  std::string bare;  // without the text in quotation marks
  bool is_quoted = false;
  for (const char c : line) {
    is_quoted = is_quoted != (c == '"');
    bare += is_quoted ? '"' : c;
  }
  const std::size_t kind = bare.find('\t') != std::string::npos ? 0 : bare.find(';') != std::string::npos ? 1 : 2;
  const char separator = "\t;,"[kind];
  if (bare.find(separator) == std::string::npos) return split(line);
  std::vector<std::string> names;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t to = std::min(bare.find(separator, from), line.size());
    const std::string word = line.substr(from, to - from);
    from = to + 1;
    const std::size_t first = word.find_first_not_of(" \t\r");
    if (first == std::string::npos) continue;
    std::string name = word.substr(first, word.find_last_not_of(" \t\r") - first + 1);
    if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    names.push_back(name);
  }
  return names;
}

/// "1,5;2,5": the first word between semicolons, tabs or blanks that has a comma between digits; empty: none.
std::string find_decimal_comma(const std::string& line) {
  if (line.find_first_of(";\t ") == std::string::npos) return "";
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    if (line[i] != ',' || !is_digit(line[i - 1]) || !is_digit(line[i + 1])) continue;
    const std::size_t from = line.find_last_of(";\t ", i);
    const std::size_t first = from == std::string::npos ? 0 : from + 1;
    return line.substr(first, std::min(line.find_first_of(";\t \r", i), line.size()) - first);
  }
  return "";
}

bool read_numbers(const std::vector<std::string>& words, std::vector<double>& numbers) {
  numbers.clear();
  for (const auto& word : words) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0') return false;
  }
  return true;
}

class Reader {
 public:
  Reader(const std::string& path, const ColumnChoice& choice, Diagnostics& diagnostics)
      : path_(path), choice_(choice), diagnostics_(diagnostics) {}

  void read(std::ifstream& in, std::vector<double>& x, std::vector<double>& y) {
    std::string line, heading;
    bool is_first = true;
    int heading_line = 0;
    const int errors = diagnostics_.num_errors();
    for (int number = 1; std::getline(in, line); ++number) {
      if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);  // "CSV UTF-8"
      line.erase(std::find(line.begin(), line.end(), '#'), line.end());
      const auto words = split(line);
      if (words.empty()) continue;
      std::vector<double> numbers;
      const bool all_numbers = read_numbers(words, numbers);
      if (is_first && heading_line == 0 && !all_numbers) {
        heading = line;
        heading_line = number;
        continue;
      }
      if (is_first) {
        is_first = false;
        if (!choose_by(heading, heading_line, words.size(), number)) return;
      }
      if (const std::string comma = find_decimal_comma(line); numbers.size() != count_ && !comma.empty())
        return error(number, "the line has a decimal comma, '" + comma + "'", "write decimal points");
      if (!all_numbers || numbers.size() != count_) {
        error(number,
              all_numbers
                  ? "the line has " + std::to_string(numbers.size()) + " numbers, expected " + std::to_string(count_)
                  : "the line is not " + (count_ == 2 ? "two" : std::to_string(count_)) + " numbers",
              count_ == 2 ? "give one pair per line" : "give one number a column");
        continue;
      }
      const double a = numbers[x_], b = numbers[y_];
      if (!std::isfinite(a) || !std::isfinite(b)) {
        diagnostics_.error("toml.nan", {path_, number}, "the line has a value that is not a finite number",
                           "give numbers");
        continue;
      }
      x.push_back(a);
      y.push_back(b);
    }
    if (is_first && heading_line > 0 && !choose_by(heading, heading_line, 0, heading_line)) return;
    if (x.empty() && diagnostics_.num_errors() == errors)
      diagnostics_.error("toml.table-file", {path_}, "the table file has no pair of numbers", "give one pair per line");
  }

 private:
  void error(int line, const std::string& what, const std::string& advice) {
    diagnostics_.error("toml.table-file", {path_, line}, what, advice);
  }

  /// Chooses by a heading, if there is one, the reading with as many names as the first line has numbers.
  bool choose_by(const std::string& heading, int heading_line, std::size_t count, int line) {
    if (heading_line == 0) return choose({}, count, line);
    const auto names = split_names(heading), words = split(heading);
    const auto& taken = names.size() != count && words.size() == count ? words : names;
    return choose(taken, taken.size(), heading_line);
  }

  bool choose(const std::vector<std::string>& names, std::size_t count, int line) {
    const bool is_named = !choice_.x.empty() || !choice_.y.empty();
    // Errors in the lines of a file of two columns are reported line by line.
    count_ = is_named ? count : 2;
    x_ = 0;
    y_ = 1;
    if (!is_named) return true;
    return find(choice_.x.empty() ? "1" : choice_.x, names, line, x_) &&
           find(choice_.y.empty() ? "2" : choice_.y, names, line, y_);
  }

  bool find(const std::string& requested, const std::vector<std::string>& names, int line, std::size_t& column) {
    const auto found = std::find(names.begin(), names.end(), requested);
    if (found != names.end() && std::count(names.begin(), names.end(), requested) > 1) {
      error(line, "several columns are called '" + requested + "'", "name it by its number, from 1");
      return false;
    }
    column = static_cast<std::size_t>(found - names.begin());
    if (found != names.end()) return true;
    char* end = nullptr;
    const long number = std::strtol(requested.c_str(), &end, 10);
    if (*end == '\0' && number >= 1 && static_cast<std::size_t>(number) <= count_) {
      column = static_cast<std::size_t>(number) - 1;
      return true;
    }
    const std::string near = find_nearest(requested, names);
    std::string list;
    for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
    error(line, "there is no column '" + requested + "'",
          !near.empty()   ? "did you mean '" + near + "'?"
          : names.empty() ? "the file has " + std::to_string(count_) + " columns and no heading: give a number"
                          : "its columns are " + list);
    return false;
  }

  const std::string& path_;
  const ColumnChoice& choice_;
  Diagnostics& diagnostics_;
  std::size_t count_ = 2, x_ = 0, y_ = 1;
};

}  // namespace

void read_columns(const std::string& path, const SourceLocation& asked_at, const ColumnChoice& choice,
                  std::vector<double>& x, std::vector<double>& y, Diagnostics& diagnostics) {
  // A pipe would be waited for, a device has no end.
  std::error_code error;
  std::ifstream in;
  if (std::filesystem::is_regular_file(path, error)) in.open(path);
  if (!in.is_open()) {
    diagnostics.error("toml.table-file", asked_at, "the table file " + path + " cannot be opened",
                      "check its path, relative to this file");
    return;
  }
  note_input(path);
  Reader(path, choice, diagnostics).read(in, x, y);
}

}  // namespace bough::toml_files
