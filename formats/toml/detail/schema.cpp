#include "formats/toml/detail/schema.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace bough::toml_files {

namespace {

using nlohmann::json;
using Kind = Value::Kind;

constexpr const char* kNamePattern = R"(^(?!\.{1,2}$)[^/\x00-\x1f\x7f]{1,1000}$)";
constexpr std::size_t kMaxLetters = 1000;

/// Length of a text as quoted in messages.
constexpr std::size_t kMaxShown = 80;
std::string quote(const std::string& s) {
  return "'" + (s.size() <= kMaxShown ? s : s.substr(0, kMaxShown) + "...") + "'";
}

std::string join(const std::vector<std::string>& words, const char* separator = ", ") {
  std::string text;
  for (const auto& w : words) text += (text.empty() ? "" : separator) + w;
  return text;
}

std::string write_number(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.10g", x);
  return buffer;
}

std::string describe_type(const std::string& type) {
  if (type == "integer") return "an integer";
  if (type == "boolean") return "true or false";
  if (type == "array") return "an array";
  if (type == "object") return "a table";
  return "a " + type;
}

bool is_of_type(const Value& v, const std::string& type) {
  switch (v.kind) {
    case Kind::String:
      return type == "string";
    case Kind::Integer:
      return type == "integer" || type == "number";
    case Kind::Float:
      return type == "number";
    case Kind::Boolean:
      return type == "boolean";
    case Kind::Array:
      return type == "array";
    case Kind::Table:
      return type == "object";
    case Kind::DateTime:
      break;
  }
  return false;
}

class Checker {
 public:
  Checker(const json& schema, const std::string& file, Diagnostics& diagnostics)
      : root_(schema), file_(file), diagnostics_(diagnostics) {}

  /// `path`: position of v in the document, "body.modes"; `line`: of its key.
  void check(const Value& v, const json& schema_or_ref, const std::string& path, int line) {
    if (schema_or_ref.contains("$ref")) {
      const std::string ref = schema_or_ref["$ref"];
      check(v, root_.at(json::json_pointer(ref.substr(1))), path, line);
      return;
    }
    const json& schema = schema_or_ref;
    if (!check_type(v, schema, path, line)) return;
    if (schema.contains("enum")) check_enum(v, schema["enum"], path, line);
    if (v.is_number()) check_number(v, schema, path, line);
    if (v.is_string()) check_pattern(v, schema, path, line);
    if (v.is_array()) check_array(v, schema, path, line);
    if (v.is_table()) check_table(v, schema, path, line);
  }

 private:
  void error(const char* id, int line, std::string what, std::string advice = {}) {
    diagnostics_.error(id, {file_, line}, std::move(what), std::move(advice));
  }

  bool check_type(const Value& v, const json& schema, const std::string& path, int line) {
    if (!schema.contains("type")) return true;
    std::vector<std::string> types;
    if (schema["type"].is_array()) {
      types = schema["type"].get<std::vector<std::string>>();
    } else {
      types.push_back(schema["type"]);
    }
    if (std::any_of(types.begin(), types.end(), [&](const auto& t) { return is_of_type(v, t); })) return true;
    std::vector<std::string> expected;
    for (const auto& t : types) expected.push_back(describe_type(t));
    std::string advice;
    if (path == "body" && types.front() == "array") advice = "a system file has [[body]]; [body] is for body files";
    if (path == "body" && types.front() == "object") advice = "a body file has [body]; [[body]] is for system files";
    error("toml.wrong-type", line, path + " is " + describe_kind(v.kind) + ", expected " + join(expected, " or "),
          advice);
    return false;
  }

  void check_enum(const Value& v, const json& choices, const std::string& path, int line) {
    std::vector<std::string> words;
    for (const auto& choice : choices) {
      if (choice.is_string()) {
        if (v.is_string() && v.text == choice.get<std::string>()) return;
        words.push_back(choice);
      } else {
        if (v.kind == Kind::Integer && v.integer == choice.get<std::int64_t>()) return;
        words.push_back(choice.dump());
      }
    }
    if (v.is_string()) {
      const std::string nearest = find_nearest(v.text, words);
      error("toml.bad-value", line, path + " is " + quote(v.text) + ", expected one of " + join(words),
            nearest.empty() ? "" : "did you mean " + quote(nearest) + "?");
    } else {
      error("toml.bad-value", line,
            path + " is " + (v.is_number() ? write_number(v.number) : describe_kind(v.kind)) + ", expected one of " +
                join(words));
    }
  }

  void check_number(const Value& v, const json& schema, const std::string& path, int line) {
    if (!std::isfinite(v.number)) {
      error("toml.nan", line, path + " is not a finite number", "give a number");
      return;
    }
    if (schema.contains("minimum") && v.number < schema["minimum"].get<double>()) {
      error("toml.out-of-range", line,
            path + " is " + write_number(v.number) + ", expected at least " +
                write_number(schema["minimum"].get<double>()));
    }
    if (schema.contains("exclusiveMinimum") && v.number <= schema["exclusiveMinimum"].get<double>()) {
      error("toml.out-of-range", line,
            path + " is " + write_number(v.number) + ", expected more than " +
                write_number(schema["exclusiveMinimum"].get<double>()));
    }
  }

  void check_pattern(const Value& v, const json& schema, const std::string& path, int line) {
    if (!schema.contains("pattern")) return;
    // The schemas have one pattern, that of names; a regular expression of the library takes a frame of the stack for
    // each letter of the text.
    BOUGH_DEMAND(schema["pattern"] == kNamePattern);
    const std::string& name = v.text;
    const bool has_control =
        std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; });
    if (name.empty() || name.find('/') != std::string::npos || name == "." || name == ".." || has_control)
      error("toml.bad-name", line,
            path + " is " + (has_control ? "a text with control characters" : quote(name)) +
                ", expected a name without a slash and not empty",
            "rename it");
    else if (name.size() > kMaxLetters)
      error("toml.bad-name", line,
            path + " has " + std::to_string(name.size()) + " letters, expected at most " + std::to_string(kMaxLetters),
            "shorten it");
  }

  void check_array(const Value& v, const json& schema, const std::string& path, int line) {
    const int size = static_cast<int>(v.items.size());
    const int min_items = schema.value("minItems", 0), max_items = schema.value("maxItems", -1);
    if (size < min_items || (max_items >= 0 && size > max_items)) {
      const std::string expected = max_items < 0 ? "at least " + std::to_string(min_items)
                                   : max_items == min_items
                                       ? std::to_string(min_items)
                                       : std::to_string(min_items) + " to " + std::to_string(max_items);
      error("toml.wrong-length", line, path + " has " + std::to_string(size) + " entries, expected " + expected);
    }
    if (!schema.contains("items")) return;
    const bool has_tables = !v.items.empty() && v.items.front().is_table();
    for (int i = 0; i < size; ++i) {
      const Value& item = v.items[static_cast<std::size_t>(i)];
      std::string item_path = path;
      const Value* name = has_tables ? item.find("name") : nullptr;
      if (name && name->is_string()) {
        item_path += " " + quote(name->text);
      } else {
        item_path += "[" + std::to_string(i + 1) + "]";
      }
      check(item, schema["items"], item_path, item.line > 0 ? item.line : line);
    }
  }

  void check_table(const Value& v, const json& schema, const std::string& path, int line) {
    check_required(v, schema, path, line);
    if (!schema.contains("properties")) return;
    const json& properties = schema["properties"];
    for (const auto& entry : v.entries) {
      const std::string child_path = path.empty() ? entry.key : path + ": " + entry.key;
      if (properties.contains(entry.key)) {
        check(entry.value, properties[entry.key], child_path, entry.line);
      } else if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object() &&
                 entry.value.is_number()) {
        check(entry.value, schema["additionalProperties"], child_path, entry.line);
      } else {
        report_unknown(entry, properties, path);
      }
    }
  }

  void report_unknown(const Entry& entry, const json& properties, const std::string& path) {
    std::vector<std::string> known;
    for (const auto& item : properties.items()) known.push_back(item.key());
    const std::string nearest = find_nearest(entry.key, known);
    std::string advice = nearest.empty() ? "known here: " + join(known) : "did you mean " + quote(nearest) + "?";
    const bool is_table = entry.value.is_table() ||
                          (entry.value.is_array() && !entry.value.items.empty() && entry.value.items[0].is_table());
    if (is_table) {
      error("toml.unknown-table", entry.line, "unknown table " + quote(entry.key) + (path.empty() ? "" : " in " + path),
            advice);
    } else {
      error("toml.unknown-key", entry.line, "unknown key " + quote(entry.key) + (path.empty() ? "" : " in " + path),
            advice);
    }
  }

  static std::vector<std::string> get_required(const json& schema) {
    return schema.value("required", std::vector<std::string>{});
  }

  static bool has_all(const Value& v, const std::vector<std::string>& keys) {
    return std::all_of(keys.begin(), keys.end(), [&](const auto& k) { return v.find(k) != nullptr; });
  }

  void check_required(const Value& v, const json& schema, const std::string& path, int line) {
    const std::string where = path.empty() ? "the file" : path;
    for (const auto& key : get_required(schema)) {
      if (v.find(key)) continue;
      const bool is_table = path.empty() || key == "modes";
      error(is_table ? "toml.missing-table" : "toml.missing-key", line,
            std::string(is_table ? "missing table " : "missing key ") + quote(key) + " in " + where, "add it");
    }
    for (const char* keyword : {"oneOf", "anyOf"}) {
      if (!schema.contains(keyword)) continue;
      std::vector<std::string> all, found;
      for (const auto& option : schema[keyword]) {
        const auto keys = get_required(option);
        all.push_back(quote(join(keys)));
        if (has_all(v, keys)) found.push_back(quote(join(keys)));
      }
      if (found.empty()) {
        error("toml.missing-key", line, "missing key in " + where + ", expected one of " + join(all),
              "add one of them");
      } else if (found.size() > 1 && keyword == std::string("oneOf")) {
        error("toml.conflicting-keys", line, join(found, " and ") + " stand together in " + where, "keep one of them");
      }
    }
    if (schema.contains("allOf")) {
      for (const auto& part : schema["allOf"]) check_not(v, part, where, line);
    }
    check_not(v, schema, where, line);
  }

  void check_not(const Value& v, const json& schema, const std::string& where, int line) {
    if (!schema.contains("not")) return;
    const auto keys = get_required(schema["not"]);
    if (!keys.empty() && has_all(v, keys)) {
      error("toml.conflicting-keys", line, quote(join(keys, "' and '")) + " stand together in " + where,
            "keep one of them");
    }
  }

  const json& root_;
  const std::string& file_;
  Diagnostics& diagnostics_;
};

/// Parsed once: the workers of a campaign read a file of the same kind for every case.
template <const char* (*get_text)()>
const json& get_parsed_once() {
  static const json parsed = json::parse(get_text());
  return parsed;
}

const json& get_parsed(const char* schema_text) {
  if (schema_text == get_body_schema()) return get_parsed_once<get_body_schema>();
  if (schema_text == get_system_schema()) return get_parsed_once<get_system_schema>();
  if (schema_text == get_psd_schema()) return get_parsed_once<get_psd_schema>();
  if (schema_text == get_budget_schema()) return get_parsed_once<get_budget_schema>();
  BOUGH_DEMAND(schema_text == get_campaign_schema());
  return get_parsed_once<get_campaign_schema>();
}

}  // namespace

void check_schema(const Value& root, const char* schema_text, const std::string& file, Diagnostics& diagnostics) {
  const json& schema = get_parsed(schema_text);
  Checker(schema, file, diagnostics).check(root, schema, "", 0);
}

}  // namespace bough::toml_files
