#include "formats/toml/detail/text_columns.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

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
    std::string line;
    bool is_first = true;
    for (int number = 1; std::getline(in, line); ++number) {
      line.erase(std::find(line.begin(), line.end(), '#'), line.end());
      const auto words = split(line);
      if (words.empty()) continue;
      std::vector<double> numbers;
      const bool all_numbers = read_numbers(words, numbers);
      if (is_first) {
        is_first = false;
        const std::vector<std::string> none;
        if (!choose(all_numbers ? none : words, words.size(), number)) return;
        if (!all_numbers) continue;
      }
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
    if (x.empty())
      diagnostics_.error("toml.table-file", {path_}, "the table file has no pair of numbers", "give one pair per line");
  }

 private:
  void error(int line, const std::string& what, const std::string& advice) {
    diagnostics_.error("toml.table-file", {path_, line}, what, advice);
  }

  bool choose(const std::vector<std::string>& names, std::size_t count, int line) {
    const bool is_named = !choice_.x.empty() || !choice_.y.empty();
    // What is wrong with the lines of a file of two columns is said line by line.
    count_ = is_named ? count : 2;
    x_ = 0;
    y_ = 1;
    if (!is_named) return true;
    return find(choice_.x.empty() ? "1" : choice_.x, names, line, x_) &&
           find(choice_.y.empty() ? "2" : choice_.y, names, line, y_);
  }

  bool find(const std::string& wanted, const std::vector<std::string>& names, int line, std::size_t& column) {
    const auto found = std::find(names.begin(), names.end(), wanted);
    if (found != names.end() && std::count(names.begin(), names.end(), wanted) > 1) {
      error(line, "several columns are called '" + wanted + "'", "name it by its number, from 1");
      return false;
    }
    column = static_cast<std::size_t>(found - names.begin());
    if (found != names.end()) return true;
    char* end = nullptr;
    const long number = std::strtol(wanted.c_str(), &end, 10);
    if (*end == '\0' && number >= 1 && static_cast<std::size_t>(number) <= count_) {
      column = static_cast<std::size_t>(number) - 1;
      return true;
    }
    const std::string near = find_nearest(wanted, names);
    std::string list;
    for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
    error(line, "there is no column '" + wanted + "'",
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
  Reader(path, choice, diagnostics).read(in, x, y);
}

}  // namespace bough::toml_files
