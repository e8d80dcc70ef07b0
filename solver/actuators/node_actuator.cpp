// Actuators at a node: a force, a moment, a jet that is on or off.
#include <algorithm>
#include <cmath>

#include "solver/actuators/makers.hpp"

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
    const int body = tree.markers[static_cast<size_t>(marker)].body;
    Vector3d load = y[0] * axis;
    if (frame == records::VectorFrame::Inertial)
      load = data[body].state.R_WB.transpose() * load;
    else if (frame == records::VectorFrame::Node)
      load = data.markers[static_cast<size_t>(marker)].R * load;
    add_marker_wrench(tree, marker, is_moment ? Vector3d::Zero() : load, is_moment ? load : Vector3d::Zero(), data);
  }
};

/// On while the command is above `on`, until it is below `off` and the shortest pulse is over. Memory: on, since when.
/// The last state: propellant used.
class Jet final : public NodeActuator {
 public:
  double thrust = 0, on = 0.5, off = 0.5, shortest = 0, exhaust = 0;

  void calc_outputs(const BlockInput& in, double* y) const override {
    y[0] = in.d[0] * thrust;
    y[1] = exhaust > 0 ? in.z[sizes.states - 1] : 0;
  }
  void calc_rates(const BlockInput& in, double* z_dot) const override {
    NodeActuator::calc_rates(in, z_dot);
    if (exhaust > 0) z_dot[sizes.states - 1] = in.d[0] * thrust / exhaust;
  }
  void add_consumption(const BlockInput& in, Eigen::Ref<Eigen::VectorXd> by_body) const override {
    if (exhaust > 0) by_body[in.motion->tree.markers[static_cast<size_t>(marker)].body] += in.z[sizes.states - 1];
  }
  void calc_event_functions(const BlockInput& in, double* g) const override {
    const double command = calc_command(in);
    g[0] = in.d[0] > 0 ? std::min(off - command, in.t - in.d[1] - shortest) : command - on;
  }
  void switch_over(const BlockInput& in, int, double* d) const override {
    d[0] = in.d[0] > 0 ? 0 : 1;
    d[1] = in.t;
  }
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
    jet->exhaust = keys.has("exhaust_velocity") ? keys.get_positive("exhaust_velocity") : 0;
    keys.demand(jet->off < jet->on, "has an off that is not below on", "give off < on");
    jet->sizes.memory = 2;
    jet->sizes.event_functions = 1;
    made = std::move(jet);
  } else {
    made = std::make_unique<NodeActuator>();
  }
  made->marker = place.marker;
  made->is_moment = r.type == "moment";
  made->frame = r.frame == "inertial" ? records::VectorFrame::Inertial
                : r.frame == "node"   ? records::VectorFrame::Node
                                      : records::VectorFrame::Body;
  made->axis = read_axis(keys);
  made->read_shaping(keys);
  if (keys.has("exhaust_velocity")) ++made->sizes.states;
  if (r.type == "jet") made->sizes.has_feedthrough = false;  // by its memory
  made->description = r.type == "jet" ? "force, propellant used" : "along its axis, on the body";
  made->dims = r.type == "moment" ? "F L" : r.type == "jet" ? "F, M" : "F";
  return made;
}

}  // namespace bough::solver
