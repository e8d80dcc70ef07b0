#include <algorithm>
#include <map>
#include <set>

#include <toml++/toml.h>

#include "formats/toml/detail/source_text.hpp"
#include "formats/toml/key_editor.hpp"
#include "formats/toml/system_editor.hpp"

namespace bough::toml_files {

namespace {

using Keys = std::set<std::string>;

/// Keys, TABLE/KEY, whose text is the name of an item of the kind.
const std::map<std::string, Keys>& get_name_keys() {
  static const std::map<std::string, Keys> keys{
      {"body",
       {"hinge/parent", "hinge/child", "constraint/parent", "constraint/child", "force/body", "force/to_body",
        "force/bodies", "force/shaded_by", "sensor/body", "sensor/frame", "sensor/relative_to", "sensor/to_body",
        "sensor/terms/body", "orbit/body", "event/body", "actuator/body", "tank/body"}},
      {"tank", {"actuator/tank"}},
      {"orbit", {"hinge/parent", "constraint/parent", "sensor/frame", "sensor/relative_to"}},
      {"hinge", {"constraint/terms/hinge", "sensor/hinge", "actuator/hinge", "event/hinge"}},
      {"constraint", {"event/constraint"}},
      {"function",
       {"hinge/motion", "hinge/spring_table", "hinge/damper_table", "force/function", "force/spring_table",
        "force/damper_table", "force/density_table", "function/of", "tank/function"}},
      {"force", {"force/planet", "orbit/planet"}},
      {"controller", {"event/controller"}},
      {"body.load", {"body/modes/residual"}}};
  return keys;
}

/// Keys whose text is a signal, NAME or NAME:component, of sensors, inputs, controllers, actuators and functions.
const Keys kSignalKeys{"controller/inputs", "controller/reference", "controller/rate", "actuator/input",
                       "force/signal",      "event/signal",         "connect/from"};
const Keys kSignalKinds{"sensor", "input", "controller", "actuator", "function"};
/// connect.to goes to one of these.
const Keys kTargetKinds{"controller", "actuator", "force"};
/// Groups of the results, by kind: "/sensors/NAME" with more after it.
const std::map<std::string, std::string> kGroups{
    {"body", "bodies"},        {"hinge", "hinges"},   {"constraint", "constraints"},
    {"force", "forces"},       {"sensor", "sensors"}, {"controller", "controllers"},
    {"actuator", "actuators"}, {"input", "inputs"},   {"tank", "tanks"}};

constexpr std::string_view kOrbit = "lvlh:";

struct Use {
  std::string path;  ///< with the numbers of list entries
  const toml::node* node = nullptr;
  std::string text, renamed;
  bool is_signal = false;
};

class UseFinder {
 public:
  UseFinder(const std::string& kind, const std::string& name, const std::string& renamed)
      : kind_(kind), name_(name), renamed_(renamed) {}

  void visit(const toml::node& node, const std::string& path, const std::string& key_path) {
    if (const auto* table = node.as_table()) {
      for (const auto& [key, child] : *table) {
        const auto own = quote_key(std::string(key.str()));
        visit(child, path.empty() ? own : path + "." + own, key_path.empty() ? own : key_path + "/" + own);
      }
    } else if (const auto* list = node.as_array()) {
      int number = 0;
      for (const auto& child : *list) visit(child, path + "." + std::to_string(++number), key_path);
    } else if (const auto* word = node.as_string()) {
      Use use{path, &node, word->get(), {}, false};
      if (match(key_path, use)) uses.push_back(use);
    }
  }

  std::vector<Use> uses;

 private:
  bool match(const std::string& key_path, Use& use) const {
    const auto& text = use.text;
    if (kind_ == "parameters") {
      use.renamed = "$" + renamed_;
      return text == "$" + name_;
    }
    const auto keys = get_name_keys().find(kind_);
    if (keys != get_name_keys().end() && keys->second.count(key_path) != 0) {
      // Sensors name bodies as lvlh:BODY and BODY:NODE, hinges orbits as lvlh:ORBIT.
      const std::size_t begin = text.starts_with(kOrbit) ? kOrbit.size() : 0;
      if (starts_with_name(text, begin, key_path.starts_with("sensor/") && begin == 0 ? ":" : "")) {
        use.renamed = text.substr(0, begin) + renamed_ + text.substr(begin + name_.size());
        return true;
      }
    }
    const bool is_signal = kSignalKeys.count(key_path) != 0 && kSignalKinds.count(kind_) != 0;
    const bool is_target = key_path == "connect/to" && kTargetKinds.count(kind_) != 0;
    if ((is_signal || is_target) && starts_with_name(text, 0, ":")) {
      use.renamed = renamed_ + text.substr(name_.size());
      use.is_signal = true;
      return true;
    }
    const auto group = kGroups.find(kind_);
    if (group == kGroups.end() || (kSignalKeys.count(key_path) == 0 && key_path != "simulation/record")) return false;
    const bool has_slash = text.starts_with('/');
    if (!has_slash && key_path != "simulation/record") return false;
    const auto begin = (has_slash ? 1 : 0) + group->second.size() + 1;
    if (text.compare(has_slash ? 1 : 0, begin - (has_slash ? 1 : 0), group->second + "/") != 0) return false;
    if (!starts_with_name(text, begin, "/:")) return false;
    use.renamed = text.substr(0, begin) + renamed_ + text.substr(begin + name_.size());
    return true;
  }

  bool starts_with_name(const std::string& text, std::size_t at, const char* ends) const {
    if (at > text.size() || text.compare(at, name_.size(), name_) != 0) return false;
    const auto end = at + name_.size();
    return end == text.size() || std::string(ends).find(text[end]) != std::string::npos;
  }

  const std::string &kind_, &name_, &renamed_;
};

}  // namespace

std::vector<NameUse> find_uses(const std::string& text, const std::string& kind, const std::string& name) {
  std::vector<NameUse> found;
  try {
    const auto root = toml::parse(std::string_view(text));
    UseFinder finder(kind, name, name);
    finder.visit(root, {}, {});
    for (const auto& use : finder.uses)
      found.push_back({use.path, use.text, static_cast<int>(use.node->source().begin.line)});
  } catch (const toml::parse_error&) {
    return {};
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
  return found;
}

std::string rename_item(std::string& text, const TableItem& item, const std::string& name) {
  toml::table root;
  try {
    root = toml::parse(std::string_view(text));
  } catch (const toml::parse_error& error) {
    return std::string(error.description());
  }
  const bool is_parameter = item.kind == "parameters";
  const auto items = list_items(text);
  for (const auto& other : items) {
    if (other.kind == item.kind && other.name == name) return "there is a " + item.kind + " '" + name + "' already";
    if (is_parameter && other.kind == item.kind && std::count(other.keys.begin(), other.keys.end(), name) > 0)
      return "there is a parameter '" + name + "' already";
  }
  struct Change {
    std::size_t begin, end;
    std::string text;
  };
  std::vector<Change> changes;
  UseFinder finder(item.kind, item.name, name);
  finder.visit(root, {}, {});
  const auto* signal = static_cast<const Use*>(nullptr);
  for (const auto& use : finder.uses) {
    if (use.is_signal) signal = &use;
    const auto source = use.node->source();
    changes.push_back({find_byte(text, source.begin), find_byte(text, source.end), quote_text(use.renamed)});
  }
  for (const auto& other : items)
    if (signal != nullptr && other.name == item.name && other.kind != item.kind &&
        (kSignalKinds.count(other.kind) != 0 || (kTargetKinds.count(other.kind) != 0 && signal->path.ends_with(".to"))))
      return "the " + other.kind + " of line " + std::to_string(other.line) + " has the same name, and " +
             signal->path + " may mean either";
  if (is_parameter) {
    for (const auto& [key, child] : *root.get("parameters")->as_table())
      if (key.str() == item.name)
        changes.push_back({find_byte(text, key.source().begin), find_byte(text, key.source().end), quote_key(name)});
  } else {
    const auto path = split_path(item.path());
    toml::node* node = root.get(path[0]);
    for (std::size_t i = 1; i < path.size() && node != nullptr; ++i) {
      if (auto* list = node->as_array())
        node = find_item(*list, path[i]);
      else
        node = node->as_table()->get(path[i]);
    }
    const auto* old = node == nullptr ? nullptr : node->as_table()->get("name");
    if (old == nullptr) return "it has no name";
    changes.push_back({find_byte(text, old->source().begin), find_byte(text, old->source().end), quote_text(name)});
  }
  std::sort(changes.begin(), changes.end(), [](const auto& a, const auto& b) { return a.begin > b.begin; });
  for (const auto& change : changes) text.replace(change.begin, change.end - change.begin, change.text);
  return {};
}

}  // namespace bough::toml_files
