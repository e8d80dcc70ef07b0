#include "solver/builder/sensors.hpp"

#include <algorithm>

#include "solver/system/system.hpp"
#include "solver/text/names.hpp"
#include "solver/tree/coordinates.hpp"

namespace bough::solver {
namespace {

using records::get_kind;
using records::SensorKind;
using records::SensorOf;
using records::SensorRecord;
using records::SensorType;

bool is_deflection(SensorType type) { return type == SensorType::Deflection || type == SensorType::Rotation; }

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

  void resolve(const SensorRecord& r, Sensor& e) {
    const SensorKind& kind = get_kind(r.type);
    e.name = r.name;
    e.type = r.type;
    e.coordinate = r.coordinate;
    e.dims = kind.dims;
    e.size = std::max(1, kind.size);
    e.mount = r.mount;
    e.target = r.target;
    switch (kind.of) {
      case SensorOf::Coordinate:
      case SensorOf::HingeLoad:
        return resolve_hinge(r, kind, e);
      case SensorOf::Modes:
      case SensorOf::Energy:
        return resolve_modes(r, kind, e);
      case SensorOf::Element:
        return resolve_element(r, e);
      case SensorOf::Optics:
        return resolve_optics(r, e);
      default:
        resolve_node(r, e);
    }
    if (kind.of == SensorOf::Gap) resolve_other_end(r, e);
    if (r.type == SensorType::Euler) resolve_sequence(r, e);
    if (r.type == SensorType::Quaternion) e.description += ": w, x, y, z";
    if (r.type == SensorType::Direction) {
      if (!(r.target.norm() > 0)) error(r, "sensor.bad-value", "has no direction", "give target three numbers");
      e.target = r.target.normalized();
    }
  }

 private:
  static bool is_known(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  void resolve_hinge(const SensorRecord& r, const SensorKind& kind, Sensor& e) {
    e.body = system_.find_hinge(r.hinge);
    if (e.body < 0) {
      if (is_known(hinges_, r.hinge)) return;  // its own errors were reported
      error(r, "sensor.unknown-hinge", "watches the unknown hinge '" + r.hinge + "'",
            suggest_among(r.hinge, hinges_, "hinges"));
      return;
    }
    e.description = std::string(kind.name) + " of hinge " + r.hinge;
    if (!system_.is_valid(e.body) || kind.of == SensorOf::HingeLoad) return;
    const bool angle = r.type == SensorType::HingeAngle || r.type == SensorType::Resolver;
    const int count = angle ? system_.num_hinge_q(e.body) : system_.num_hinge_rates(e.body);
    if (r.coordinate < 0 || r.coordinate > count || count == 0) {
      error(r, "sensor.bad-coordinate",
            "asks for coordinate " + std::to_string(r.coordinate) + " of hinge '" + r.hinge + "', which has " +
                std::to_string(count),
            count == 0 ? "remove the sensor" : "give 1 to " + std::to_string(count) + ", or 0 for all");
      return;
    }
    e.size = r.coordinate == 0 ? count : 1;
    if (r.coordinate > 0) e.description += ", coordinate " + std::to_string(r.coordinate);
    if (angle || system_.tree[e.body].hinge->has_independent_coordinates()) name_by_count(e);
    set_dims(r, e);
  }

  /// Three components are x, y, z unless the description names them; coordinates and modes have no axes.
  static void name_by_count(Sensor& e) {
    if (e.size == 3) e.description += ": 1, 2, 3";
  }

  void set_dims(const SensorRecord& r, Sensor& e) {
    const TreeBody& tb = system_.tree[e.body];
    const int first = r.coordinate == 0 ? 0 : r.coordinate - 1;
    const bool is_rate = r.type == SensorType::HingeRate || r.type == SensorType::Tachometer;
    e.dims = list_hinge_dims(tb, is_rate ? HingeQuantity::Rate : HingeQuantity::Position, first, e.size);
    if (r.type != SensorType::Resolver) return;
    e.wraps.resize(static_cast<size_t>(e.size));
    for (int i = 0; i < e.size; ++i) e.wraps[static_cast<size_t>(i)] = !is_length(tb, first + i);
  }

  void resolve_modes(const SensorRecord& r, const SensorKind& kind, Sensor& e) {
    e.body = find_body(r.body);
    if (e.body == kAbsent)
      error(r, "sensor.unknown-body", "is on the unknown body '" + r.body + "'",
            suggest_among(r.body, bodies_, "bodies"));
    if (e.body < 0 || !system_.is_valid(e.body)) return;
    e.description = std::string(kind.name) + " of body " + r.body;
    const int count = system_.num_modes(e.body);
    if (count == 0 || r.coordinate < 0 || r.coordinate > count)
      error(r, "sensor.bad-coordinate",
            "asks for mode " + std::to_string(r.coordinate) + " of body '" + r.body + "', which has " +
                std::to_string(count),
            count == 0 ? "remove the sensor" : "give 1 to " + std::to_string(count) + ", or 0 for all");
    else if (kind.of == SensorOf::Modes)
      e.size = r.coordinate == 0 ? count : 1;
    name_by_count(e);
  }

  void resolve_element(const SensorRecord& r, Sensor& e) {
    e.body = find_body(r.body);
    if (e.body == kAbsent)
      error(r, "sensor.unknown-body", "is on the unknown body '" + r.body + "'",
            suggest_among(r.body, bodies_, "bodies"));
    if (e.body < 0 || !system_.is_valid(e.body)) return;
    const auto& recovery = system_.recoveries[static_cast<size_t>(e.body)];
    const Recovery::Element* element = recovery ? recovery->find(r.element) : nullptr;
    if (element == nullptr) {
      error(
          r, "sensor.unknown-element",
          "asks for element " + std::to_string(r.element) + ", which is not in the /recovery of body '" + r.body + "'",
          "reduce the body with that element in recover");
      return;
    }
    const auto& names = element->components;
    e.recovery = recovery.get();
    e.row = element->first;
    e.size = element->size();
    e.description = element->path + " of body " + r.body + ": ";
    if (r.component.empty()) {
      for (const auto& name : names) e.description += (name == names.front() ? "" : ", ") + name;
      return;
    }
    const auto at = std::find(names.begin(), names.end(), r.component);
    if (at == names.end()) {
      error(r, "sensor.unknown-element",
            "asks for '" + r.component + "' of element " + std::to_string(r.element) + ", which has none such",
            suggest_among(r.component, names, "components"));
      return;
    }
    e.row += static_cast<int>(at - names.begin());
    e.size = 1;
    e.description += r.component;
  }

  void resolve_optics(const SensorRecord& r, Sensor& e) {
    if (r.terms.empty()) return error(r, "sensor.bad-value", "has no terms", "give the optical nodes in terms");
    e.size = static_cast<int>(std::max(r.terms.front().displacement.rows(), r.terms.front().rotation.rows()));
    e.description = "line of sight";
    if (!r.relative_to.empty() && r.relative_to != "ground" && r.relative_to != "inertial") {
      e.relative_to = find_body(r.relative_to);
      resolve_reference(r, e);
      e.description += " relative to " + name_reference(r);
    }
    for (const auto& given : r.terms) {
      SightTerm term;
      term.body = find_body(given.body);
      if (term.body == kAbsent) {
        error(r, "sensor.unknown-body", "has a term on the unknown body '" + given.body + "'",
              suggest_among(given.body, bodies_, "bodies"));
      } else if (term.body >= 0 && system_.is_valid(term.body)) {
        term.node = system_.find_node(term.body, given.node);
        if (term.node < 0)
          error(r, "sensor.unknown-node",
                "has a term on node " + std::to_string(given.node) + ", which body '" + given.body + "' does not have",
                "use one of its output nodes, or 0 for its origin");
      }
      if (given.displacement.size() > 0) term.displacement.topRows(given.displacement.rows()) = given.displacement;
      if (given.rotation.size() > 0) term.rotation.topRows(given.rotation.rows()) = given.rotation;
      e.description += (e.terms.empty() ? ", of node " : ", ") + std::to_string(given.node) + " of body " + given.body;
      e.terms.push_back(term);
    }
  }

  void resolve_other_end(const SensorRecord& r, Sensor& e) {
    e.description += " to ";
    if (r.to_body.empty() || r.to_body == "ground") {
      e.to_body = -1;
      e.description += "a point of ground";
      return;
    }
    e.description += "node " + std::to_string(r.to_node) + " of body " + r.to_body;
    e.to_body = find_body(r.to_body);
    if (e.to_body == kAbsent)
      error(r, "sensor.unknown-body", "looks at the unknown body '" + r.to_body + "'",
            suggest_among(r.to_body, bodies_, "bodies"));
    if (e.to_body < 0 || !system_.is_valid(e.to_body)) return;
    e.to_node = system_.find_node(e.to_body, r.to_node);
    if (e.to_node < 0)
      error(r, "sensor.unknown-node",
            "looks at node " + std::to_string(r.to_node) + ", which body '" + r.to_body + "' does not have",
            "use one of its output nodes, or 0 for its origin");
  }

  void resolve_sequence(const SensorRecord& r, Sensor& e) {
    const std::string& s = r.sequence;
    const auto is_axis = [](char c) { return c >= '1' && c <= '3'; };
    if (s.size() != 3 || !std::all_of(s.begin(), s.end(), is_axis) || s[0] == s[1] || s[1] == s[2]) {
      error(r, "sensor.bad-value", "has the sequence '" + s + "'", "give three axes, as 321, 123 or 313");
      return;
    }
    for (size_t i = 0; i < 3; ++i) e.axes[i] = s[i] - '1';
    e.description += ", turns about axes " + s + ": angle1, angle2, angle3";
  }

  void resolve_node(const SensorRecord& r, Sensor& e) {
    e.body = find_body(r.body);
    if (e.body == kAbsent) {
      error(r, "sensor.unknown-body", "is on the unknown body '" + r.body + "'",
            suggest_among(r.body, bodies_, "bodies"));
    } else if (e.body >= 0 && system_.is_valid(e.body)) {
      e.node = system_.find_node(e.body, r.node);
      if (e.node < 0)
        error(r, "sensor.unknown-node",
              "is on node " + std::to_string(r.node) + ", which body '" + r.body + "' does not have",
              "use one of its output nodes, or 0 for its origin");
    }
    std::string frame = r.frame;
    e.in_orbital_frame = r.is_orbital && frame.empty();
    if (frame.empty()) frame = is_deflection(r.type) ? "body" : "inertial";
    if (frame == "body") {
      e.frame = e.body;
    } else if (frame != "inertial" && frame != "ground") {
      e.frame = find_body(frame);
      auto known = bodies_;
      known.insert(known.end(), {"inertial", "body"});
      if (e.frame == kAbsent)
        error(r, "sensor.bad-frame", "has the unknown frame '" + frame + "'", suggest_among(frame, known, "frames"));
      if (e.frame >= 0 && system_.is_valid(e.frame))
        e.frame_node = find_reference_node(r, e.frame, frame, r.frame_node);
    }
    if (!r.relative_to.empty() && r.relative_to != "ground" && r.relative_to != "inertial") {
      e.relative_to = find_body(r.relative_to);
      resolve_reference(r, e);
    }
    e.from_turning = r.from_turning;
    if (r.is_orbital && e.relative_to >= 0) resolve_orbit(r, e);
    e.description = std::string(get_kind(r.type).name) + " of node " + std::to_string(r.node) + " of body " + r.body;
    const SensorOf of = get_kind(r.type).of;
    const std::string other = (r.is_orbital ? "the LVLH frame of " : "") + name_reference(r);
    if (of == SensorOf::Attitude) e.description += e.relative_to >= 0 ? " against " + other : "";
    if (of == SensorOf::Instrument) e.description += ", in the sensor's axes";
    if (of != SensorOf::Point && of != SensorOf::Elastic) return;
    if (is_deflection(r.type))
      e.description += " from its undeformed place";
    else if (e.relative_to >= 0)
      e.description += (r.from_turning         ? " as seen from "
                        : r.relative_node == 0 ? " minus that of the origin of "
                                               : " minus that of ") +
                       other;
    e.description += ", components in the " + (e.in_orbital_frame ? "LVLH frame of body " + r.relative_to
                                               : frame == "body"  ? "frame of body " + r.body
                                               : e.frame < 0      ? "inertial frame"
                                                                  : "frame of " + name_node(frame, r.frame_node));
  }

  static std::string name_node(const std::string& body, int node) {
    return (node == 0 ? "" : "node " + std::to_string(node) + " of ") + ("body " + body);
  }
  static std::string name_reference(const SensorRecord& r) { return name_node(r.relative_to, r.relative_node); }

  /// Body and node of relative_to, whose body was looked up.
  void resolve_reference(const SensorRecord& r, Sensor& e) {
    if (e.relative_to == kAbsent)
      error(r, "sensor.unknown-body", "is relative to the unknown body '" + r.relative_to + "'",
            suggest_among(r.relative_to, bodies_, "bodies"));
    if (e.relative_to >= 0 && system_.is_valid(e.relative_to))
      e.relative_node = find_reference_node(r, e.relative_to, r.relative_to, r.relative_node);
  }

  /// Index of a node within a body; 0: the body itself, or reported.
  int find_reference_node(const SensorRecord& r, int body, const std::string& name, int node) {
    if (node == 0) return 0;
    const int found = system_.find_node(body, node);
    if (found >= 0) return found;
    error(r, "sensor.unknown-node",
          "is relative to, or has the frame of, node " + std::to_string(node) + ", which body '" + name +
              "' does not have",
          "use one of its output nodes, or the body without a node for its origin");
    return 0;
  }

  void resolve_orbit(const SensorRecord& r, Sensor& e) {
    if (!system_.is_valid(e.relative_to)) return;  // reported; no gravity_central attracts it
    int count = 0;
    for (const CentralGravity* source : system_.gravity.central) {
      if (!source->attracts(e.relative_to)) continue;
      e.orbit = source;
      ++count;
    }
    if (count != 1)
      error(r, "sensor.no-orbit",
            "is relative to the LVLH frame of body '" + r.relative_to + "', which " + std::to_string(count) +
                " [[force]]s of type gravity_central attract",
            "let one attract it");
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

/// References of lines of sight: hinges as in the file, flexible bodies undeformed.
void set_references(const System& system, std::vector<Sensor>& sensors) {
  const auto has_terms = [](const Sensor& sensor) { return !sensor.terms.empty(); };
  if (std::none_of(sensors.begin(), sensors.end(), has_terms)) return;
  const auto data = system.make_data();
  VectorXd q(system.num_q()), u(system.num_u());
  system.calc_initial_state(q, u);
  for (const TreeBody& tb : system.tree.bodies) q.segment(tb.eta_offset(), tb.num_modes()).setZero();
  u.setZero();
  calc_kinematics(system, *data, system.start, q, u);
  for (Sensor& sensor : sensors)
    if (has_terms(sensor)) set_reference(get_motion(system, *data), sensor);
}

}  // namespace

std::vector<Sensor> build_sensors(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics) {
  std::vector<Sensor> sensors;
  Resolver resolver(system, spec, diagnostics);
  for (const auto& record : spec.sensors) resolver.resolve(record, sensors.emplace_back());
  if (diagnostics.num_errors() == 0) set_references(system, sensors);
  return sensors;
}

}  // namespace bough::solver
