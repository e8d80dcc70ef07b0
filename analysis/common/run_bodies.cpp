#include "analysis/common/run_bodies.hpp"

#include <filesystem>

#include "analysis/common/system_files.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

std::string find_body_file(const std::string& written, const std::string& results,
                           const std::vector<std::string>& files,
                           const std::vector<std::pair<std::string, std::string>>& source, std::string& why) {
  std::string expected;
  for (const auto& [name, hash] : source)
    if (fs::path(name).filename() == fs::path(written).filename()) expected = hash;
  std::vector<std::string> places = files;
  std::string folder;
  if (!source.empty()) folder = fs::path(source.front().first).parent_path().string();
  for (const auto& place : {resolve_beside(results, written), (fs::path(folder) / written).string(),
                            resolve_beside(results, (fs::path(folder) / written).string()),
                            resolve_beside(results, fs::path(written).filename().string()), written})
    places.push_back(place);
  bool is_other = false;
  for (const auto& place : places) {
    std::error_code failed;
    if (!fs::is_regular_file(place, failed) || place == results) continue;
    if (!expected.empty() && hdf5::calc_sha256(place) != expected) {
      is_other = is_other || fs::path(place).filename() == fs::path(written).filename();
      continue;
    }
    if (!expected.empty() || fs::path(place).filename() == fs::path(written).filename()) return place;
  }
  why = is_other ? written + " is not the file that the run was started with"
                 : written + " is not here; name it after the results file";
  return {};
}

Eigen::Vector3d find_rigid_node(const records::BodyRecord& body, int id) {
  for (const auto& node : body.nodes)
    if (node.id == id) return node.p;
  return Eigen::Vector3d::Zero();
}

std::vector<Eigen::Vector3d> list_rigid_points(const records::SystemSpec& spec, const records::BodyRecord& body) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& node : body.nodes) points.push_back(node.p);
  for (const auto& hinge : spec.hinges) {
    if (hinge.parent == body.name) points.push_back(find_rigid_node(body, hinge.parent_node) + hinge.parent_position);
    if (hinge.child == body.name) points.push_back(find_rigid_node(body, hinge.child_node) + hinge.child_position);
  }
  return points;
}

}  // namespace bough::analysis
