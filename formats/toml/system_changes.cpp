#include <algorithm>
#include <set>

#include "formats/toml/detail/value.hpp"
#include "formats/toml/specs.hpp"

namespace bough::toml_files {

namespace {

std::string write(const Value& v) {
  switch (v.kind) {
    case Value::Kind::String:
      return "\"" + v.text + "\"";
    case Value::Kind::Boolean:
      return v.boolean ? "true" : "false";
    case Value::Kind::Integer:
      return std::to_string(v.integer);
    case Value::Kind::Float: {
      char buffer[32];
      std::snprintf(buffer, sizeof buffer, "%.12g", v.number);
      return buffer;
    }
    case Value::Kind::Array: {
      std::string text;
      for (const auto& item : v.items) text += (text.empty() ? "" : ", ") + write(item);
      return text.size() > 60 ? "[...]" : "[" + text + "]";
    }
    default:
      return describe_kind(v.kind);
  }
}

class Comparison {
 public:
  Comparison(std::string file, Diagnostics& diagnostics) : file_(std::move(file)), diagnostics_(diagnostics) {}

  void compare_tables(const Value& before, const Value& after, const std::string& path, int line) {
    for (const auto& entry : after.entries) {
      if (is_free(path, entry.key)) continue;
      const Value* old = before.find(entry.key);
      const std::string name = join(path, entry.key);
      if (!old)
        report(entry.line, name + " was not there when the run was started");
      else
        compare(*old, entry.value, name, entry.line);
    }
    for (const auto& entry : before.entries) {
      if (!is_free(path, entry.key) && !after.find(entry.key))
        report(line, join(path, entry.key) + " was there when the run was started");
    }
  }

 private:
  /// Keys that may change for the rest of a run: its end, its samples, its limits.
  static bool is_free(const std::string& path, const std::string& key) {
    static const std::set<std::string> free = {"duration",     "output_step",      "output_from",       "output_until",
                                               "output_every", "divergence_limit", "energy_error_limit"};
    return path == "simulation" && free.count(key) > 0;
  }

  static std::string join(const std::string& path, const std::string& key) {
    return path.empty() ? key : path + ": " + key;
  }

  static bool is_list_of_tables(const Value& v) { return v.is_array() && !v.items.empty() && v.items[0].is_table(); }

  void compare(const Value& before, const Value& after, const std::string& path, int line) {
    if (before.is_table() && after.is_table()) {
      compare_tables(before, after, path, line);
    } else if (is_list_of_tables(before) && is_list_of_tables(after)) {
      compare_lists(before, after, path, line);
    } else if (!is_same(before, after)) {
      report(line, path + " is " + write(after) + ", was " + write(before) + " when the run was started");
    }
  }

  /// Tables are identified by their names; without names by their position.
  void compare_lists(const Value& before, const Value& after, const std::string& path, int line) {
    const auto get_name = [](const Value& table, std::size_t i) {
      const Value* name = table.find("name");
      return name && name->is_string() ? "'" + name->text + "'" : std::to_string(i + 1);
    };
    std::set<std::string> seen;
    for (std::size_t i = 0; i < after.items.size(); ++i) {
      const Value& item = after.items[i];
      const std::string name = get_name(item, i);
      seen.insert(name);
      const Value* old = nullptr;
      for (std::size_t j = 0; j < before.items.size(); ++j) {
        if (get_name(before.items[j], j) == name) old = &before.items[j];
      }
      const int at = item.line > 0 ? item.line : line;
      if (!old)
        report(at, path + " " + name + " was not there when the run was started");
      else
        compare_tables(*old, item, path + " " + name, at);
    }
    for (std::size_t j = 0; j < before.items.size(); ++j) {
      if (const std::string name = get_name(before.items[j], j); !seen.count(name))
        report(line, path + " " + name + " was there when the run was started");
    }
  }

  static bool is_same(const Value& a, const Value& b) {
    if (a.is_number() && b.is_number()) return a.number == b.number;
    if (a.kind != b.kind) return false;
    if (a.is_string()) return a.text == b.text;
    if (a.kind == Value::Kind::Boolean) return a.boolean == b.boolean;
    if (a.is_table()) {
      return a.entries.size() == b.entries.size() &&
             std::all_of(a.entries.begin(), a.entries.end(), [&](const auto& e) {
               const Value* other = b.find(e.key);
               return other && is_same(e.value, *other);
             });
    }
    return std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), is_same);
  }

  void report(int line, const std::string& what) {
    diagnostics_.error("toml.changed", {file_, line}, what,
                       "resume with the file as it was (/system of the results holds it), or start the run again");
  }

  std::string file_;
  Diagnostics& diagnostics_;
};

}  // namespace

void check_same_system(const std::string& before, const std::string& after, const std::string& path,
                       Diagnostics& diagnostics) {
  Value old, now;
  Diagnostics ignored;
  // Errors of the text in the results are ignored: it was valid once, and a damaged file is reported elsewhere.
  if (!parse_toml(before, path, old, ignored) || !parse_toml(after, path, now, diagnostics)) return;
  Comparison(path, diagnostics).compare_tables(old, now, "", 1);
}

}  // namespace bough::toml_files
