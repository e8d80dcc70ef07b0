#include "formats/toml/detail/orbit_table.hpp"

#include <numbers>

namespace bough::toml_files {

records::OrbitRecord read_orbit(const Fields& table, Diagnostics& diagnostics) {
  records::OrbitRecord orbit;
  orbit.at = table.locate();
  orbit.name = table.get_string("name");
  orbit.planet = table.get_string("planet");
  orbit.body = table.get_string("body");
  orbit.has_state = table.has("position") || table.has("velocity");
  const std::string because = "in orbit '" + orbit.name + "'";
  const auto refuse_elements = [&](const std::string& why) {
    refuse_keys(table,
                {"semi_major_axis", "eccentricity", "inclination", "inclination_deg", "ascending_node",
                 "ascending_node_deg", "periapsis", "periapsis_deg", "true_anomaly", "true_anomaly_deg"},
                because + why, diagnostics);
  };
  const auto demand = [&](const char* key) {
    if (!table.has(key))
      diagnostics.error("toml.missing-key", table.locate(), "missing key '" + std::string(key) + "' " + because,
                        "give semi_major_axis and the other elements, position and velocity, or body");
  };
  if (!orbit.body.empty()) {
    refuse_elements(", which is that of a body");
    refuse_keys(table, {"position", "velocity"}, because + ", which is that of a body", diagnostics);
  } else if (orbit.has_state) {
    refuse_elements(", which has a position and a velocity");
    demand("position");
    demand("velocity");
  } else {
    demand("semi_major_axis");
  }
  const auto read_angle = [&](const char* key) {
    const double angle = table.get_number(key, 0);
    if (table.has(key)) check_radians(table, key, {angle}, diagnostics);
    return table.has(key) ? angle : std::numbers::pi / 180 * table.get_number(std::string(key) + "_deg", 0);
  };
  orbit.semi_major_axis = table.get_number("semi_major_axis", 0);
  orbit.eccentricity = table.get_number("eccentricity", 0);
  orbit.inclination = read_angle("inclination");
  orbit.ascending_node = read_angle("ascending_node");
  orbit.periapsis = read_angle("periapsis");
  orbit.true_anomaly = read_angle("true_anomaly");
  orbit.position = table.get_vector("position", orbit.position);
  orbit.velocity = table.get_vector("velocity", orbit.velocity);
  return orbit;
}

}  // namespace bough::toml_files
