#include "formats/records/orbit.hpp"

#include <algorithm>
#include <cmath>

namespace bough::records {
namespace {

constexpr std::string_view kOrbit = "lvlh:";

Eigen::Matrix3d rotate(double angle, const Vector3d& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

double calc_mean_anomaly(double eccentricity, double true_anomaly) {
  const double half = std::sqrt((1 - eccentricity) / (1 + eccentricity)) * std::tan(0.5 * true_anomaly);
  const double E = 2 * std::atan(half);
  return E - eccentricity * std::sin(E);
}

class OrbitBuilder {
 public:
  OrbitBuilder(SystemSpec& spec, Diagnostics& diagnostics) : spec_(spec), diagnostics_(diagnostics) {}

  void add(const OrbitRecord& r) {
    const ForceElementRecord* planet = find_planet(r);
    if (planet == nullptr) return;
    Ellipse orbit{r.semi_major_axis, r.eccentricity, 0, Eigen::Matrix3d::Identity()};
    if (!r.body.empty() || r.has_state) {
      Vector3d p = r.position, v = r.velocity;
      if (!r.body.empty() && !find_state(r, p, v)) return;
      orbit = calc_ellipse(planet->mu, p - planet->centre, v);
    } else {
      orbit.R_WP = rotate(r.ascending_node, Vector3d::UnitZ()) * rotate(r.inclination, Vector3d::UnitX()) *
                   rotate(r.periapsis, Vector3d::UnitZ());
      if (r.eccentricity < 1) orbit.mean_anomaly = calc_mean_anomaly(r.eccentricity, r.true_anomaly);
    }
    if (!(orbit.semi_major_axis > 0) || !std::isfinite(orbit.semi_major_axis) || !(orbit.eccentricity >= 0) ||
        !(orbit.eccentricity < kMaxEccentricity)) {
      refuse(r,
             "is no ellipse: its semi-major axis is " + format(orbit.semi_major_axis) + ", its eccentricity " +
                 format(orbit.eccentricity),
             "give an orbit with an eccentricity below " + format(kMaxEccentricity));
      return;
    }
    add_frame(r, *planet, orbit);
  }
  /// Returns true if the orbit has a body.
  bool has_frame(const std::string& name) const {
    return std::find(frames_.begin(), frames_.end(), name) != frames_.end();
  }

 private:
  static constexpr double kMaxEccentricity = 0.999;

  static std::string format(double x) {
    std::string text = std::to_string(x);
    while (text.find('.') != std::string::npos && (text.back() == '0' || text.back() == '.')) {
      const bool is_point = text.back() == '.';
      text.pop_back();
      if (is_point) break;
    }
    return text;
  }

  void refuse(const OrbitRecord& r, const std::string& message, const std::string& advice) {
    diagnostics_.error("system.bad-orbit", r.at, "orbit '" + r.name + "' " + message, advice);
  }

  const ForceElementRecord* find_planet(const OrbitRecord& r) {
    for (const auto& force : spec_.force_elements) {
      if (force.type != ElementType::CentralGravity || force.name != r.planet) continue;
      if (force.mu > 0) return &force;
      return nullptr;  // reported
    }
    refuse(r, "is about '" + r.planet + "', which is no gravity_central", "name a [[force]] of type gravity_central");
    return nullptr;
  }

  /// Position and velocity at the start of a body on a free hinge of ground.
  bool find_state(const OrbitRecord& r, Vector3d& p, Vector3d& v) {
    const auto carries = [&](const HingeRecord& hinge) { return hinge.child == r.body; };
    const auto hinge = std::find_if(spec_.hinges.begin(), spec_.hinges.end(), carries);
    if (hinge == spec_.hinges.end() || hinge->type != HingeType::Free || hinge->parent != "ground" ||
        hinge->child_node != 0 || !hinge->child_position.isZero(0) || hinge->position.size() != 7 ||
        hinge->rate.size() != 6) {
      refuse(r, "is that of body '" + r.body + "', which is not at a free hinge of ground with position and rate",
             "give the orbit's position and velocity, or its elements");
      return false;
    }
    p = hinge->parent_position + hinge->parent_rotation * Vector3d(hinge->position.data() + 4);
    v = hinge->parent_rotation * Vector3d(hinge->rate.data() + 3);
    return true;
  }

  void add_frame(const OrbitRecord& r, const ForceElementRecord& planet, const Ellipse& orbit) {
    BodyRecord frame;
    frame.name = r.name;
    frame.at = r.at;
    HingeRecord hinge;
    hinge.name = r.name;
    hinge.at = r.at;
    hinge.type = HingeType::Planar;
    hinge.child = r.name;
    hinge.parent_position = planet.centre;
    hinge.parent_rotation = orbit.R_WP;
    hinge.axis = Vector3d::UnitZ();
    // R_CHc: at the true anomaly the hinge's x points up, its y along the path, its z along the angular momentum.
    hinge.child_rotation << 0, 1, 0, 0, 0, -1, -1, 0, 0;
    int component = 0;
    for (const char* part : {".x", ".y", ".anomaly"}) {
      FunctionRecord f;
      f.name = r.name + part;
      f.type = "kepler";
      f.at = r.at;
      f.values = {{"mu", planet.mu},
                  {"semi_major_axis", orbit.semi_major_axis},
                  {"eccentricity", orbit.eccentricity},
                  {"mean_anomaly", orbit.mean_anomaly},
                  {"at", spec_.simulation.start},
                  {"component", component++}};
      hinge.motion.push_back(f.name);
      spec_.functions.push_back(std::move(f));
    }
    frames_.push_back(r.name);
    spec_.bodies.push_back(std::move(frame));
    spec_.hinges.push_back(std::move(hinge));
  }

  SystemSpec& spec_;
  Diagnostics& diagnostics_;
  std::vector<std::string> frames_;
};

}  // namespace

Ellipse calc_ellipse(double mu, const Vector3d& p, const Vector3d& v) {
  Ellipse orbit;
  const double r = p.norm();
  const Vector3d h = p.cross(v);
  if (!(r > 0) || !(h.norm() > 0)) return {0, 1, 0, Eigen::Matrix3d::Identity()};
  const Vector3d to_periapsis = v.cross(h) / mu - p / r;
  orbit.semi_major_axis = 1 / (2 / r - v.squaredNorm() / mu);
  orbit.eccentricity = to_periapsis.norm();
  // A circle takes any direction in the plane: the true anomaly below is measured from it.
  const Vector3d x = orbit.eccentricity > 1e-14 ? to_periapsis : p;
  orbit.R_WP.col(2) = h.normalized();
  orbit.R_WP.col(0) = (x - x.dot(orbit.R_WP.col(2)) * orbit.R_WP.col(2)).normalized();
  orbit.R_WP.col(1) = orbit.R_WP.col(2).cross(orbit.R_WP.col(0));
  if (orbit.eccentricity < 1)
    orbit.mean_anomaly =
        calc_mean_anomaly(orbit.eccentricity, std::atan2(orbit.R_WP.col(1).dot(p), orbit.R_WP.col(0).dot(p)));
  return orbit;
}

void add_orbits(SystemSpec& spec, Diagnostics& diagnostics) {
  OrbitBuilder builder(spec, diagnostics);
  for (const OrbitRecord& orbit : spec.orbits) builder.add(orbit);
  const auto is_orbit = [&](const std::string& name) {
    return std::any_of(spec.orbits.begin(), spec.orbits.end(), [&](const auto& orbit) { return orbit.name == name; });
  };
  const auto replace = [&](std::string& parent, const std::string& user, const SourceLocation& at) {
    if (!parent.starts_with(kOrbit)) return;
    const std::string name = parent.substr(kOrbit.size());
    if (!is_orbit(name))
      diagnostics.error("system.bad-orbit", at, user + " has the parent '" + parent + "', and there is no such orbit",
                        "declare the [[orbit]] that is named after lvlh:");
    parent = builder.has_frame(name) ? name : "ground";
  };
  for (auto& hinge : spec.hinges) replace(hinge.parent, "hinge '" + hinge.name + "'", hinge.at);
  for (auto& constraint : spec.constraints)
    replace(constraint.parent, "constraint '" + constraint.name + "'", constraint.at);
  for (auto& sensor : spec.sensors) {
    if (!sensor.is_orbital || !builder.has_frame(sensor.relative_to)) continue;
    sensor.is_orbital = false;
    if (sensor.frame.empty()) sensor.frame = sensor.relative_to;
  }
}

}  // namespace bough::records
