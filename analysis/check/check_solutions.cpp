#include "analysis/check/check_solutions.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <set>

namespace bough::analysis {

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

StaticCheck check_static(const std::string& path, const hdf5::FileInfo& info, Diagnostics& diagnostics) {
  demand_objects(path, info, {"/dof_map"}, diagnostics);
  StaticCheck check;
  check.num_dofs = count_dofs(info);
  std::set<int> ids;
  for (const auto& name : list_children(info, "/subcases")) ids.insert(std::atoi(name.c_str()));
  for (const int id : ids) {
    const std::string group = fmt::format("/subcases/{}", id);
    demand_objects(path, info, {group + "/displacement", group + "/reaction"}, diagnostics);
    const auto* load = find_object(info, group + "@load_set");
    check.subcases.push_back({id, load ? load->description : "?", list_children(info, group + "/elements")});
  }
  return check;
}

MatricesCheck check_matrices(const std::string& path, const hdf5::FileInfo& info, Diagnostics& diagnostics) {
  demand_objects(path, info, {"/dof_map"}, diagnostics);
  MatricesCheck check{count_dofs(info), {"K", "M"}};
  if (find_object(info, "/B/data")) check.names.emplace_back("B");
  for (const auto& name : list_children(info, "/KG")) check.names.push_back("KG/" + name);
  for (const auto& name : check.names)
    demand_objects(path, info,
                   {"/" + name + "/data", "/" + name + "/indices", "/" + name + "/indptr", "/" + name + "/shape"},
                   diagnostics);
  return check;
}

}  // namespace bough::analysis
