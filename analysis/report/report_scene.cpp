#include "analysis/report/report_scene.hpp"

#include <fmt/format.h>

#include <array>
#include <map>

#include "analysis/common/body_files.hpp"
#include "analysis/common/run_bodies.hpp"
#include "analysis/report/scene_arrows.hpp"
#include "formats/records/mode_kind.hpp"
#include "formats/toml/specs.hpp"
#include "report/html.hpp"

namespace bough::analysis {

namespace {

using records::HingeType;
using records::SensorType;

/// Size as the warning of a run takes it, without its care for far origins: the largest distance of a point from Bo.
double calc_size(const Eigen::MatrixXd& xyz) { return xyz.rows() > 0 ? xyz.rowwise().norm().maxCoeff() : 0; }

std::string name_type(HingeType type) {
  // In the order of HingeType.
  constexpr std::array kNames{"fixed",  "revolute",  "prismatic", "universal", "cylindrical",
                              "planar", "spherical", "free",      "screw",     "general"};
  return kNames[static_cast<std::size_t>(type)];
}

/// "mode 3, 12.41 Hz", "mode 7, constraint".
std::vector<std::string> name_modes(const records::FlexBody& body) {
  std::vector<std::string> names;
  for (Eigen::Index j = 0; j < body.frequency_hz.size(); ++j) {
    const auto kind = body.kind.at(static_cast<std::size_t>(j));
    names.push_back(fmt::format("mode {}, {}", j + 1,
                                kind == records::ModeKind::Normal
                                    ? report::format_value(body.frequency_hz[j], 4) + " Hz"
                                    : records::get_name(kind)));
  }
  return names;
}

report::SceneBody read_scene_body(const records::SystemSpec& spec, const records::BodyRecord& body,
                                  const std::string& file, const hdf5::RunInputs& inputs, const ReportRequest& request,
                                  std::vector<std::string>& missing) {
  report::SceneBody drawn{body.name, {}, {}, {}, 0};
  if (body.file.empty()) {
    drawn.drawing = report::make_box(body.mass, body.cg, body.inertia, list_rigid_points(spec, body));
    return drawn;
  }
  std::string why;
  const auto written = get_body_path(body.file);
  const auto place = find_body_file(written, file, request.files, inputs.source, why);
  if (place.empty()) {
    missing.push_back("body " + body.name + ": " + why);
    return drawn;
  }
  Diagnostics unused;  // said by the run
  const auto flex = read_body(place + body.file.substr(written.size()), unused);
  drawn.drawing = report::make_drawing(flex);
  if (drawn.drawing.num_dropped > 0) drawn.all_shapes = report::make_drawing(flex, true).shapes;
  if (!report::add_energy_matrices(flex, drawn.drawing))
    missing.push_back("body " + body.name + ": the strain energy of its elements in all modes is too large for a page");
  drawn.mode_names = name_modes(flex);
  drawn.size = calc_size(flex.node_xyz);
  return drawn;
}

void add_hinges(const records::SystemSpec& spec, const ScenePlaces& places, report::Scene& scene) {
  for (const auto& hinge : spec.hinges) {
    if (hinge.type == HingeType::Free) continue;
    report::SceneHinge drawn{hinge.name, name_type(hinge.type),
                             places.find(hinge.parent, hinge.parent_node, hinge.parent_position),
                             Eigen::Vector3d::Zero(), hinge.parent_rotation};
    const bool has_axis =
        hinge.type != HingeType::Fixed && hinge.type != HingeType::Spherical && hinge.type != HingeType::General;
    if (has_axis) drawn.axis = hinge.parent_rotation * hinge.axis.normalized();
    scene.hinges.push_back(std::move(drawn));
  }
}

/// Returns true if the output of the sensor depends on its `rotation`.
bool has_mount(SensorType type) {
  return type == SensorType::Quaternion || type == SensorType::Euler || type == SensorType::DirectionCosines ||
         type == SensorType::Gyro || type == SensorType::IntegratingGyro || type == SensorType::Accelerometer ||
         type == SensorType::Direction || type == SensorType::Horizon || type == SensorType::Magnetometer;
}

bool has_no_place(SensorType type) {
  return type == SensorType::StrainEnergy || type == SensorType::ModalCoordinate || type == SensorType::ModalRate ||
         type == SensorType::Element;
}

void add_sensors(const records::SystemSpec& spec, const ScenePlaces& places, report::History& history) {
  std::string placeless;
  for (const auto& sensor : spec.sensors) {
    report::SceneSensor drawn{sensor.name, "", {}, {}, {}, Eigen::Vector3d::Zero()};
    if (has_no_place(sensor.type)) {
      placeless += (placeless.empty() ? "sensors of modes, energies and elements have no place: " : ", ") + sensor.name;
      continue;
    }
    if (!sensor.hinge.empty()) {
      for (const auto& hinge : history.scene.hinges) {
        if (hinge.name != sensor.hinge) continue;
        drawn.at = hinge.at;
        drawn.axis = hinge.axis;
        history.scene.sensors.push_back(drawn);
      }
      continue;
    }
    const bool is_optical = !sensor.terms.empty();
    drawn.at =
        is_optical ? places.find(sensor.terms[0].body, sensor.terms[0].node) : places.find(sensor.body, sensor.node);
    if (sensor.type == SensorType::Distance)
      drawn.to = sensor.to_body.empty() ? report::ScenePlace{-1, -1, sensor.target}
                                        : places.find(sensor.to_body, sensor.to_node);
    if (has_mount(sensor.type))
      for (int i = 0; i < 3; ++i) drawn.axes.emplace_back(sensor.mount.col(i));
    history.scene.sensors.push_back(std::move(drawn));
  }
  if (!placeless.empty()) history.missing.push_back(placeless);
}

}  // namespace

void add_scene(const std::string& file, const hdf5::RunInputs& inputs, const ReportRequest& request,
               report::History& history) {
  Diagnostics unused;  // the text was run: its errors were reported then
  const auto spec = toml_files::read_system_spec_text(inputs.system_text, file, unused);
  history.name = spec.name;
  history.energy_error_limit = spec.simulation.energy_error_limit;
  for (const auto& body : spec.bodies)
    history.scene.bodies.push_back(read_scene_body(spec, body, file, inputs, request, history.missing));
  const ScenePlaces places(spec, history.scene);
  add_hinges(spec, places, history.scene);
  add_sensors(spec, places, history);
  add_arrows(spec, places, history);
}

}  // namespace bough::analysis
