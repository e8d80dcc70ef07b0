#include "solver/simulate/channel_units.hpp"

#include <algorithm>

namespace bough::solver {

bool is_angle(const System& system, const records::SystemSpec& spec, const std::string& path) {
  const auto has_angles = [&](const std::string& hinge) {  // not the components of a quaternion
    const int b = system.find_hinge(hinge);
    return b >= 0 && system.num_hinge_q(b) == system.num_hinge_rates(b);
  };
  const std::string kind = path.substr(0, path.find('/', 1)), name = path.substr(path.find('/', 1) + 1);
  if (kind == "/bodies") return name.ends_with("/angular_velocity");
  if (kind == "/hinges")
    return name.ends_with("/qdot") || (name.ends_with("/q") && has_angles(name.substr(0, name.rfind('/'))));
  if (kind != "/sensors") return false;
  const auto& sensors = spec.sensors;
  const auto sensor = std::find_if(sensors.begin(), sensors.end(), [&](const auto& s) { return s.name == name; });
  if (sensor == sensors.end()) return false;
  if (sensor->type == records::SensorType::HingeAngle) return has_angles(sensor->hinge);
  return records::get_kind(sensor->type).is_angle;
}

void label_channels(const System& system, const records::SystemSpec& spec, std::vector<records::Channel>& channels) {
  if (spec.units.empty()) return;
  for (auto& channel : channels)
    channel.units = records::label_units(channel.dims, spec.units, is_angle(system, spec, channel.path));
}

}  // namespace bough::solver
