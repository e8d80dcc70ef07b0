#include "formats/toml/detail/fields.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace bough::toml_files {

namespace {
int to_int(std::int64_t value) {
  constexpr std::int64_t kMost = std::numeric_limits<int>::max();
  return static_cast<int>(std::max(-kMost, std::min(kMost, value)));
}
}  // namespace

SourceLocation Fields::locate(const std::string& key) const {
  for (const auto& entry : table_.entries) {
    if (entry.key == key) return {file_, entry.line};
  }
  return locate();
}

std::string Fields::get_string(const std::string& key, const std::string& otherwise) const {
  const Value* v = table_.find(key);
  return v && v->is_string() ? v->text : otherwise;
}

int Fields::get_int(const std::string& key, int otherwise) const {
  const Value* v = table_.find(key);
  return v && v->kind == Value::Kind::Integer ? to_int(v->integer) : otherwise;
}

double Fields::get_number(const std::string& key, double otherwise) const {
  return get_number(key).value_or(otherwise);
}

std::optional<double> Fields::get_number(const std::string& key) const {
  const Value* v = table_.find(key);
  if (v && v->is_number()) return v->number;
  return std::nullopt;
}

bool Fields::get_bool(const std::string& key, bool otherwise) const {
  const Value* v = table_.find(key);
  return v && v->kind == Value::Kind::Boolean ? v->boolean : otherwise;
}

Eigen::Vector3d Fields::get_vector(const std::string& key, const Eigen::Vector3d& otherwise) const {
  const std::vector<double> x = get_numbers(key);
  return x.size() == 3 ? Eigen::Vector3d(x[0], x[1], x[2]) : otherwise;
}

std::vector<double> Fields::get_numbers(const std::string& key) const {
  std::vector<double> numbers;
  const Value* v = table_.find(key);
  if (!v) return numbers;
  if (v->is_number()) numbers.push_back(v->number);
  for (const Value& item : v->items) {
    if (item.is_number()) numbers.push_back(item.number);
  }
  return numbers;
}

std::vector<int> Fields::get_ints(const std::string& key) const {
  std::vector<int> numbers;
  const Value* v = table_.find(key);
  if (!v) return numbers;
  if (v->kind == Value::Kind::Integer) numbers.push_back(to_int(v->integer));
  for (const Value& item : v->items) {
    if (item.kind == Value::Kind::Integer) numbers.push_back(to_int(item.integer));
  }
  return numbers;
}

std::vector<std::string> Fields::get_strings(const std::string& key) const {
  std::vector<std::string> words;
  const Value* v = table_.find(key);
  if (!v) return words;
  if (v->is_string()) words.push_back(v->text);
  for (const Value& item : v->items) {
    if (item.is_string()) words.push_back(item.text);
  }
  return words;
}

std::vector<Fields> Fields::get_tables(const std::string& key) const {
  std::vector<Fields> tables;
  const Value* v = table_.find(key);
  if (!v) return tables;
  for (const Value& item : v->items) {
    if (item.is_table()) tables.emplace_back(item, file_);
  }
  return tables;
}

Fields Fields::get_table(const std::string& key) const {
  static const Value empty;
  const Value* v = table_.find(key);
  return Fields(v && v->is_table() ? *v : empty, file_);
}

void refuse_keys(const Fields& table, std::initializer_list<const char*> keys, const std::string& because,
                 Diagnostics& diagnostics) {
  for (const char* key : keys) {
    if (!table.has(key)) continue;
    diagnostics.error("toml.conflicting-keys", table.locate(key),
                      "'" + std::string(key) + "' has no meaning " + because, "remove it");
  }
}

std::string resolve_path(const std::string& file, const std::string& path) {
  if (path.empty()) return path;
  return (std::filesystem::absolute(file).parent_path() / path).lexically_normal().string();
}

std::string get_stem(const std::string& file) { return std::filesystem::path(file).stem().string(); }

void read_two_columns(const std::string& path, const SourceLocation& asked_at, std::vector<double>& x,
                      std::vector<double>& y, Diagnostics& diagnostics) {
  std::error_code error;
  std::ifstream in(path);
  if (!in || std::filesystem::is_directory(path, error)) {
    diagnostics.error("toml.table-file", asked_at, "the table file " + path + " cannot be opened",
                      "check its path, relative to this file");
    return;
  }
  std::string line;
  bool may_be_heading = true;
  for (int number = 1; std::getline(in, line); ++number) {
    line.erase(std::find(line.begin(), line.end(), '#'), line.end());
    for (char& c : line) {
      if (c == ',' || c == ';' || c == '\t' || c == '\r') c = ' ';
    }
    std::istringstream words(line);
    std::vector<double> numbers;
    std::string word;
    bool all_numbers = true;
    while (words >> word) {
      char* end = nullptr;
      numbers.push_back(std::strtod(word.c_str(), &end));
      all_numbers = all_numbers && *end == '\0';
    }
    if (numbers.empty()) continue;
    const bool is_heading = may_be_heading && !all_numbers;
    may_be_heading = false;
    if (is_heading) continue;
    if (!all_numbers || numbers.size() != 2) {
      diagnostics.error("toml.table-file", {path, number},
                        all_numbers ? "the line has " + std::to_string(numbers.size()) + " numbers, expected 2"
                                    : "the line is not two numbers",
                        "give one pair per line");
      continue;
    }
    if (!std::isfinite(numbers[0]) || !std::isfinite(numbers[1])) {
      diagnostics.error("toml.nan", {path, number}, "the line has a value that is not a finite number", "give numbers");
      continue;
    }
    x.push_back(numbers[0]);
    y.push_back(numbers[1]);
  }
  if (x.empty()) {
    diagnostics.error("toml.table-file", {path}, "the table file has no pair of numbers", "give one pair per line");
  }
}

}  // namespace bough::toml_files
