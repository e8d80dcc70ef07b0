#include <algorithm>

#include "analysis/edit/body_nodes.hpp"
#include "analysis/edit/edit_session.hpp"

namespace bough::analysis {

using toml_files::KindHelp;

namespace {

const KindHelp* find(const std::vector<KindHelp>& kinds, const std::string& name) {
  const auto at = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.kind == name; });
  return at == kinds.end() ? nullptr : &*at;
}

/// Choices of an enum, true and false.
std::vector<std::string> list_values(const KindHelp& kind, const std::string& key) {
  const auto* help = kind.find(key);
  if (help == nullptr) return {};
  if (help->type == "boolean") return {"true", "false"};
  return help->choices;
}

/// The key whose body a key of nodes is of: "node" -> "body", "parent_node" -> "parent"; empty for other keys.
std::string get_body_key(const std::string& key) {
  if (key == "node") return "body";
  if (key == "to_node") return "to_body";
  return key == "parent_node" || key == "child_node" ? key.substr(0, key.find('_')) : "";
}

}  // namespace

std::vector<std::string> EditSession::complete(const std::string& line) const {
  const auto& kinds = text_.get_kinds();
  const auto items = toml_files::list_items(text_.get_text());
  const auto begin = line.find_last_of(" \t");
  const auto word = begin == std::string::npos ? line : line.substr(begin + 1);
  const auto first = line.find_first_not_of(" \t");
  if (first == std::string::npos || line.find_first_of(" \t", first) == std::string::npos) {
    auto commands = list_commands();
    std::erase_if(commands, [&](const auto& c) { return !c.starts_with(word); });
    return commands;
  }
  const auto command = line.substr(first, line.find_first_of(" \t", first) - first);
  const auto second = line.find_first_not_of(" \t", first + command.size());
  const bool is_second = second == std::string::npos || line.find_first_of(" \t", second) == std::string::npos;
  const auto argument =
      second == std::string::npos ? "" : line.substr(second, line.find_first_of(" \t", second) - second);

  std::vector<std::string> offered;
  const auto add_kinds = [&] {
    for (const auto& kind : kinds) offered.push_back(kind.kind);
  };
  const auto add_names = [&](const std::string& end) {
    for (const auto& item : items) offered.push_back((item.name.empty() ? item.path() : item.name) + end);
  };
  // Words after "key=": choices, and the names that keys of other tables hold.
  const auto add_values = [&](const KindHelp& kind, const std::string& before, const std::string& key) {
    for (const auto& value : list_values(kind, key)) offered.push_back(before + value);
    for (const auto& item : items) {
      const bool is_name = (item.kind == "body" && (key == "parent" || key == "child" || key.ends_with("body"))) ||
                           (item.kind == key) || (item.kind == "function" && key == "motion");
      const bool is_signal = (key == "signal" || key == "input" || key == "inputs" || key == "from") &&
                             (item.kind == "sensor" || item.kind == "controller" || item.kind == "actuator");
      if ((is_name || is_signal) && !item.name.empty()) offered.push_back(before + item.name);
    }
  };
  const auto add_nodes = [&](const std::string& before, const std::string& body) {
    for (const auto& id : list_body_nodes(text_.get_text(), text_.get_file(), body)) offered.push_back(before + id);
  };
  // Value of a key earlier in the line: "... body=boom node=".
  const auto find_given = [&](const std::string& key) -> std::string {
    const auto at = line.find(" " + key + "=");
    if (at == std::string::npos) return {};
    const auto from = at + key.size() + 2;
    return line.substr(from, line.find_first_of(" \t", from) - from);
  };
  const auto equals = word.find('=');
  if (command == "list" || (command == "add" && is_second)) {
    add_kinds();
  } else if (command == "add") {
    if (const auto* kind = find(kinds, argument)) {
      const auto body_key = equals == std::string::npos ? "" : get_body_key(word.substr(0, equals));
      if (!body_key.empty())
        add_nodes(word.substr(0, equals + 1), find_given(body_key));
      else if (equals != std::string::npos)
        add_values(*kind, word.substr(0, equals + 1), word.substr(0, equals));
      else
        for (const auto& key : kind->keys) offered.push_back(key.name + "=");
    }
  } else if (command == "set" || command == "change" || command == "unset" || command == "show") {
    const auto path = word.substr(0, equals);
    for (const auto& item : items) {
      const auto* kind = find(kinds, item.kind);
      for (const auto& name : {item.name, item.path(), item.kind + "." + item.name}) {
        if (kind == nullptr || name.empty() || !path.starts_with(name + ".")) continue;
        const auto key = path.substr(name.size() + 1);
        if (const auto body_key = get_body_key(key); equals != std::string::npos && !body_key.empty()) {
          const auto body = toml_files::get_value_text(text_.get_text(), item.path() + "." + body_key);
          if (body.size() > 2) add_nodes(word.substr(0, equals + 1), body.substr(1, body.size() - 2));
        } else if (equals != std::string::npos) {
          add_values(*kind, word.substr(0, equals + 1), key);
        } else if (command == "set" || command == "change") {
          for (const auto& help : kind->keys) offered.push_back(name + "." + help.name + "=");
        } else {
          for (const auto& own : item.keys) offered.push_back(name + "." + own);
        }
      }
    }
    if (path.find('.') == std::string::npos) add_names(command == "show" ? "" : ".");
  } else if (command == "delete" || command == "rename" || command == "copy") {
    if (is_second) add_names("");
  } else if (command == "help") {
    offered = list_commands();
    add_kinds();
    for (const auto& kind : kinds)
      for (const auto& key : kind.keys) offered.push_back(key.name);
  }
  std::erase_if(offered, [&](const auto& o) { return !o.starts_with(word); });
  std::sort(offered.begin(), offered.end());
  offered.erase(std::unique(offered.begin(), offered.end()), offered.end());
  return offered;
}

}  // namespace bough::analysis
