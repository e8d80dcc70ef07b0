#include "cli/check/check_solutions.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <set>

namespace bough::cli {

namespace {

/// Datasets and groups below `group`, not deeper.
std::vector<std::string> list_children(const hdf5::FileInfo& info, const std::string& group) {
  std::set<std::string> names;
  for (const auto& object : info.objects) {
    if (object.path.rfind(group + "/", 0) != 0) continue;
    const auto rest = object.path.substr(group.size() + 1);
    names.insert(rest.substr(0, rest.find_first_of("/@")));
  }
  return {names.begin(), names.end()};
}

const hdf5::ObjectInfo* find_object(const hdf5::FileInfo& info, const std::string& path) {
  for (const auto& object : info.objects)
    if (object.path == path) return &object;
  return nullptr;
}

/// Demands the objects of a file of `static` or `matrices`; reports hdf5.missing.
void demand_objects(const std::string& path, const hdf5::FileInfo& info, const std::vector<std::string>& needed,
                    Diagnostics& diagnostics) {
  for (const auto& name : needed)
    if (!find_object(info, name))
      diagnostics.error("hdf5.missing", {path}, name + " is missing", "write the file again");
}

/// Rows of /dof_map, from its shape "18 x 2".
std::string count_dofs(const hdf5::FileInfo& info) {
  const auto* map = find_object(info, "/dof_map");
  return map ? map->shape.substr(0, map->shape.find(' ')) : "?";
}

}  // namespace

void check_static(const std::string& path, const hdf5::FileInfo& info, std::string& text, nlohmann::json& json,
                  Diagnostics& diagnostics) {
  demand_objects(path, info, {"/dof_map"}, diagnostics);
  json["kind"] = "bough-static";
  json["subcases"] = nlohmann::json::array();
  std::set<int> ids;
  for (const auto& name : list_children(info, "/subcases")) ids.insert(std::atoi(name.c_str()));
  text += fmt::format("static solutions: {} subcases on {} dofs\n", ids.size(), count_dofs(info));
  for (const int id : ids) {
    const std::string group = fmt::format("/subcases/{}", id);
    demand_objects(path, info, {group + "/displacement", group + "/reaction"}, diagnostics);
    const auto* load = find_object(info, group + "@load_set");
    const auto cards = list_children(info, group + "/elements");
    text += fmt::format("subcase {}: load set {}, forces of {}\n", id, load ? load->description : "?",
                        cards.empty() ? "no elements" : fmt::format("{}", fmt::join(cards, " ")));
    json["subcases"].push_back({{"id", id}, {"elements", cards}});
  }
}

void check_matrices(const std::string& path, const hdf5::FileInfo& info, std::string& text, nlohmann::json& json,
                    Diagnostics& diagnostics) {
  demand_objects(path, info, {"/dof_map"}, diagnostics);
  std::vector<std::string> names{"K", "M"};
  if (find_object(info, "/B/data")) names.emplace_back("B");
  for (const auto& name : list_children(info, "/KG")) names.push_back("KG/" + name);
  json["kind"] = "bough-matrices";
  json["matrices"] = names;
  text += fmt::format("matrices {} on {} dofs\n", fmt::join(names, " "), count_dofs(info));
  for (const auto& name : names)
    demand_objects(path, info,
                   {"/" + name + "/data", "/" + name + "/indices", "/" + name + "/indptr", "/" + name + "/shape"},
                   diagnostics);
}

}  // namespace bough::cli
