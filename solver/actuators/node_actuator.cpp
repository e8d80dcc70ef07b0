// Actuators at a node: a force, a moment, a jet that is on or off, an engine with a throttle.
#include <algorithm>
#include <cmath>

#include "solver/actuators/makers.hpp"
#include "solver/forces/flow.hpp"

namespace bough::solver {
namespace {

class NodeActuator : public Actuator {
 public:
  int marker = -1;
  bool is_moment = false;
  records::VectorFrame frame = records::VectorFrame::Body;
  Vector3d axis = Vector3d::UnitX();

  void calc_outputs(const BlockInput& in, double* y) const override { y[0] = calc_command(in); }
  void add_load(const BlockInput& in, const double* y, TreeData& data) const override {
    const Tree& tree = in.motion->tree;
    const Vector3d load = y[0] * calc_axis(tree, data);
    add_marker_wrench(tree, marker, is_moment ? Vector3d::Zero() : load, is_moment ? load : Vector3d::Zero(), data);
  }

 protected:
  /// The axis in B.
  Vector3d calc_axis(const Tree& tree, const TreeData& data) const {
    const int body = tree.markers[static_cast<size_t>(marker)].body;
    if (frame == records::VectorFrame::Inertial) return data[body].state.R_WB.transpose() * axis;
    if (frame == records::VectorFrame::Node) return data.markers[static_cast<size_t>(marker)].R * axis;
    return axis;
  }
};

/// A magnetic dipole along its axis: moment m e × B. Outputs: dipole, the three components of the moment in B.
class TorqueRod final : public NodeActuator {
 public:
  void calc_outputs(const BlockInput& in, double* y) const override {
    y[0] = calc_command(in);
    Eigen::Map<Vector3d>{y + 1} = calc_moment(in, in.motion->data, y[0]);
  }
  void add_load(const BlockInput& in, const double* y, TreeData& data) const override {
    add_marker_wrench(in.motion->tree, marker, Vector3d::Zero(), Eigen::Map<const Vector3d>(y + 1), data);
  }

 private:
  Vector3d calc_moment(const BlockInput& in, const TreeData& data, double dipole) const {
    const Tree& tree = in.motion->tree;
    const BodyState& s = data[tree.markers[static_cast<size_t>(marker)].body].state;
    const Vector3d p = s.calc_place(data.markers[static_cast<size_t>(marker)].r).p_W;
    return dipole * calc_axis(tree, data).cross(s.R_WB.transpose() * in.motion->gravity.calc_magnetic_field(p));
  }
};

/// Uses propellant. The last state: the mass used. With a tank, the last memory is 1 once the tank is empty.
class Thruster : public NodeActuator {
 public:
  double exhaust = 0, exit_radius = 0;  ///< L/T, 0: uses nothing; L
  bool starts_empty = false;

  void start(double* z, double* d) const final {
    NodeActuator::start(z, d);
    if (starts_empty) d[sizes.memory - 1] = 1;
  }
  void calc_outputs(const BlockInput& in, double* y) const final {
    y[0] = calc_thrust(in);
    y[1] = exhaust > 0 ? in.z[sizes.states - 1] : 0;
  }
  void calc_rates(const BlockInput& in, double* z_dot) const final {
    NodeActuator::calc_rates(in, z_dot);
    if (exhaust > 0) z_dot[sizes.states - 1] = calc_thrust(in) / exhaust;
  }
  void add_load(const BlockInput& in, const double* y, TreeData& data) const final {
    NodeActuator::add_load(in, y, data);
    if (tank < 0) return;
    const Tree& tree = in.motion->tree;
    const Vector3d e = calc_axis(tree, data);
    add_outflow(tree, tank, {y[0] / exhaust, data.markers[static_cast<size_t>(marker)].r, exit_radius, e, y[0] * e},
                data);
  }
  void add_consumption(const BlockInput& in, Eigen::Ref<Eigen::VectorXd> by_body) const final {
    if (exhaust > 0 && tank < 0)
      by_body[in.motion->tree.markers[static_cast<size_t>(marker)].body] += in.z[sizes.states - 1];
  }
  /// exhaust_velocity, tank, exit_radius; before the memory of a kind is counted.
  void read_propellant(SettingsReader& keys, const ActuatorPlace& place) {
    exhaust = keys.has("exhaust_velocity") ? keys.get_positive("exhaust_velocity") : 0;
    tank = place.tank;
    starts_empty = place.is_tank_empty;
    keys.demand(tank < 0 || exhaust > 0, "has a tank and no exhaust_velocity", "give exhaust_velocity");
    keys.demand(tank >= 0 || !keys.has("exit_radius"), "has an exit_radius and no tank", "give tank, or leave it out");
    exit_radius = keys.get_size("exit_radius", 0);
    if (tank < 0) return;
    ++sizes.memory;
    ++sizes.event_functions;
  }
  std::string describe_switch(const Motion& motion, int function) const final {
    if (tank < 0 || function < sizes.event_functions - 1) return {};
    const Tank& used = motion.tree.tanks[static_cast<size_t>(tank)];
    return "tank '" + used.name + "' is " + (used.reserve > 0 ? "at what cannot leave it" : "empty") + ": " + label +
           " is cut off";
  }

 protected:
  virtual double calc_thrust(const BlockInput& in) const = 0;
  bool is_empty(const BlockInput& in) const { return tank >= 0 && in.d[sizes.memory - 1] > 0; }
  /// The last event function: positive once the tank is empty.
  void watch_tank(const BlockInput& in, double* g) const {
    if (tank < 0) return;
    const auto i = static_cast<size_t>(tank);
    g[sizes.event_functions - 1] = is_empty(in) ? -1 : in.motion->tree.tanks[i].reserve - in.motion->data.tanks[i].mass;
  }
  bool switch_tank(int function, double* d) const {
    if (tank < 0 || function < sizes.event_functions - 1) return false;
    d[sizes.memory - 1] = 1;
    return true;
  }
};

/// The command is its thrust, not below 0.
class Engine final : public Thruster {
 public:
  void calc_event_functions(const BlockInput& in, double* g) const override { watch_tank(in, g); }
  void switch_over(const BlockInput&, int function, double* d) const override { switch_tank(function, d); }

 protected:
  double calc_thrust(const BlockInput& in) const override { return is_empty(in) ? 0 : std::max(0.0, calc_command(in)); }
};

/// On while the command is above `on`, until it is below `off` and the shortest pulse is over. Memory: on, since when.
class Jet final : public Thruster {
 public:
  double thrust = 0, on = 0.5, off = 0.5, shortest = 0;

  void calc_event_functions(const BlockInput& in, double* g) const override {
    const double command = calc_command(in);
    g[0] = in.d[0] > 0 ? std::min(off - command, in.t - in.d[1] - shortest) : command - on;
    watch_tank(in, g);
  }
  void switch_over(const BlockInput& in, int function, double* d) const override {
    if (switch_tank(function, d)) return;
    d[0] = in.d[0] > 0 ? 0 : 1;
    d[1] = in.t;
  }

 protected:
  double calc_thrust(const BlockInput& in) const override { return is_empty(in) ? 0 : in.d[0] * thrust; }
};

}  // namespace

std::unique_ptr<Actuator> make_node_actuator(const records::ActuatorRecord& r, SettingsReader& keys,
                                             const ActuatorPlace& place) {
  std::unique_ptr<NodeActuator> made;
  if (r.type == "jet") {
    auto jet = std::make_unique<Jet>();
    jet->thrust = keys.get_positive("thrust");
    jet->on = keys.get("on", 0.5);
    jet->off = keys.get("off", 0.8 * jet->on);
    jet->shortest = keys.get_size("shortest_pulse", 0);
    keys.demand(jet->off < jet->on, "has an off that is not below on", "give off < on");
    jet->sizes.memory = 2;
    jet->sizes.event_functions = 1;
    jet->read_propellant(keys, place);
    made = std::move(jet);
  } else if (r.type == "engine") {
    auto engine = std::make_unique<Engine>();
    engine->read_propellant(keys, place);
    made = std::move(engine);
  } else if (r.type == "torque_rod") {
    made = std::make_unique<TorqueRod>();
  } else {
    made = std::make_unique<NodeActuator>();
  }
  const bool is_rod = r.type == "torque_rod";
  const bool is_thruster = r.type == "jet" || r.type == "engine";
  made->marker = place.marker;
  made->is_moment = r.type == "moment";
  made->frame = r.frame == "inertial" ? records::VectorFrame::Inertial
                : r.frame == "node"   ? records::VectorFrame::Node
                                      : records::VectorFrame::Body;
  made->axis = read_axis(keys);
  made->read_shaping(keys);
  if (is_thruster && keys.has("exhaust_velocity")) ++made->sizes.states;
  if (r.type == "jet") made->sizes.has_feedthrough = false;  // by its memory
  made->description = is_thruster ? "force, propellant used"
                      : is_rod    ? "dipole, moment x, moment y, moment z in the body frame"
                                  : "along its axis, on the body";
  made->dims = r.type == "moment" ? "F L" : is_thruster ? "F, M" : is_rod ? "by the field, F L, F L, F L" : "F";
  return made;
}

}  // namespace bough::solver
