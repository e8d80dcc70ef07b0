#include "formats/records/signal_name.hpp"

#include <algorithm>

namespace bough::records {

SignalName parse_signal_name(const std::string& text) {
  SignalName name{text, ""};
  if (const auto colon = text.rfind(':'); colon != std::string::npos) {
    name.path = text.substr(0, colon);
    name.component = text.substr(colon + 1);
  }
  if (!name.path.starts_with('/')) name.path = "/sensors/" + name.path;
  return name;
}

std::vector<std::string> get_component_names(const std::string& path, int size) {
  if (size == 1) return {""};
  const auto is_of = [&](const char* kind) { return path.find(kind) != std::string::npos; };
  if (size == 3 && !is_of("/eta") && !is_of("/hinges/") && !is_of("/actuators/")) return {"x", "y", "z"};
  if (size == 4 && path.ends_with("/quaternion")) return {"w", "x", "y", "z"};
  std::vector<std::string> names;
  for (int i = 1; i <= size; ++i) names.push_back(std::to_string(i));
  return names;
}

namespace {

/// Names at the end of a description; empty: it lists none, or not one for each component.
std::vector<std::string> list_names(const std::string& path, int size, const std::string& description) {
  const auto colon = description.rfind(": ");
  const bool is_block = path.starts_with("/sensors/") || path.starts_with("/controllers/");
  std::vector<std::string> names;
  if (is_block ? colon == std::string::npos : path.find("/recovery/") == std::string::npos) return names;
  for (std::size_t at = is_block ? colon + 2 : 0; at <= description.size();) {
    const auto end = std::min(description.find(", ", at), description.size());
    names.push_back(description.substr(at, end - at));
    at = end + 2;
  }
  if (static_cast<int>(names.size()) != size) names.clear();
  return names;
}

}  // namespace

std::vector<std::string> get_component_names(const std::string& path, int size, const std::string& description) {
  const auto names = size == 1 ? std::vector<std::string>() : list_names(path, size, description);
  return names.empty() ? get_component_names(path, size) : names;
}

int find_component(const SignalName& name, int size, const std::string& description) {
  const auto names = get_component_names(name.path, size, description);
  for (int i = 0; i < size; ++i) {
    if (name.component == names[static_cast<std::size_t>(i)] || name.component == std::to_string(i + 1)) return i;
  }
  const bool is_named = size == 1 && name.path.starts_with("/controllers/");
  return is_named && list_names(name.path, size, description) == std::vector{name.component} ? 0 : -1;
}

}  // namespace bough::records
