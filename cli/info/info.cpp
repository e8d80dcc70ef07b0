#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "analysis/common/body_files.hpp"
#include "cli/common/console.hpp"
#include "cli/common/event_list.hpp"
#include "cli/common/options.hpp"
#include "formats/flat/flex_body.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::cli {

namespace {

struct InfoOptions : CommonOptions {
  std::string file;
};

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
    if (file.has_rigid) add("cg", "3", "mass centre from the body origin");
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

int run_info(const InfoOptions& o) {
  const Console console(o.quiet, o.verbosity);
  analysis::demand_body_file(o.file);
  if (!o.output.empty()) check_output(o, o.output, {analysis::get_body_path(o.file)});
  const auto info = analysis::is_flat(o.file)  ? read_flat_info(o.file)
                    : analysis::is_flx(o.file) ? read_flx_info(o.file)
                                               : hdf5::read_info(o.file);
  const auto format = info.attributes.find("format");
  std::vector<records::EventRecord> events;
  if (format != info.attributes.end() && format->second == "bough-results") events = hdf5::read_events(o.file);
  if (o.json) {
    auto objects = nlohmann::json::array();
    for (const auto& object : info.objects) {
      objects.push_back({{"path", object.path},
                         {"shape", object.shape},
                         {"type", object.type},
                         {"description", object.description},
                         {"dims", object.dims}});
    }
    auto list = nlohmann::json::array();
    for (const auto& e : events) list.push_back({{"time", e.time}, {"what", e.what}, {"source", e.source}});
    nlohmann::json all{{"attributes", info.attributes}, {"objects", objects}};
    if (!list.empty()) all["events"] = list;
    write_report(o, console, all.dump(2) + "\n");
    return kSuccess;
  }
  const std::size_t width = get_terminal_width();
  std::string text;
  for (const auto& [name, value] : info.attributes) text += name + ": " + value + "\n";
  text += '\n';
  std::size_t path_width = 0, shape_width = 0;
  for (const auto& object : info.objects) {
    path_width = std::max(path_width, object.path.size());
    shape_width = std::max(shape_width, object.shape.size());
  }
  const auto pad = [](const std::string& s, std::size_t to) { return s + std::string(to - s.size() + 2, ' '); };
  for (const auto& object : info.objects) {
    const std::string about =
        object.description + (object.dims.empty() || object.dims == "1" ? "" : " [" + object.dims + "]");
    std::string line = pad(object.path, path_width) + pad(object.shape, shape_width);
    // On a narrow terminal the description goes on below; elsewhere one object is one line.
    line += width > line.size() + 20 ? wrap(about, line.size(), width) : about;
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  if (!events.empty()) text += "\n" + format_events(events);
  write_report(o, console, text);
  return kSuccess;
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  auto o = std::make_shared<InfoOptions>();
  auto* verb = add_verb(app, "info", "What an HDF5 file of Bough, a .FLX or a flat body file holds");
  verb->add_option("file", o->file, "HDF5 file, .FLX or flat body file")->required();
  add_common_options(*verb, *o, kOutput | kJson, "Write the list to this file instead of stdout");
  verb->footer("Example:\n  bough info boom.h5");
  verb->callback([&action, o] { action = [o] { return run_info(*o); }; });
}

}  // namespace bough::cli
