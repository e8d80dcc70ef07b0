#include "solver/sensors/sensor.hpp"

#include <algorithm>

namespace bough::solver {
namespace {

using records::SensorRecord;
using records::SensorType;

const char* name_of(SensorType type) {
  switch (type) {
    case SensorType::Position:
      return "position";
    case SensorType::Velocity:
      return "velocity";
    case SensorType::Acceleration:
      return "acceleration";
    case SensorType::Deflection:
      return "deflection";
    case SensorType::Rotation:
      return "rotation";
    case SensorType::AngularVelocity:
      return "angular velocity";
    case SensorType::AngularAcceleration:
      return "angular acceleration";
    case SensorType::HingeAngle:
      return "hinge coordinates";
    case SensorType::HingeRate:
      break;
  }
  return "hinge rates";
}

const char* dims_of(SensorType type) {
  switch (type) {
    case SensorType::Position:
    case SensorType::Deflection:
      return "L";
    case SensorType::Velocity:
      return "L/T";
    case SensorType::Acceleration:
      return "L/T^2";
    case SensorType::Rotation:
      return "1";
    case SensorType::AngularVelocity:
      return "1/T";
    case SensorType::AngularAcceleration:
      return "1/T^2";
    case SensorType::HingeAngle:
      return "1 or L";
    case SensorType::HingeRate:
      break;
  }
  return "1/T or L/T";
}

bool is_hinge_sensor(SensorType type) { return type == SensorType::HingeAngle || type == SensorType::HingeRate; }
bool is_deflection(SensorType type) { return type == SensorType::Deflection || type == SensorType::Rotation; }

/// "did you mean" or the list.
std::string make_advice(const std::string& word, const std::vector<std::string>& known, const std::string& plural) {
  if (const std::string near = find_nearest(word, known); !near.empty()) return "did you mean '" + near + "'?";
  std::string list;
  for (const auto& name : known) list += (list.empty() ? "" : ", ") + name;
  return "the " + plural + " are: " + list;
}

class Resolver {
 public:
  Resolver(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics)
      : system_(system), diagnostics_(diagnostics) {
    for (const auto& body : spec.bodies) bodies_.push_back(body.name);
    for (const auto& hinge : spec.hinges) hinges_.push_back(hinge.name);
    for (int b = 0; b < system.num_bodies(); ++b) {
      if (!is_known(hinges_, system.hinge_name(b))) hinges_.push_back(system.hinge_name(b));  // made for a free body
    }
  }

  void resolve(const SensorRecord& r, Sensors::Entry& e) {
    e.name = r.name;
    e.type = r.type;
    e.coordinate = r.coordinate;
    e.dims = dims_of(r.type);
    if (is_hinge_sensor(r.type))
      resolve_hinge(r, e);
    else
      resolve_node(r, e);
  }

 private:
  static bool is_known(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  void resolve_hinge(const SensorRecord& r, Sensors::Entry& e) {
    e.body = system_.find_hinge(r.hinge);
    if (e.body < 0) {
      if (is_known(hinges_, r.hinge)) return;  // its own errors were reported
      error(r, "sensor.unknown-hinge", "watches the unknown hinge '" + r.hinge + "'",
            make_advice(r.hinge, hinges_, "hinges"));
      return;
    }
    if (!system_.is_sound(e.body)) return;
    const bool angle = r.type == SensorType::HingeAngle;
    const int count = angle ? system_.num_hinge_q(e.body) : system_.num_hinge_rates(e.body);
    if (r.coordinate < 0 || r.coordinate > count || count == 0) {
      error(r, "sensor.bad-coordinate",
            "asks for coordinate " + std::to_string(r.coordinate) + " of hinge '" + r.hinge + "', which has " +
                std::to_string(count),
            count == 0 ? "remove the sensor" : "give 1 to " + std::to_string(count) + ", or 0 for all");
      return;
    }
    e.size = r.coordinate == 0 ? count : 1;
    e.description = std::string(name_of(r.type)) + " of hinge " + r.hinge;
    if (r.coordinate > 0) e.description += ", coordinate " + std::to_string(r.coordinate);
  }

  void resolve_node(const SensorRecord& r, Sensors::Entry& e) {
    e.body = find_body(r.body);
    if (e.body == kAbsent) {
      error(r, "sensor.unknown-body", "is on the unknown body '" + r.body + "'",
            make_advice(r.body, bodies_, "bodies"));
    } else if (e.body >= 0 && system_.is_sound(e.body)) {
      e.node = system_.find_node(e.body, r.node);
      if (e.node < 0)
        error(r, "sensor.unknown-node",
              "is on node " + std::to_string(r.node) + ", which body '" + r.body + "' does not have",
              "use one of its output nodes, or 0 for its origin");
    }
    std::string frame = r.frame;
    if (frame.empty()) frame = is_deflection(r.type) ? "body" : "inertial";
    if (frame == "body") {
      e.frame = e.body;
    } else if (frame != "inertial" && frame != "ground") {
      e.frame = find_body(frame);
      auto known = bodies_;
      known.insert(known.end(), {"inertial", "body"});
      if (e.frame == kAbsent)
        error(r, "sensor.bad-frame", "has the unknown frame '" + frame + "'", make_advice(frame, known, "frames"));
    }
    if (!r.relative_to.empty() && r.relative_to != "ground" && r.relative_to != "inertial") {
      e.relative_to = find_body(r.relative_to);
      if (e.relative_to == kAbsent)
        error(r, "sensor.unknown-body", "is relative to the unknown body '" + r.relative_to + "'",
              make_advice(r.relative_to, bodies_, "bodies"));
    }
    e.from_turning = r.from_turning;
    e.description = std::string(name_of(r.type)) + " of node " + std::to_string(r.node) + " of body " + r.body;
    if (is_deflection(r.type))
      e.description += " from its undeformed place";
    else if (e.relative_to >= 0)
      e.description += (r.from_turning ? " as seen from body " : " less that of the origin of body ") + r.relative_to;
    e.description += ", components in the " + (frame == "body" ? "frame of body " + r.body
                                               : e.frame < 0   ? "inertial frame"
                                                               : "frame of body " + frame);
  }

  static constexpr int kAbsent = -2, kUnplaced = -1;
  /// kUnplaced: a body of the spec that is not in the tree, for reasons that were reported.
  int find_body(const std::string& name) const {
    if (const int found = system_.find_body(name); found >= 0) return found;
    return is_known(bodies_, name) ? kUnplaced : kAbsent;
  }

  void error(const SensorRecord& r, const char* id, const std::string& what, const std::string& advice) {
    diagnostics_.error(id, r.at, "sensor '" + r.name + "' " + what, advice);
  }

  const System& system_;
  Diagnostics& diagnostics_;
  std::vector<std::string> bodies_, hinges_;
};

/// Motion of the observer, in W; at rest for the inertial frame.
struct Observer {
  Vector3d p = Vector3d::Zero(), v = Vector3d::Zero(), a = Vector3d::Zero();
  Vector3d w = Vector3d::Zero(), alpha = Vector3d::Zero();
};

Observer calc_observer(const SystemData& data, int body) {
  Observer o;
  if (body < 0) return o;
  const BodyState& s = get_body_state(data, body);
  o.p = s.p_WBo;
  o.v.noalias() = s.R_WB * s.v_B;
  o.a.noalias() = s.R_WB * s.a_B;
  o.w.noalias() = s.R_WB * s.w_B;
  o.alpha.noalias() = s.R_WB * s.alpha_B;
  return o;
}

Vector3d calc_relative(SensorType type, bool from_turning, const NodeMotion& k, Observer o) {
  if (!from_turning) {  // he keeps his axes
    if (type == SensorType::AngularVelocity) return k.w_WK - o.w;
    if (type == SensorType::AngularAcceleration) return k.alpha_WK - o.alpha;
    o.w.setZero();
    o.alpha.setZero();
  }
  const Vector3d p = k.p_WK - o.p;
  if (type == SensorType::Position) return p;
  const Vector3d v = k.v_WK - o.v - o.w.cross(p);
  if (type == SensorType::Velocity) return v;
  const Vector3d w = k.w_WK - o.w;
  if (type == SensorType::AngularVelocity) return w;
  if (type == SensorType::AngularAcceleration) return k.alpha_WK - o.alpha - o.w.cross(w);
  return k.a_WK - o.a - o.alpha.cross(p) - o.w.cross(o.w.cross(p)) - 2 * o.w.cross(v);
}

}  // namespace

Sensors Sensors::build(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics) {
  Sensors sensors;
  Resolver resolver(system, spec, diagnostics);
  for (const auto& record : spec.sensors) {
    Entry entry;
    resolver.resolve(record, entry);
    entry.first = sensors.size_;
    sensors.size_ += entry.size;
    sensors.entries_.push_back(std::move(entry));
  }
  return sensors;
}

void Sensors::calc(const System& system, const SystemData& data, Eigen::Ref<VectorXd> out) const {
  BOUGH_DEMAND(out.size() == size_);
  for (const Entry& e : entries_) {
    if (is_hinge_sensor(e.type)) {
      Eigen::Matrix<double, 7, 1> q, q_dot, force;
      const int nq = system.num_hinge_q(e.body), nu = system.num_hinge_rates(e.body);
      get_hinge(system, data, e.body, q.head(nq), q_dot.head(nu), force.head(nu));
      const auto& value = e.type == SensorType::HingeAngle ? q : q_dot;
      out.segment(e.first, e.size) = value.segment(e.coordinate == 0 ? 0 : e.coordinate - 1, e.size);
      continue;
    }
    Vector3d value_W;
    if (is_deflection(e.type)) {
      Vector3d deflection, rotation;
      calc_node_deflection(system, data, e.body, e.node, deflection, rotation);
      const Vector3d& value_B = e.type == SensorType::Deflection ? deflection : rotation;
      if (e.frame == e.body) {
        out.segment<3>(e.first) = value_B;
        continue;
      }
      value_W.noalias() = get_body_state(data, e.body).R_WB * value_B;
    } else {
      value_W = calc_relative(e.type, e.from_turning, calc_node_motion(system, data, e.body, e.node),
                              calc_observer(data, e.relative_to));
    }
    if (e.frame < 0)
      out.segment<3>(e.first) = value_W;
    else
      out.segment<3>(e.first).noalias() = get_body_state(data, e.frame).R_WB.transpose() * value_W;
  }
}

}  // namespace bough::solver
