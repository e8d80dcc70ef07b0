#include "analysis/info/info.hpp"

#include "analysis/common/body_files.hpp"
#include "formats/flat/flex_body.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/hdf5/layouts.hpp"

namespace bough::analysis {

namespace {

/// The blocks of a .FLX by the names that flx --read --json gives them; of several bodies below /ID.
hdf5::FileInfo read_flx_info(const std::string& name) {
  const auto parsed = flx::parse_flx_name(name).value_or(flx::FlxName{});
  hdf5::FileInfo info;
  std::string ids;
  for (const auto& file : flx::read_flx_bodies(parsed.path)) {
    if (parsed.body_id > 0 && parsed.body_id != file.body_id) continue;
    ids += (ids.empty() ? "" : ", ") + std::to_string(file.body_id);
    const std::string at = "/" + std::to_string(file.body_id) + "/";
    const auto n = std::to_string(file.num_modes());
    const auto add = [&](const char* block, const std::string& shape, const char* about) {
      info.objects.push_back({at + block, shape, "number", about, ""});
    };
    info.objects.push_back({at + "name", "scalar", "text", file.name, ""});
    add("modopt", "scalar", "0 all integrals, 1 without second order, 2 zero order only");
    add("mass", "scalar", "of the body");
    add("generalized_mass", n + " x " + n, "modal mass");
    add("generalized_stiffness", n + " x " + n, "modal stiffness");
    add("generalized_damping", n + " x " + n, "modal damping");
    add("gamma0", n + " x 3", "integral, alpha times the mass");
    add("gamma1", n + " x 3", "integral");
    if (file.has_gamma23()) add("gamma2", n + " x " + n + " x 3", "integral");
    if (file.has_gamma23()) add("gamma3", n + " x 3 x 3", "integral");
    if (file.has_gamma4()) add("gamma4", n + " x " + n + " x 3 x 3", "integral");
    add("nodes", std::to_string(file.node_id.size()), "output nodes");
    add("gains", std::to_string(file.gains.size()) + " x 6 x " + n, "translations and rotations of the modes there");
    add("special_nodes", std::to_string(file.special_id.size()), "for the controller of geometric stiffness");
    if (file.has_rigid) add("cg", "3", "centre of mass from the body origin");
    if (file.has_rigid) add("inertia", "3 x 3", "about the body origin");
    if (!file.has_stiffening) continue;
    add("kg_inertial", "12 x " + n + " x " + n, "K_G1");
    add("kg_external", std::to_string(file.more.locators.size()) + " x " + n + " x " + n, "K_G2");
  }
  if (info.objects.empty()) flx::read_flx(parsed.path, parsed.body_id);  // says which there are
  info.attributes = {{"format", "FLX"}, {"bodies", ids}};
  return info;
}

hdf5::FileInfo read_flat_info(const std::string& path) {
  hdf5::FileInfo info;
  info.attributes = {{"format", "bough-flat"}};
  for (const auto& array : flat::list_arrays(path)) {
    std::string shape;
    for (const long size : array.shape) shape += (shape.empty() ? "" : " x ") + std::to_string(size);
    info.objects.push_back({array.name, shape.empty() ? "scalar" : shape, array.type, array.text, ""});
    if (array.name == "/name") info.attributes["name"] = array.text;
  }
  return info;
}

}  // namespace

InfoAnswer list_contents(const std::string& file) {
  demand_body_file(file);
  InfoAnswer answer;
  answer.info = is_flat(file) ? read_flat_info(file) : is_flx(file) ? read_flx_info(file) : hdf5::read_info(file);
  const auto format = answer.info.attributes.find("format");
  if (format != answer.info.attributes.end() && format->second == "bough-results")
    answer.events = hdf5::read_events(file);
  answer.faults = hdf5::find_layout_faults(answer.info);
  return answer;
}

}  // namespace bough::analysis
