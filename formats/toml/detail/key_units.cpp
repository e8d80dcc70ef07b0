#include "formats/toml/detail/key_units.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "formats/toml/detail/schema.hpp"
#include "formats/toml/detail/schema_json.hpp"

namespace bough::toml_files {

namespace {

using json = nlohmann::json;

/// Component by component; a list of one stands for all.
Units combine(const Units& a, const Units& b, bool divides) {
  if (a.empty() || b.empty()) return {};
  Units all = a.size() >= b.size() ? a : Units(b.size(), a[0]);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double unit = b[b.size() == 1 ? 0 : i];
    all[i] = divides ? all[i] / unit : all[i] * unit;
  }
  return all;
}

/// One entry, as "F T^2/L".
Units calc_entry(const std::string& dims, const std::function<Units(const std::string& name)>& find) {
  std::string spaced;
  for (const char c : dims) spaced += c == '/' ? std::string(" / ") : std::string(1, c);
  std::istringstream words(spaced);
  Units all{1};
  bool divides = false;
  for (std::string word; words >> word;) {
    if (word == "/") {
      divides = true;
      continue;
    }
    if (word == "1") continue;
    const auto hat = word.find('^');
    Units units = find(word.substr(0, hat));
    if (hat != std::string::npos) {
      const std::string power = word.substr(hat + 1);
      const bool is_number = power.find_first_not_of("0123456789.") == std::string::npos;
      const Units found = is_number ? Units{std::strtod(power.c_str(), nullptr)} : find(power);
      if (found.empty()) return {};
      for (double& unit : units) unit = std::pow(unit, found[0]);
    }
    all = combine(all, units, divides);
  }
  return all;
}

Units find_base(const std::string& name, const records::UnitChange& c) {
  if (name == "M") return {c.mass};
  if (name == "L") return {c.length};
  if (name == "T") return {c.time};
  if (name == "F") return {c.calc_force()};
  if (name == "E") return {c.calc_modal()};
  return {};
}

/// Six numbers or six rows of six: forces and moments over travels and turns.
void scale_six(const UnitTable& t, const char* key, double force, double length) {
  const auto unit = [&](std::size_t i, std::size_t j) { return force * (i < 3 ? 1 : length) / (j < 3 ? length : 1); };
  const auto* list = t.table[key].as_array();
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    const auto* row = list->get(i)->as_array();
    if (row == nullptr) t.edits.scale(list->get(i), unit(i, i));
    for (std::size_t j = 0; row != nullptr && j < row->size(); ++j) t.edits.scale(row->get(j), unit(i, j));
  }
}

void scale_key(const UnitTable& t, const std::string& key, const std::string& dims, const records::UnitChange& change,
               const KeyContext& context) {
  const auto colon = dims.find(':');
  const bool is_word = dims == "angle" || dims == "mixed";
  const std::string form = is_word ? dims : colon == std::string::npos ? "" : dims.substr(0, colon);
  if (form != "factor" && !t.table.contains(key) && !t.table.contains(key + "_deg")) return;
  const auto find = [&](const std::string& name) {
    const Units base = find_base(name, change);
    return !base.empty() ? base : context.find ? context.find(name, key, t) : Units{};
  };
  const Units units = calc_units(is_word ? "1" : colon == std::string::npos ? dims : dims.substr(colon + 1), find);
  if (units.empty() || form == "mixed") return;
  const auto get_time = [&] {
    const Units step = find("step");
    return step.empty() ? change.time : step[0];
  };
  const auto* node = t.get(key.c_str());
  if (form == "angle") {
    t.scale_angles(
        key, units,
        context.list_angles ? context.list_angles(key, units.size()) : std::vector<bool>(units.size(), true));
  } else if (form == "one") {
    const bool is_one = std::all_of(units.begin(), units.end(),
                                    [&](double u) { return std::abs(u - units[0]) <= 1e-13 * std::abs(units[0]); });
    if (!is_one)
      t.error("toml.unit-signal", key.c_str(), "one number for components of several units", "make a sensor of each");
    else
      t.scale(key.c_str(), units[0]);
  } else if (form == "factor") {
    t.scale_or_add(key.c_str(), units[0]);
  } else if (form == "six") {
    scale_six(t, key.c_str(), units[0], change.length);
  } else if (form == "columns") {
    scale_columns(t, key.c_str(), units[0], context.inputs);
  } else if (form == "polynomial") {
    scale_polynomial(t, key.c_str(), units[0], get_time());
  } else if (form == "formula") {
    rewrite_formulas(t, key.c_str(), units[0], change.time, context.inputs);
  } else if (form == "list") {
    if (node->is_array()) t.scale(key.c_str(), units);
  } else if (const auto* rows = node == nullptr ? nullptr : node->as_array();
             rows != nullptr && units.size() > 1 && !rows->empty() && rows->get(0)->is_array()) {
    for (const auto& row : *rows) t.edits.scale(&row, units);
  } else {
    t.scale(key.c_str(), units);
  }
}

void scale_table(const UnitTable& t, const json& schema, const json& root, const records::UnitChange& change,
                 const KeyContext& context) {
  const std::string type = t.text("type");
  for (const auto& [key, reference] : schema.at("properties").items()) {
    if (const std::string dims = get_dims(reference, type); !dims.empty()) scale_key(t, key, dims, change, context);
    const auto* node = t.get(key.c_str());
    if (node == nullptr) continue;
    const auto below = [&](const toml::node& item, const json& item_schema, const std::string& path) {
      if (const auto* table = item.as_table(); table != nullptr && item_schema.contains("properties"))
        scale_table(UnitTable{*table, path, t.edits, t.to_radians}, item_schema, root, change, context);
    };
    const json property = resolve_reference(reference, root);
    if (const auto* list = node->as_array(); list != nullptr && property.contains("items")) {
      const json items = resolve_reference(property["items"], root);
      int number = 0;
      for (const auto& item : *list) below(item, items, t.path + "." + key + "." + std::to_string(++number));
    } else {
      below(*node, property, t.path.empty() ? key : t.path + "." + key);
    }
  }
}

}  // namespace

Units calc_units(const std::string& dims, const std::function<Units(const std::string& name)>& find) {
  Units all;
  std::istringstream entries(dims);
  for (std::string entry; std::getline(entries, entry, ',');) {
    const Units units = calc_entry(entry, find);
    if (units.empty()) return {};
    all.insert(all.end(), units.begin(), units.end());
  }
  return all;
}

json resolve_reference(const json& schema, const json& root) {
  if (!schema.contains("$ref")) return schema;
  auto whole = root.at(json::json_pointer(schema["$ref"].get<std::string>().substr(1)));
  for (const auto& [key, value] : schema.items())
    if (key != "$ref") whole[key] = value;
  return resolve_reference(whole, root);
}

std::string get_dims(const json& key, const std::string& type) {
  const auto dims = key.find("dims");
  if (dims == key.end()) return {};
  if (dims->is_string()) return dims->get<std::string>();
  return dims->value(type, dims->value("*", std::string()));
}

void scale_keys(const UnitTable& t, const std::string& kind, const records::UnitChange& change,
                const KeyContext& context) {
  static const json root = json::parse(get_system_schema());
  auto schema = resolve_reference(root.at("properties").at(kind), root);
  if (schema.contains("items")) schema = resolve_reference(schema["items"], root);
  scale_table(t, schema, root, change, context);
}

void scale_body_keys(const UnitTable& t, const records::UnitChange& change) {
  static const json root = json::parse(get_body_schema());
  scale_table(t, root, root, change, {});
}

}  // namespace bough::toml_files
