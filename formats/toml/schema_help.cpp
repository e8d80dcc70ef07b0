#include "formats/toml/schema_help.hpp"

#include <algorithm>
#include <functional>

#include "formats/toml/detail/schema.hpp"
#include "formats/toml/detail/schema_json.hpp"

namespace bough::toml_files {

namespace {

using json = nlohmann::json;

std::string join_words(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::vector<std::string> list_types(const json& schema) {
  if (schema.contains("enum")) return {schema["enum"][0].is_string() ? "string" : "integer"};
  if (!schema.contains("type")) return {};
  if (schema["type"].is_array()) return schema["type"].get<std::vector<std::string>>();
  return {schema["type"].get<std::string>()};
}

KeyHelp describe_key(const std::string& name, const json& schema) {
  KeyHelp help;
  help.name = name;
  const auto types = list_types(schema);
  help.type = join_words(types, " or ");
  if (schema.contains("minItems") && schema.value("maxItems", -1) == schema["minItems"].get<int>())
    help.type += " of " + std::to_string(schema["minItems"].get<int>());
  help.takes_text = std::find(types.begin(), types.end(), "string") != types.end();
  help.takes_other = types.size() > 1 || !help.takes_text;
  if (schema.contains("enum"))
    for (const auto& choice : schema["enum"])
      help.choices.push_back(choice.is_string() ? choice.get<std::string>() : choice.dump());
  if (schema.contains("minimum")) help.range = "at least " + schema["minimum"].dump();
  if (schema.contains("exclusiveMinimum")) help.range = "more than " + schema["exclusiveMinimum"].dump();
  if (schema.contains("default")) help.default_value = schema["default"].dump();
  if (const auto dims = schema.find("dims"); dims != schema.end()) {
    if (dims->is_string()) {
      help.dims = dims->get<std::string>();
    } else {
      for (const auto& [type, text] : dims->items())
        help.dims += (help.dims.empty() ? "" : "; ") + (type == "*" ? "else" : type) + " " + text.get<std::string>();
    }
  }
  help.description = schema.value("description", "");
  return help;
}

std::string write_need(const json& options) {
  std::vector<std::string> words;
  for (const auto& option : options)
    words.push_back(join_words(option.value("required", std::vector<std::string>{}), " and "));
  return "one of " + join_words(words, ", ");
}

}  // namespace

const KeyHelp* KindHelp::find(const std::string& key) const {
  const auto at = std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return k.name == key; });
  return at == keys.end() ? nullptr : &*at;
}

std::vector<KindHelp> describe_kinds(bool is_body_file) {
  const auto root = json::parse(is_body_file ? get_body_schema() : get_system_schema());
  std::vector<KindHelp> kinds;
  const std::function<void(const json&, const std::string&)> visit = [&](const json& schema, const std::string& path) {
    const auto properties = schema.value("properties", json::object());
    for (const auto& [key, reference] : properties.items()) {
      auto below = resolve_reference(reference, root);
      const auto types = list_types(below);
      const bool is_list = types == std::vector<std::string>{"array"};
      if (is_list) {
        if (!below.contains("items")) continue;
        const auto description = below.value("description", "");
        below = resolve_reference(below["items"], root);
        below["description"] = description;
      }
      if (list_types(below) != std::vector<std::string>{"object"}) continue;
      KindHelp kind;
      kind.kind = (path.empty() ? "" : path + ".") + key;
      kind.is_list = is_list;
      kind.description = below.value("description", "");
      kind.is_open = below.contains("additionalProperties") && below["additionalProperties"].is_object();
      const auto required = below.value("required", std::vector<std::string>{});
      const auto own = below.value("properties", json::object());
      for (const auto& [name, key_schema] : own.items()) {
        auto help = describe_key(name, resolve_reference(key_schema, root));
        help.is_required = std::find(required.begin(), required.end(), name) != required.end();
        kind.keys.push_back(help);
      }
      for (const char* word : {"oneOf", "anyOf"})
        if (below.contains(word)) kind.expected.push_back(write_need(below[word]));
      kinds.push_back(kind);
      if (!is_list) visit(below, kind.kind);
    }
  };
  visit(root, {});
  return kinds;
}

std::string format_help(const KeyHelp& key) {
  std::string text = "  " + key.name + ": " + key.type;
  if (!key.choices.empty()) text += ", one of " + join_words(key.choices, ", ");
  if (!key.range.empty()) text += ", " + key.range;
  if (!key.dims.empty() && key.dims != "mixed") text += " [" + key.dims + "]";
  if (key.is_required) text += ", required";
  if (!key.default_value.empty()) text += ", default " + key.default_value;
  return text + (key.description.empty() ? "" : "\n      " + key.description) + "\n";
}

std::string format_help(const KindHelp& kind) {
  std::string text =
      (kind.is_list ? "[[" : "[") + kind.kind + (kind.is_list ? "]]: " : "]: ") + kind.description + "\n";
  for (const auto& expected : kind.expected) text += "  " + expected + "\n";
  for (const auto& key : kind.keys) text += format_help(key);
  return text;
}

}  // namespace bough::toml_files
