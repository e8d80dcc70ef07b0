#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "cli/common/body_files.hpp"
#include "cli/common/channels.hpp"
#include "cli/common/options.hpp"
#include "cli/common/run_bodies.hpp"
#include "cli/common/system_files.hpp"
#include "cli/report/report_files.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/records/signal_name.hpp"
#include "formats/report/history_chapter.hpp"
#include "formats/toml/specs.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

/// Size as the warning of a run takes it, without its care for far origins: the largest distance of a point from Bo.
double calc_size(const Eigen::MatrixXd& xyz) { return xyz.rows() > 0 ? xyz.rowwise().norm().maxCoeff() : 0; }

std::string name_type(records::HingeType type) {
  switch (type) {
    case records::HingeType::Fixed:
      return "fixed";
    case records::HingeType::Revolute:
      return "revolute";
    case records::HingeType::Prismatic:
      return "prismatic";
    case records::HingeType::Universal:
      return "universal";
    case records::HingeType::Cylindrical:
      return "cylindrical";
    case records::HingeType::Planar:
      return "planar";
    case records::HingeType::Spherical:
      return "spherical";
    case records::HingeType::Free:
      return "free";
    case records::HingeType::Screw:
      return "screw";
    case records::HingeType::General:
      return "general";
    default:
      return "";
  }
}

void add_scene(const std::string& file, const hdf5::RunInputs& inputs, const ReportRequest& request,
               report::History& history) {
  Diagnostics unused;  // the text was run: what is wrong with it was said then
  const auto spec = toml_files::read_system_spec_text(inputs.system_text, file, unused);
  history.name = spec.name;
  history.energy_error_limit = spec.simulation.energy_error_limit;
  std::map<std::string, int> index;
  for (const auto& body : spec.bodies) {
    report::SceneBody drawn{body.name, {}, 0};
    if (body.file.empty()) {
      drawn.drawing = report::make_box(body.mass, body.cg, body.inertia, list_rigid_points(spec, body));
    } else {
      std::string why;
      const auto written = get_body_path(body.file);
      const auto place = find_body_file(written, file, request.files, inputs.source, why);
      if (place.empty()) {
        history.missing.push_back("body " + body.name + ": " + why);
      } else {
        const auto flex = read_body(place + body.file.substr(written.size()), unused);
        drawn.drawing = report::make_drawing(flex);
        drawn.size = calc_size(flex.node_xyz);
      }
    }
    index[body.name] = static_cast<int>(history.bodies.size());
    history.bodies.push_back(std::move(drawn));
  }
  for (const auto& hinge : spec.hinges) {
    report::SceneHinge drawn{hinge.name, "", -1, -1, hinge.parent_position, Eigen::Vector3d::Zero()};
    drawn.type = name_type(hinge.type);
    if (hinge.type == records::HingeType::Free) continue;
    if (const auto parent = index.find(hinge.parent); parent != index.end()) {
      drawn.parent = parent->second;
      const auto& body = spec.bodies[static_cast<std::size_t>(parent->second)];
      const auto& drawing = history.bodies[static_cast<std::size_t>(parent->second)].drawing;
      if (body.file.empty()) {
        drawn.p += find_rigid_node(body, hinge.parent_node);
      } else {
        drawn.point = drawing.find(hinge.parent_node);
        if (drawn.point >= 0) drawn.p += drawing.xyz.row(drawn.point).transpose();
      }
    }
    const bool has_axis = hinge.type != records::HingeType::Fixed && hinge.type != records::HingeType::Spherical &&
                          hinge.type != records::HingeType::General;
    if (has_axis) drawn.axis = hinge.parent_rotation * hinge.axis.normalized();
    history.hinges.push_back(std::move(drawn));
  }
}

/// Channels of the file in its own order of kinds: sensors first, then hinges, bodies and the rest.
int get_rank(const std::string& path) {
  static constexpr const char* kOrder[] = {"/sensors/",  "/signals/",     "/controllers/", "/actuators/",
                                           "/hinges/",   "/constraints/", "/bodies/",      "/energy/",
                                           "/momentum/", "/system_mass/"};
  for (std::size_t i = 0; i < std::size(kOrder); ++i)
    if (path.starts_with(kOrder[i])) return static_cast<int>(i);
  return static_cast<int>(std::size(kOrder));
}

bool is_chosen(const std::string& path, const std::vector<std::string>& choices) {
  if (choices.empty()) return true;
  for (const auto& choice : choices) {
    const auto name = records::parse_signal_name(choice);
    const std::string whole = choice.starts_with('/') ? choice : "/sensors/" + choice;
    for (const auto& wanted : {whole, name.path})
      if (path == wanted || path.starts_with(wanted + "/")) return true;
  }
  return false;
}

}  // namespace

report::Chapter make_results_chapter(const std::string& file, const ReportRequest& request, Diagnostics&) {
  auto results = hdf5::read_results(file);
  const auto inputs = hdf5::read_run_inputs(file);
  for (const auto& choice : request.channels) choose_columns(results, file, choice);  // says what is not there
  std::map<std::string, std::string> dims;
  for (const auto& object : hdf5::read_info(file).objects) dims[object.path] = object.dims;
  report::History history;
  history.file = file;
  history.facts = list_facts(file);
  history.settings = list_settings(file);
  history.time = results.time;
  history.events = results.events;
  history.system_text = results.system_text;
  history.completed = results.completed;
  history.reason = results.reason;
  history.energy_error = results.energy_error;
  for (auto& [path, values] : results.channels)
    if (values.cols() > 0 && is_chosen(path, request.channels))
      history.channels.push_back({path, results.descriptions[path], dims[path], std::move(values)});
  std::stable_sort(history.channels.begin(), history.channels.end(),
                   [](const auto& a, const auto& b) { return get_rank(a.path) < get_rank(b.path); });
  add_scene(file, inputs, request, history);
  const auto n = results.time.size();
  history.facts.insert(history.facts.begin() + 1, {"system", history.name});
  history.facts.emplace_back("samples", std::to_string(n));
  if (n > 0) history.facts.emplace_back("time", fmt::format("{:g} to {:g}", results.time[0], results.time[n - 1]));
  return report::make_chapter(std::move(history));
}

}  // namespace bough::cli
