#include "formats/toml/detail/function_table.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>

#include "formats/toml/detail/text_columns.hpp"

namespace bough::toml_files {
namespace {

/// MATLAB and HDF5 files are known by their first bytes; they are read where the libraries for them are.
bool is_binary_table(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return false;
  std::ifstream in(path, std::ios::binary);
  char start[8] = {};
  in.read(start, sizeof start);
  const std::string_view text(start, static_cast<std::size_t>(in.gcount()));
  return text.starts_with("\x89HDF") || text.starts_with("MATLAB");
}

void read_values(const Fields& fields, const std::string& path, records::FunctionRecord& function,
                 Diagnostics& diagnostics) {
  for (const auto& entry : fields.entries()) {
    if (!entry.value.is_number()) continue;
    const std::string suffix = "_deg";
    const bool in_degrees = entry.key.size() > suffix.size() && entry.key.ends_with(suffix);
    const std::string key = in_degrees ? entry.key.substr(0, entry.key.size() - suffix.size()) : entry.key;
    if (entry.key == "phase") check_radians(fields, key, {entry.value.number}, diagnostics);
    const bool is_new =
        function.values.emplace(key, entry.value.number * (in_degrees ? std::numbers::pi / 180 : 1)).second;
    if (!is_new) {
      diagnostics.error("toml.conflicting-keys", {path, entry.line},
                        "'" + key + "' and '" + key + "_deg' stand together in function '" + function.name + "'",
                        "keep one of them");
    }
  }
}

void read_table(const Fields& fields, const std::string& path, records::FunctionRecord& function,
                Diagnostics& diagnostics) {
  const std::string name = "function '" + function.name + "'";
  if (!fields.has("file")) {
    refuse_keys(fields, {"time_column", "column"}, "in " + name + ", whose points are in this file", diagnostics);
    for (const char* key : {"x", "y"}) {
      if (fields.has(key)) continue;
      diagnostics.error("toml.missing-key", function.at, "missing key '" + std::string(key) + "' in " + name,
                        "give x and y, or file");
    }
    if (fields.has("x") && fields.has("y") && function.x.size() != function.y.size()) {
      diagnostics.error("toml.wrong-length", fields.locate("y"),
                        name + ": y has " + std::to_string(function.y.size()) + " entries, expected " +
                            std::to_string(function.x.size()) + " as x");
    }
    return;
  }
  refuse_keys(fields, {"x", "y"}, "in " + name + ", which is read from a file", diagnostics);
  if (fields.get_string("file").empty()) return;
  function.x.clear();
  function.y.clear();
  function.file = resolve_path(path, fields.get_string("file"));
  if (!is_binary_table(function.file)) {
    read_columns(function.file, fields.locate("file"), {function.time_column, function.column}, function.x, function.y,
                 diagnostics);
    return;
  }
  for (const char* key : {"time_column", "column"}) {
    if (fields.has(key)) continue;
    diagnostics.error("toml.missing-key", function.at, "missing key '" + std::string(key) + "' in " + name,
                      "a MATLAB or HDF5 file has no first column: name what to take, as \"/time\" or \"thrust:2\"");
  }
}

}  // namespace

records::FunctionRecord read_function(const Fields& fields, const std::string& path, Diagnostics& diagnostics) {
  records::FunctionRecord function;
  function.at = fields.locate();
  function.name = fields.get_string("name");
  function.type = fields.get_string("type");
  function.interpolation = fields.get_string("interpolation", "linear");
  function.law = fields.get_string("law", "logarithmic");
  function.time_column = fields.get_string("time_column");
  function.column = fields.get_string("column");
  function.expression = fields.get_string("expression");
  const bool is_expression = function.type == "expression";
  if (is_expression) {
    function.first = fields.get_string("rate");
    function.second = fields.get_string("acceleration");
  }
  function.of = fields.get_strings("of");
  function.weights = fields.get_numbers("weights");
  function.x = fields.get_numbers("x");
  function.y = fields.get_numbers("y");
  read_values(fields, path, function, diagnostics);
  // Types with text or list keys; numbers are checked when the function is made.
  static const std::map<std::string, std::vector<std::string>> owners = {
      {"x", {"table", "expression", "harmonics", "random"}},
      {"y", {"table", "harmonics", "random"}},
      {"file", {"table", "random"}},
      {"time_column", {"table", "random"}},
      {"column", {"table", "random"}},
      {"interpolation", {"table", "random"}},
      {"law", {"sweep"}},
      {"expression", {"expression"}},
      {"acceleration", {"expression"}},
      {"of", {"sum", "product"}},
      {"weights", {"sum"}},
  };
  for (const auto& [key, types] : owners) {
    if (std::find(types.begin(), types.end(), function.type) != types.end()) continue;
    refuse_keys(fields, {key.c_str()}, "in function '" + function.name + "', whose type is " + function.type,
                diagnostics);
  }
  if (const Value* rate = fields.find("rate"); rate && rate->is_string() != is_expression)
    diagnostics.error("toml.wrong-type", fields.locate("rate"),
                      "'rate' of function '" + function.name + "' is not a " + (is_expression ? "formula" : "number"),
                      is_expression ? "give the derivative of the expression, as a text" : "give a number");
  if (function.type == "table" || function.type == "random") read_table(fields, path, function, diagnostics);
  return function;
}

}  // namespace bough::toml_files
