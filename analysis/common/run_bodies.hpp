#pragma once
/// \file Bodies of a run that is over: their files, and the points of rigid ones.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/system_spec.hpp"

namespace bough::analysis {

/// The file of that name and SHA-256 (`source` of the run) among `files`, next to the results or here; empty, and why,
/// without.
std::string find_body_file(const std::string& written, const std::string& results,
                           const std::vector<std::string>& files,
                           const std::vector<std::pair<std::string, std::string>>& source, std::string& why);

/// In B; the origin for a node that the body does not have.
Eigen::Vector3d find_rigid_node(const records::BodyRecord& body, int id);

/// Points of a rigid body's picture, in B: nodes of its hinges, and its own nodes.
std::vector<Eigen::Vector3d> list_rigid_points(const records::SystemSpec& spec, const records::BodyRecord& body);

}  // namespace bough::analysis
