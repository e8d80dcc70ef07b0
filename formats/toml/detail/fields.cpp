#include "formats/toml/detail/fields.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>

namespace bough::toml_files {

namespace {
int to_int(std::int64_t value) {
  constexpr std::int64_t kMax = std::numeric_limits<int>::max();
  return static_cast<int>(std::max(-kMax, std::min(kMax, value)));
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

namespace {

/// Values of a key that is a value or a list: take(value) is nothing for values of another type, which are left out.
template <class Take>
auto collect(const Value* value, const Take& take) {
  std::vector<typename decltype(take(*value))::value_type> found;
  if (!value) return found;
  if (const auto one = take(*value)) found.push_back(*one);
  for (const Value& item : value->items)
    if (const auto one = take(item)) found.push_back(*one);
  return found;
}

}  // namespace

std::vector<double> Fields::get_numbers(const std::string& key) const {
  return collect(table_.find(key),
                 [](const Value& v) { return v.is_number() ? std::optional(v.number) : std::nullopt; });
}

std::vector<int> Fields::get_ints(const std::string& key) const {
  return collect(table_.find(key), [](const Value& v) {
    return v.kind == Value::Kind::Integer ? std::optional(to_int(v.integer)) : std::nullopt;
  });
}

std::vector<std::string> Fields::get_strings(const std::string& key) const {
  return collect(table_.find(key), [](const Value& v) { return v.is_string() ? std::optional(v.text) : std::nullopt; });
}

std::vector<Eigen::Vector3d> Fields::get_vectors(const std::string& key) const {
  return collect(table_.find(key), [](const Value& row) {
    if (row.items.size() != 3 || !row.items[0].is_number()) return std::optional<Eigen::Vector3d>();
    return std::optional(Eigen::Vector3d(row.items[0].number, row.items[1].number, row.items[2].number));
  });
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

void check_radians(const Fields& table, const std::string& key, const std::vector<double>& angles,
                   Diagnostics& diagnostics) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const auto large = std::find_if(angles.begin(), angles.end(), [](double a) { return std::abs(a) > kTurn + 1e-9; });
  if (large == angles.end()) return;
  std::ostringstream what;
  what << "angle " << *large << " in " << key << " is more than one turn: the unit is rad, this is "
       << *large * 180 / std::numbers::pi << " degrees";
  diagnostics.warning("toml.large-angle", table.locate(key), what.str(),
                      "write " + key + "_deg for an angle in degrees");
}

Eigen::Matrix3d read_rotation(const Fields& table, const std::string& key, Diagnostics& diagnostics) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  Vector3d angles = table.get_vector(key, Vector3d::Zero());
  if (table.has(key))
    check_radians(table, key, {angles.begin(), angles.end()}, diagnostics);
  else
    angles = table.get_vector(key + "_deg", Vector3d::Zero()) * (std::numbers::pi / 180);
  return (AngleAxisd(angles.x(), Vector3d::UnitX()) * AngleAxisd(angles.y(), Vector3d::UnitY()) *
          AngleAxisd(angles.z(), Vector3d::UnitZ()))
      .toRotationMatrix();
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

}  // namespace bough::toml_files
