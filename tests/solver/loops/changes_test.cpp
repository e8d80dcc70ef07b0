// Events that lock, release, break and close: momenta through them, the log, a resumed run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/builder/build_system.hpp"
#include "tests/solver/support/motions.hpp"
#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::ConstraintRecord;
using records::EventAction;

std::string list_events(const MemorySink& sink) {
  std::string text;
  for (const auto& e : sink.events()) text += e.what + "\n";
  return text;
}

double spread(const MatrixXd& values) {  // over time, to the size
  double worst = 0;
  for (int k = 0; k < values.rows(); ++k) worst = std::max(worst, (values.row(k) - values.row(0)).norm());
  return worst / std::max(1e-300, values.row(0).norm());
}

/// A flexible launcher that tumbles, with a flexible payload on a free hinge that is locked, its springs compressed.
struct Separation {
  records::SystemSpec spec;
  std::map<std::string, records::FlexBody> flex;
};

Separation make_separation() {
  Separation s;
  for (const std::string name : {"launcher", "payload"}) {
    records::FlexBody file = make_point_body(3, name == "launcher" ? 5 : 6).make_record(name);
    file.modal_damping.setZero();
    s.flex.emplace(name + ".h5", file);
    records::BodyRecord body;
    body.name = name;
    body.file = name + ".h5";
    body.eta = {0.02, -0.01, 0.03};
    s.spec.bodies.push_back(body);
  }
  auto root = make_hinge_record("root", HingeType::Free, "ground", "launcher");
  root.child_node = 101;
  root.rate = {0.3, -0.2, 0.5, 1, 2, 3};
  auto joint = make_hinge_record("joint", HingeType::Free, "launcher", "payload");
  joint.parent_node = 102;
  joint.child_node = 103;
  joint.locked.assign(6, true);
  joint.stiffness = {1, 1, 1, 20, 20, 20};
  joint.null_position = {1, 0, 0, 0, 0.2, 0.1, 0.3};
  s.spec.hinges = {root, joint};
  s.spec.events = {make_event("separation", EventAction::Release, "joint")};
  s.spec.events[0].time = 0.5;
  s.spec.simulation.duration = 1;
  s.spec.simulation.output_step = 0.05;
  s.spec.simulation.integrator = "rk";
  s.spec.simulation.relative_tolerance = s.spec.simulation.absolute_tolerance = 1e-12;
  return s;
}

TEST(StageSeparation, KeepsTheMomenta) {
  const Separation s = make_separation();
  const RunResult r = run(s.spec, s.flex);
  EXPECT_LT(spread(r.sink.get("/momentum/linear")), 1e-10);
  EXPECT_LT(spread(r.sink.get("/momentum/angular")), 1e-10);
  const MatrixXd rates = r.sink.get("/hinges/joint/qdot");
  EXPECT_EQ(rates.topRows(11).cwiseAbs().maxCoeff(), 0);  // locked to 0.5, its own sample too
  EXPECT_GT(rates.bottomRows(1).norm(), 0.1);
  const VectorXd energy = (r.sink.get("/energy/kinetic") + r.sink.get("/energy/strain")).col(0);
  EXPECT_LT((energy.array() - energy[0]).abs().maxCoeff(), 1e-9 * energy[0]);
  EXPECT_THAT(list_events(r.sink), HasSubstr("event 'separation'\nhinge 'joint' is released"));
}

// The run resumed from a checkpoint before and from one after the release.
TEST(StageSeparation, IsResumed) {
  Separation s = make_separation();
  s.spec.simulation.integrator = "rk4";
  s.spec.simulation.step = 0.005;
  const RunResult whole = run(s.spec, s.flex);
  for (const int stop_at : {4, 10, 15}) {
    std::atomic<bool> stop = false;
    SimulateOptions options;
    options.stop = &stop;
    int samples = 0;
    options.progress = [&](const Progress&) { stop = ++samples > stop_at; };
    const RunResult first = run(s.spec, s.flex, options);
    ASSERT_FALSE(first.sink.completed());
    SimulateOptions rest;
    rest.resume = first.sink.checkpoints().back();
    const RunResult second = run(s.spec, s.flex, rest);
    EXPECT_EQ(second.sink.get("/hinges/joint/q").bottomRows(1), whole.sink.get("/hinges/joint/q").bottomRows(1))
        << stop_at;
    EXPECT_EQ(second.sink.get("/bodies/payload/eta").bottomRows(1), whole.sink.get("/bodies/payload/eta").bottomRows(1))
        << stop_at;
  }
}

// Two free bodies that meet become one: by hand, at once.
TEST(Capture, IsTheInelasticImpact) {
  records::SystemSpec spec;
  for (const std::string name : {"chaser", "target"}) {
    records::BodyRecord b;
    b.name = name;
    b.mass = name == "chaser" ? 2 : 3;
    b.inertia =
        name == "chaser" ? Matrix3d(Vector3d(1, 2, 2.5).asDiagonal()) : Matrix3d(Vector3d(4, 3, 5).asDiagonal());
    spec.bodies.push_back(b);
    auto h = make_hinge_record(name, HingeType::Free, "ground", name);
    h.position = {1, 0, 0, 0, name == "chaser" ? -1.0 : 1.0, 0.1, 0};
    h.rate =
        name == "chaser" ? std::vector<double>{0.1, 0.2, -0.1, 1, 0, 0.2} : std::vector<double>{0, 0.3, 0, 0, 0, 0};
    spec.hinges.push_back(h);
  }
  records::SensorRecord gap;
  gap.name = "gap";
  gap.body = "target";
  gap.relative_to = "chaser";
  gap.from_turning = false;
  spec.sensors = {gap};
  spec.constraints = {make_constraint("dock", records::ConstraintType::Hinge, "chaser", "target")};
  spec.constraints[0].hinge = HingeType::Fixed;
  spec.constraints[0].active = false;
  spec.events = {make_event("contact", EventAction::Close, "dock")};
  spec.events[0].signal = "gap:x";
  spec.events[0].value = 1.2;
  const RunResult r = run_closely(spec, 2, 0.02, 1e-12);
  EXPECT_LT(spread(r.sink.get("/momentum/linear")), 1e-10);
  EXPECT_LT(spread(r.sink.get("/momentum/angular")), 1e-10);
  // Afterwards one rigid body: its angular velocity is that of its momentum and inertia.
  const int last = r.sink.num_samples() - 1;
  const auto get = [&](const std::string& path) { return Eigen::VectorXd(r.sink.get(path).row(last)); };
  const Vector3d cg = get("/system_mass/cg"), p = get("/momentum/linear"), l = get("/momentum/angular");
  const Eigen::VectorXd rows = get("/system_mass/inertia");
  const Matrix3d J = Eigen::Map<const Matrix3d>(rows.data());
  const Vector3d w = J.inverse() * (l - cg.cross(p));
  EXPECT_NEAR(get("/energy/kinetic")[0], 0.5 * p.squaredNorm() / 5 + 0.5 * w.dot(J * w), 1e-10);
  for (const std::string name : {"chaser", "target"}) {
    const Eigen::VectorXd wxyz = get("/bodies/" + name + "/quaternion");
    const Eigen::Quaterniond q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    EXPECT_LT((q * Vector3d(get("/bodies/" + name + "/angular_velocity")) - w).norm(), 1e-10);
  }
  const std::string log = list_events(r.sink);
  EXPECT_THAT(log, HasSubstr("event 'contact': gap:x falls through 1.2\nconstraint 'dock' is to close\n"));
  EXPECT_THAT(log, HasSubstr("constraint 'dock' closes by an impulse of ("));
  EXPECT_LT(r.outcome.energy_error, 1e-8);  // what is lost is work
}

// A double pendulum in the plane, without weight, whose elbow locks: the momentum about the pivot holds.
TEST(Lock, KeepsTheMomentumOfTheRest) {
  records::SystemSpec spec;
  for (const std::string name : {"upper", "lower"}) {
    spec.bodies.push_back(make_rod_record(name, 1, 1, 0.01));
    spec.hinges.push_back(make_hinge_record(name, HingeType::Revolute, name == "upper" ? "ground" : "upper", name));
  }
  spec.hinges[1].parent_node = 1;
  spec.hinges[0].rate = {1};
  spec.hinges[1].rate = {2};
  spec.events = {make_event("stop", EventAction::Lock, "lower"), make_event("go", EventAction::Release, "lower")};
  spec.events[0].signal = "/hinges/lower/q";
  spec.events[0].value = 0.3;
  spec.events[0].direction = records::EventDirection::Rising;  // it falls back through it when it is free again
  spec.events[1].time = 1.5;
  const RunResult r = run_closely(spec, 2, 0.01, 1e-11);
  EXPECT_LT(spread(r.sink.get("/momentum/angular")), 1e-9);
  const MatrixXd q = r.sink.get("/hinges/lower/q"), rate = r.sink.get("/hinges/lower/qdot");
  EXPECT_NEAR(q(140, 0), 0.3, 1e-10);
  EXPECT_EQ(rate(140, 0), 0);
  EXPECT_GT(std::abs(rate(200, 0)), 1e-3);
  EXPECT_THAT(list_events(r.sink), HasSubstr("the rate of coordinate 1 of hinge 'lower' jumps from"));
  EXPECT_LT(r.outcome.energy_error, 1e-8);
}

// A ball swings on a rod that breaks below: a parabola from there.
TEST(Break, LetsGo) {
  records::SystemSpec spec;
  spec.bodies = {make_body_record("ball", 2, {1, 1, 1})};
  spec.hinges = {make_hinge_record("free", HingeType::Free, "ground", "ball")};
  spec.hinges[0].position = {1, 0, 0, 0, 1, 0, 0};
  spec.constraints = {make_distance("rod", "ball", 1)};
  spec.sensors.push_back({});
  spec.sensors[0].name = "place";
  spec.sensors[0].body = "ball";
  spec.events = {make_event("below", EventAction::Break, "rod")};
  spec.events[0].signal = "place:x";
  spec.simulation.gravity = {0, 0, -9.81};
  spec.simulation.duration = 1.5;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
  const RunResult r = run(spec);
  double at = 0;
  for (const auto& e : r.sink.events()) at = e.time;
  const int last = r.sink.num_samples() - 1;
  const double t = 1.5 - at, v = std::sqrt(2 * 9.81);
  const Eigen::RowVectorXd p = r.sink.get("/bodies/ball/position").row(last);
  EXPECT_NEAR(p[0], -v * t, 1e-8);
  EXPECT_NEAR(p[2], -1 - 0.5 * 9.81 * t * t, 1e-8);
  EXPECT_EQ(r.sink.get("/constraints/rod/reaction_force").row(last).norm(), 0);
  EXPECT_THAT(list_events(r.sink), HasSubstr("constraint 'rod' is broken"));
}

/// A mass of 2 on a slide, for a second.
records::SystemSpec make_slide() {
  records::SystemSpec spec;
  spec.bodies = {make_body_record("body", 2, {1, 1, 1})};
  spec.hinges = {make_hinge_record("slide", HingeType::Prismatic, "ground", "body")};
  spec.simulation.duration = 1;
  return spec;
}

// Held, the hinge takes the weight: that releases it; free, it takes nothing: that locks it. No end.
TEST(EventActions, ACycleOfEventsIsAnError) {
  auto spec = make_slide();
  spec.events = {make_event("hold", EventAction::Lock, "slide"), make_event("grip", EventAction::Lock, "slide"),
                 make_event("let go", EventAction::Release, "slide")};
  spec.events[0].time = 0.3;
  for (int i : {1, 2}) {
    spec.events[static_cast<size_t>(i)].signal = "/hinges/slide/force";
    spec.events[static_cast<size_t>(i)].value = 5;
    spec.events[static_cast<size_t>(i)].direction =
        i == 1 ? records::EventDirection::Falling : records::EventDirection::Rising;
  }
  spec.simulation.gravity = {0, 0, -9.81};
  EXPECT_EQ(run_to_failure<ComputationError>(spec).front().id, "run.event-cycle");
}

TEST(EventActions, NamesThatAreNone) {
  const auto spec = make_slide();
  const auto report = [&](EventAction action, const std::string& target, std::vector<int> coordinates = {}) {
    auto s = spec;
    s.events = {make_event("e", action, target)};
    s.events[0].time = 0.1;
    s.events[0].coordinates = std::move(coordinates);
    Diagnostics diagnostics;
    const System system = build_system(s, {}, diagnostics);
    check_run(system, s, diagnostics);
    std::string ids;
    for (const auto& d : diagnostics.items()) {
      if (d.severity == Severity::Error) ids += d.id + " ";
    }
    return ids;
  };
  EXPECT_EQ(report(EventAction::Lock, "slide"), "");
  EXPECT_EQ(report(EventAction::Lock, "slde"), "run.unknown-target ");
  EXPECT_EQ(report(EventAction::Release, "slide", {2}), "run.bad-event ");
  EXPECT_EQ(report(EventAction::Break, "dock"), "run.unknown-target ");
}

}  // namespace
}  // namespace bough::solver::testing
