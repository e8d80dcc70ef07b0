#include "analysis/report/scene_arrows.hpp"

#include <algorithm>
#include <memory>

#include "analysis/common/run_bodies.hpp"
#include "analysis/common/spec_functions.hpp"

namespace bough::analysis {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using records::ElementType;
using records::HingeType;
using report::SceneArrow;

/// Its first column is the direction.
Matrix3d make_axes(const Vector3d& direction) {
  Matrix3d axes = Matrix3d::Zero();
  axes.col(0) = direction;
  return axes;
}

class Arrows {
 public:
  Arrows(const records::SystemSpec& spec, const ScenePlaces& places, report::History& history)
      : spec_(spec), places_(places), history_(history), functions_(spec) {}

  void add_force(const records::ForceRecord& force) {
    if (!force.locator.empty()) return tell("force " + force.name + ": a load pattern has no one arrow");
    SceneArrow arrow;
    arrow.name = force.name;
    arrow.is_moment = force.kind == records::ForceKind::Moment;
    arrow.at = places_.find(force.body, force.node);
    arrow.frame = force.frame == records::VectorFrame::Inertial ? -1 : places_.find_body(force.body);
    arrow.axes = make_axes(force.direction);
    arrow.column = 0;
    const std::string path = "/forces/" + force.name;
    const auto is_to = [&](const auto& wire) { return wire.to == force.name; };
    if (!force.signal.empty() || std::any_of(spec_.connects.begin(), spec_.connects.end(), is_to)) {
      arrow.channel = path;
    } else if (force.function.empty()) {
      arrow.values = Eigen::VectorXd::Ones(history_.time.size());
    } else if (const auto* function = functions_.find(force.function)) {
      arrow.values = history_.time.unaryExpr([&](double t) { return function->calc(t).f; });
    } else {
      return tell("force " + force.name + ": its function " + force.function + " cannot be made here");
    }
    add(std::move(arrow));
  }

  void add_element(const records::ForceElementRecord& element) {
    const std::string path = "/forces/" + element.name + "/";
    SceneArrow arrow;
    arrow.name = element.name;
    arrow.at = places_.find(element.from.body, element.from.node, element.from.position);
    const auto to = places_.find(element.to.body, element.to.node, element.to.position);
    arrow.channel = path + "force";
    switch (element.type) {
      case ElementType::CentralGravity:
        return tell("force " + element.name + ": central gravity acts on all of a body");
      case ElementType::Drag:
      case ElementType::SolarPressure:
        return add(std::move(arrow));
      case ElementType::Spring: {
        arrow.column = 0;
        arrow.towards = to;
        SceneArrow other = arrow;
        std::swap(other.at, *other.towards);
        add(std::move(arrow));
        return add(std::move(other));
      }
      case ElementType::Bushing: {
        arrow.at = to;
        arrow.frame = places_.find_body(element.from.body);
        arrow.axes = element.from.rotation;
        SceneArrow moment = arrow;
        moment.is_moment = true;
        moment.channel = path + "moment";
        add(std::move(arrow));
        return add(std::move(moment));
      }
      case ElementType::Contact: {
        SceneArrow friction = arrow;
        friction.name += " (friction)";
        friction.channel = path + "friction";
        arrow.column = 0;
        if (element.shape == records::ContactShape::Plane) {
          arrow.frame = places_.find_body(element.to.body);
          arrow.axes = make_axes(element.normal.normalized());
        } else {
          arrow.towards = to;
          arrow.factor = -1;
        }
        add(std::move(arrow));
        if (element.friction > 0) add(std::move(friction));
        return;
      }
    }
  }

  void add_actuator(const records::ActuatorRecord& actuator) {
    SceneArrow arrow;
    arrow.name = actuator.name;
    arrow.channel = "/actuators/" + actuator.name;
    arrow.column = 0;
    if (!actuator.hinge.empty()) return add_drive(actuator, std::move(arrow));
    const auto axis = actuator.settings.numbers.find("axis");
    if (axis == actuator.settings.numbers.end() || axis->second.size() != 3)
      return tell("actuator " + actuator.name + " (" + actuator.type + "): its torque is not among the results");
    arrow.is_moment = actuator.type == "moment" || actuator.type == "wheel";
    if (actuator.type == "wheel") {
      arrow.factor = -1;  // the torque is the motor's on the wheel, the body has its reaction
      arrow.name += " (reaction of its motor)";
    }
    arrow.at = places_.find(actuator.body, actuator.node);
    arrow.frame = actuator.frame == "inertial" && actuator.type != "wheel" ? -1 : places_.find_body(actuator.body);
    arrow.axes = make_axes(Vector3d(axis->second.data()).normalized());
    add(std::move(arrow));
  }

  /// Adds the reaction of the parent on the child, in the axes of the parent's frame.
  template <typename Record>
  void add_reaction(const std::string& kind, const Record& joint) {
    SceneArrow arrow;
    arrow.name = joint.name;
    arrow.is_reaction = true;
    arrow.at = places_.find(joint.child, joint.child_node, joint.child_position);
    arrow.frame = places_.find_body(joint.parent);
    arrow.axes = joint.parent_rotation;
    SceneArrow moment = arrow;
    moment.is_moment = true;
    arrow.channel = "/" + kind + "/" + joint.name + "/reaction_force";
    moment.channel = "/" + kind + "/" + joint.name + "/reaction_moment";
    add(std::move(arrow));
    add(std::move(moment));
  }

  void finish() {
    if (unrecorded_.empty()) return;
    tell("arrows whose channels were not recorded, or not chosen by --channel: " + unrecorded_);
  }

 private:
  void tell(std::string what) { history_.missing.push_back(std::move(what)); }

  void add_drive(const records::ActuatorRecord& actuator, SceneArrow arrow) {
    for (const auto& hinge : spec_.hinges) {
      if (hinge.name != actuator.hinge) continue;
      if (hinge.type != HingeType::Revolute && hinge.type != HingeType::Prismatic)
        return tell("actuator " + actuator.name + ": drives one of several coordinates of hinge " + hinge.name);
      arrow.is_moment = hinge.type == HingeType::Revolute;
      arrow.at = places_.find(hinge.child, hinge.child_node, hinge.child_position);
      arrow.frame = places_.find_body(hinge.parent);
      arrow.axes = make_axes(hinge.parent_rotation * hinge.axis.normalized());
      add(std::move(arrow));
    }
  }

  void add(SceneArrow arrow) {
    const auto is_its = [&](const auto& channel) { return channel.path == arrow.channel; };
    const auto& channels = history_.channels;
    if (!arrow.channel.empty() && std::none_of(channels.begin(), channels.end(), is_its)) {
      if (unrecorded_.find(arrow.channel) != std::string::npos) return;
      unrecorded_ += (unrecorded_.empty() ? "" : ", ") + arrow.channel;
      return;
    }
    history_.scene.arrows.push_back(std::move(arrow));
  }

  const records::SystemSpec& spec_;
  const ScenePlaces& places_;
  report::History& history_;
  SpecFunctions functions_;
  std::string unrecorded_;
};

}  // namespace

ScenePlaces::ScenePlaces(const records::SystemSpec& spec, const report::Scene& scene) : spec_(spec), scene_(scene) {
  for (std::size_t i = 0; i < spec.bodies.size(); ++i) index_[spec.bodies[i].name] = static_cast<int>(i);
}

int ScenePlaces::find_body(const std::string& name) const {
  const auto found = index_.find(name);
  return found == index_.end() ? -1 : found->second;
}

report::ScenePlace ScenePlaces::find(const std::string& body, int node, const Vector3d& offset) const {
  report::ScenePlace place{find_body(body), -1, offset};
  if (place.body < 0) return place;
  const auto& record = spec_.bodies[static_cast<std::size_t>(place.body)];
  const auto& drawing = scene_.bodies[static_cast<std::size_t>(place.body)].drawing;
  if (record.file.empty()) {
    place.p += find_rigid_node(record, node);
  } else {
    place.point = drawing.find(node);
    if (place.point >= 0) place.p += drawing.xyz.row(place.point).transpose();
  }
  return place;
}

void add_arrows(const records::SystemSpec& spec, const ScenePlaces& places, report::History& history) {
  Arrows arrows(spec, places, history);
  for (const auto& force : spec.forces) arrows.add_force(force);
  for (const auto& element : spec.force_elements) arrows.add_element(element);
  for (const auto& actuator : spec.actuators) arrows.add_actuator(actuator);
  for (const auto& hinge : spec.hinges)
    if (hinge.type != HingeType::Free) arrows.add_reaction("hinges", hinge);
  for (const auto& constraint : spec.constraints)
    if (constraint.type != records::ConstraintType::Coupler && constraint.type != records::ConstraintType::RateCoupler)
      arrows.add_reaction("constraints", constraint);
  arrows.finish();
}

}  // namespace bough::analysis
