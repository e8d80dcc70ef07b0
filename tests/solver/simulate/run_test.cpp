// Results of a run about itself: energy, divergence, signs, checkpoints, samples next to jumps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/builder/build_system.hpp"
#include "solver/functions/function.hpp"
#include "solver/simulate/modal_range_monitor.hpp"
#include "solver/simulate/run_options.hpp"
#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;
using ::testing::AllOf;
using ::testing::HasSubstr;

records::FunctionRecord make_f(const std::string& type, std::map<std::string, double> values) {
  return make_function("f", type, values);
}

void push(records::SystemSpec& spec, const records::FunctionRecord& function) {
  spec.functions = {function};
  records::ForceRecord force;
  force.name = "push";
  force.body = "body";
  force.direction = {1, 0, 0};
  force.function = function.name;
  spec.forces = {force};
}

std::string run_and_fail(const records::SystemSpec& spec, const char* id) {
  MemorySink sink;
  Diagnostics diagnostics;
  const System system = build(spec);
  try {
    simulate(system, spec, sink, {}, diagnostics);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.items()[0].id, id);
    EXPECT_EQ(failure.items()[0].where.line, 20);
    return failure.items()[0].what;
  }
  ADD_FAILURE() << "no " << id;
  return {};
}

// A slide whose rate jumps carries a body at rest to 10 and back: impulses that the work holds.
TEST(Energy, ImpulsesOfPrescribedRatesAreWork) {
  auto spec = make_one_body(HingeType::Prismatic);
  spec.functions = {make_f("ramp", {{"value", 5}, {"from", 0.25}, {"to", 0.75}})};
  spec.hinges[0].motion = {"f"};
  spec.simulation.integrator = "rk";
  const RunResult r = run(spec);
  EXPECT_TRUE(r.sink.completed());
  EXPECT_LT(r.outcome.energy_error, 1e-9);
  EXPECT_TRUE(r.outcome.energy_is_kept);
  EXPECT_EQ(r.sink.events().size(), 2u);
}

// Steps that are too long lose a part of the energy.
TEST(Energy, TheWorstErrorOfTheRunIsJudged) {
  auto spec = make_spring_mass();
  spec.simulation.duration = 20;
  spec.simulation.integrator = "rk4";
  spec.simulation.output_step = spec.simulation.step = 0.25;
  spec.simulation.energy_error_limit = 1e-3;
  const RunResult r = run(spec);
  EXPECT_TRUE(r.outcome.completed);
  EXPECT_TRUE(r.sink.completed());
  EXPECT_GT(r.outcome.energy_error, 1e-2);
  EXPECT_GE(r.outcome.energy_error, (1 - 1e-12) * std::abs(r.outcome.last.energy_error));
  EXPECT_FALSE(r.outcome.energy_is_kept);
  EXPECT_EQ(r.sink.energy_error(), r.outcome.energy_error);
  ASSERT_TRUE(r.diagnostics.has("run.energy-error"));
  EXPECT_THAT(format(r.diagnostics.items().back()), HasSubstr("the energy balance is off by "));
  spec.simulation.energy_error_limit = 2;
  const RunResult wide = run(spec);
  EXPECT_TRUE(wide.outcome.energy_is_kept);
  EXPECT_TRUE(wide.diagnostics.has("run.energy-drift"));
  EXPECT_EQ(wide.diagnostics.num_errors(), 0);
}

// Loose tolerances are worth a warning, tight ones no word; nor is a body at rest, whatever rounding says of it.
TEST(Energy, DriftIsAWarning) {
  auto spec = make_spring_mass();
  spec.simulation.duration = 20;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-5;
  EXPECT_TRUE(run(spec).diagnostics.has("run.energy-drift"));
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
  EXPECT_TRUE(run(spec).diagnostics.items().empty());
  spec.hinges[0].position = {1e-14};
  spec.simulation.gravity = {0, 0, 1e-9};
  EXPECT_TRUE(run(spec).diagnostics.items().empty());
}

// Where the inertial origin lies does not enter the error.
TEST(Energy, HeightAboveTheOriginHidesNoError) {
  auto spec = make_spring_mass();
  spec.simulation.duration = 20;
  spec.simulation.output_step = 10;  // rk ends its steps on the outputs: close ones would hide the tolerance
  spec.simulation.gravity = {0, -9.81, 0};
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-6;
  const double low = run(spec).outcome.energy_error;
  spec.hinges[0].parent_position = {0, 1e4, 0};
  EXPECT_NEAR(run(spec).outcome.energy_error, low, 1e-3 * low);
  EXPECT_GT(low, 1e-9);
}

// A loop that holds all of it at potential zero: what is off by rounding is no part of an energy of rounding.
TEST(Energy, ASystemThatNothingCanMoveIsNotJudgedByItsRounding) {
  auto spec = make_one_body(HingeType::Revolute);
  spec.bodies[0].mass = 5;
  spec.hinges[0].axis = {0, 1, 0};
  spec.hinges[0].child_position = {-0.7, 0, 0};
  spec.bodies.push_back(spec.bodies[0]);
  spec.bodies[1].name = "slide";
  spec.hinges.push_back(make_hinge_record("rail", HingeType::Prismatic, "ground", "slide"));
  spec.hinges[1].axis = {0, 0, 1};
  spec.hinges[1].parent_position = {1.3, 0, 0};
  records::ConstraintRecord c;
  c.name = "held";
  c.hinge = HingeType::Planar;
  c.parent = "body";
  c.child = "slide";
  spec.constraints = {c};
  spec.simulation.gravity = {0, 0, -9.81};
  const RunResult r = run(spec);
  EXPECT_TRUE(r.outcome.energy_is_kept);
  EXPECT_FALSE(r.diagnostics.has("run.energy-error"));
  EXPECT_FALSE(r.diagnostics.has("run.energy-drift"));
  EXPECT_LT(r.sink.get("/energy/kinetic").cwiseAbs().maxCoeff(), 1e-20);
}

// A gimbal that is turned into the place where its first and third axis fall together: named before and at the end.
TEST(GimbalLock, IsNamedWithItsHingeAndAngle) {
  auto spec = make_one_body(HingeType::General);
  spec.hinges[0].rotations = "zxz";
  spec.hinges[0].at = {"system.toml", 7};
  spec.hinges[0].position = {0.1, 0.5, 0};
  spec.hinges[0].rate = {0.002, -1, 0};  // passes at about a thousandth
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-9;
  const System system = build(spec);
  MemorySink sink;
  Diagnostics diagnostics;
  std::string end;
  try {
    simulate(system, spec, sink, {}, diagnostics);
  } catch (const ComputationError& failure) {
    end = failure.what();
  }
  ASSERT_TRUE(diagnostics.has("run.gimbal-lock")) << end;
  EXPECT_THAT(format(diagnostics.items()[0]),
              AllOf(HasSubstr("system.toml:7: warning: gimbal lock: the axes of coordinates 1 and 3 of hinge 'hinge'"),
                    HasSubstr("by its coordinate 2 at t = "), HasSubstr("use a hinge with a quaternion")));
  if (!end.empty()) EXPECT_THAT(end, HasSubstr("gimbal lock"));
}

TEST(GimbalLock, IsNoWantOfMass) {
  auto spec = make_one_body(HingeType::General);
  spec.hinges[0].rotations = "zxz";
  try {
    run(spec);
    ADD_FAILURE() << "no failure";
  } catch (const ComputationError& failure) {
    EXPECT_EQ(failure.items()[0].id, "solver.gimbal-lock");
    EXPECT_THAT(failure.items()[0].what, HasSubstr("gimbal lock: the axes of coordinates 1 and 3 of hinge 'hinge'"));
    EXPECT_THAT(failure.items()[0].advice, HasSubstr("quaternion"));
  }
}

// ½kx² is lost to the damper.
TEST(Energy, DissipatedIsTheWorkOfDampers) {
  auto spec = make_one_body(HingeType::Prismatic);
  spec.hinges[0].stiffness = {18};
  spec.hinges[0].damping = {12};
  spec.hinges[0].position = {0.5};
  spec.simulation.duration = 20;
  spec.simulation.relative_tolerance = 1e-10;
  const RunResult r = run(spec);
  const VectorXd dissipated = r.sink.get("/energy/dissipated");
  EXPECT_EQ(dissipated[0], 0);
  EXPECT_NEAR(dissipated[dissipated.size() - 1], 0.5 * 18 * 0.25, 1e-7);
  EXPECT_LT((dissipated + r.sink.get("/energy/work")).cwiseAbs().maxCoeff(), 1e-12);
}

// A satellite, a rotor, a prescribed angle: far and many turns are no divergence.
TEST(Divergence, PositionsHaveNoLimit) {
  auto spec = make_one_body(HingeType::Free);
  spec.hinges[0].position = {1, 0, 0, 0, 7e6, 0, 0};
  spec.hinges[0].rate = {0, 0, 0.001, 0, 7500, 0};
  EXPECT_TRUE(run(spec).outcome.completed);
  auto rotor = make_one_body(HingeType::Revolute);
  rotor.hinges[0].position = {2e6};
  rotor.hinges[0].rate = {314};
  EXPECT_TRUE(run(rotor).outcome.completed);
  auto thrust = make_one_body(HingeType::Free);  // from rest, by a force
  push(thrust, make_f("step", {{"value", 1e9}, {"at", 0.5}}));
  EXPECT_TRUE(run(thrust).outcome.completed);
}

TEST(Divergence, DeflectionIsJudgedByTheBody) {
  const PointBody points = make_point_body(2, 5, 0.01);
  auto spec = make_one_body(HingeType::Fixed);
  spec.bodies[0].file = "points.h5";
  spec.simulation.divergence_limit = 0.01;
  const std::map<std::string, records::FlexBody> flex = {{"points.h5", points.make_record("points")}};
  const System system = build(spec, flex);
  const double reach = ModalRangeMonitor(system).calc_modal_limit()[system.eta_offset(0)];
  EXPECT_GT(reach, 0);
  EXPECT_LT(reach, 1e3);
  spec.bodies[0].eta = {0.02 * reach, 0};
  MemorySink sink;
  Diagnostics diagnostics;
  const System deflected = build(spec, flex);
  try {
    simulate(deflected, spec, sink, {}, diagnostics);
    ADD_FAILURE();
  } catch (const ComputationError& e) {
    EXPECT_THAT(e.items()[0].what, HasSubstr("body 'body' (modal coordinate 1) reached"));
    EXPECT_THAT(e.items()[0].what, HasSubstr("times what deflects the body by its own size"));
  }
}

// Its size does not depend on where its origin lies.
TEST(Divergence, SizeIsThatOfTheBody) {
  PointBody points = make_point_body(2, 5, 0.01);
  auto spec = make_one_body(HingeType::Free);
  spec.bodies[0].file = "points.h5";
  const auto size = [&] { return calc_body_size(build(spec, {{"points.h5", points.make_record("points")}}), 0); };
  const double near = size();
  for (auto& p : points.p) p += Vector3d(1000, 0, 0);
  const double far = size();
  EXPECT_GT(far, 0.9 * near);
  EXPECT_LT(far, 4 * near);
  for (auto& p : points.p) p += Vector3d(1000, 0, 0);
  EXPECT_NEAR(size(), far, 1e-6 * far);
  // A rod of length 3 by its inertia; its only node is in its middle.
  auto rod = make_one_body(HingeType::Free);
  rod.bodies[0].mass = 4;
  rod.bodies[0].inertia = Vector3d(0, 3, 3).asDiagonal();
  EXPECT_NEAR(calc_body_size(build(rod), 0), 3, 1e-12);
}

TEST(Divergence, TheFirstQuantityThatIsNotFiniteIsNamed) {
  for (const std::string integrator : {"adams", "bdf", "rk", "rk4"}) {
    auto spec = make_one_body(HingeType::Free);
    push(spec, make_f("ramp", {{"value", 1e308}, {"from", 0}, {"to", 1}}));
    spec.forces[0].direction = {1e300, 0, 0};
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 0.01 : 0;
    spec.simulation.divergence_limit = 1e300;
    const std::string what = run_and_fail(spec, "run.diverged");
    EXPECT_THAT(what, HasSubstr("force 'push' is not a finite number")) << integrator;
    EXPECT_THAT(what, HasSubstr("at t = ")) << integrator;
  }
}

// Errors of the equations have a place and a time.
TEST(Divergence, FailuresOfTheEquationsSayWhen) {
  auto spec = make_one_body(HingeType::Revolute);
  spec.bodies[0].inertia.setZero();
  EXPECT_THAT(run_and_fail(spec, "solver.indefinite-mass"), HasSubstr("at t = 0"));
}

// 3 · 0.1 is not 0.3; rk could not step the difference.
TEST(Samples, NextToAJump) {
  for (const std::string integrator : {"adams", "bdf", "rk", "rk4"}) {
    auto spec = make_one_body(HingeType::Free);
    push(spec, make_f("step", {{"value", 2}, {"at", 0.3}}));
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 0.05 : 0;
    const RunResult r = run(spec);
    EXPECT_TRUE(r.outcome.completed) << integrator;
    EXPECT_EQ(r.sink.num_samples(), 11);
    EXPECT_NEAR(r.sink.get("/bodies/body/velocity")(10, 0), 0.7, 1e-9) << integrator;
  }
}

// At 4.2 s of a turn in 2π s the quaternion of R changes its sign; over a stop and resume too.
TEST(Samples, QuaternionsAreContinuous) {
  auto spec = make_one_body(HingeType::Free);
  spec.hinges[0].rate = {0.02, 0, 1, 0, 0, 0};
  spec.simulation.duration = 30;
  spec.simulation.output_step = 0.5;
  const auto check = [](const MatrixXd& q, const MatrixXd& raw) {
    for (int i = 1; i < q.rows(); ++i) EXPECT_GT(q.row(i).dot(q.row(i - 1)), 0.8) << i;
    for (int i = 0; i < q.rows(); ++i) EXPECT_NEAR(q.row(i).dot(raw.row(i)), 1, 1e-6) << i;
  };
  const RunResult whole = run(spec);
  check(whole.sink.get("/bodies/body/quaternion"), whole.sink.get("/hinges/hinge/q").leftCols(4));
  std::atomic<bool> stop{false};
  SimulateOptions options, resume;
  options.stop = &stop;
  options.progress = [&](const Progress& p) { stop = p.time > 6; };
  resume.resume = run(spec, {}, options).sink.checkpoints().back();
  const MatrixXd rest = run(spec, {}, resume).sink.get("/bodies/body/quaternion");
  EXPECT_LT((rest - whole.sink.get("/bodies/body/quaternion").bottomRows(rest.rows())).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Samples, WindowAndDecimationLeaveTheMotion) {
  auto spec = make_spring_mass();
  spec.simulation.output_step = 0.05;
  spec.simulation.integrator = "rk";
  const RunResult all = run(spec);
  spec.simulation.output_from = 0.3;
  spec.simulation.output_until = 0.95;
  spec.simulation.output_every = 3;
  spec.simulation.record = {"hinges/hinge/q", "energy"};
  const RunResult some = run(spec);
  EXPECT_EQ(some.sink.time(), 0.05 * Eigen::VectorXd::LinSpaced(5, 6, 18));
  EXPECT_EQ(some.sink.get("/hinges/hinge/q")(1, 0), all.sink.get("/hinges/hinge/q")(9, 0));
  EXPECT_EQ(some.sink.get("/energy/strain")(4, 0), all.sink.get("/energy/strain")(18, 0));
  EXPECT_FALSE(some.sink.has("/hinges/hinge/qdot"));
  EXPECT_FALSE(some.sink.has("/bodies/body/position"));
  EXPECT_EQ(some.outcome.last.num_steps, all.outcome.last.num_steps);
  spec.simulation.record = {"hinge"};
  Diagnostics diagnostics;
  const System system = build(spec);
  check_run(system, spec, diagnostics);
  ASSERT_TRUE(diagnostics.has("run.unknown-group"));
  EXPECT_THAT(format(diagnostics.items()[0]), HasSubstr("did you mean 'hinges'?"));
}

// The checkpoint at a jump holds the rates before or behind it: either way the impulse comes once.
TEST(Resume, AtAJumpIsTheUnbrokenRun) {
  auto spec = make_one_body(HingeType::Prismatic);
  spec.functions = {make_f("ramp", {{"value", 0.5}, {"from", 0.3}, {"to", 0.7}})};
  spec.hinges[0].motion = {"f"};
  spec.hinges[0].axis = Vector3d::UnitX();
  auto bob = spec.bodies[0];
  bob.name = "bob";
  bob.cg = {0, -0.5, 0};
  spec.bodies.push_back(bob);
  spec.hinges.push_back(make_hinge_record("pin", HingeType::Revolute, "body", "bob"));
  spec.simulation.gravity = {0, -9.81, 0};
  spec.simulation.integrator = "rk4";
  spec.simulation.step = 0.01;
  const RunResult whole = run(spec);
  for (const double at : {0.3, 0.7}) {
    std::atomic<bool> stop = false;
    SimulateOptions options, resume;
    options.stop = &stop;
    options.progress = [&](const Progress& p) { stop = p.time > at - 1e-9; };
    const RunResult first = run(spec, {}, options);
    ASSERT_FALSE(first.outcome.completed);
    EXPECT_NEAR(first.outcome.time, at, 1e-12);
    resume.resume = first.sink.checkpoints().back();
    const RunResult rest = run(spec, {}, resume);
    const int n = rest.sink.num_samples();
    EXPECT_EQ(first.sink.num_samples() + n, whole.sink.num_samples());
    for (const char* path : {"/hinges/pin/q", "/hinges/pin/qdot", "/energy/work"})
      EXPECT_EQ((rest.sink.get(path) - whole.sink.get(path).bottomRows(n)).cwiseAbs().maxCoeff(), 0) << path << at;
    EXPECT_EQ(first.sink.events().size() + rest.sink.events().size(), whole.sink.events().size());
  }
}

// Warnings once given are not given again after a resume, and the worst error stays.
TEST(Checkpoint, CarriesWhatTheRunKnows) {
  const PointBody points = make_point_body(2, 5, 0.01);
  records::SystemSpec spec = make_one_body(HingeType::Fixed);
  spec.bodies[0].file = "points.h5";
  spec.bodies[0].eta = {0.8, 0};
  const std::map<std::string, records::FlexBody> flex = {{"points.h5", points.make_record("points")}};
  std::atomic<bool> stop{false};
  SimulateOptions options, resume;
  options.stop = &stop;
  options.progress = [&](const Progress& p) { stop = p.time > 0.45; };
  const RunResult first = run(spec, flex, options);
  EXPECT_TRUE(first.diagnostics.has("run.linear-limit"));
  resume.resume = first.sink.checkpoints().back();
  const RunResult second = run(spec, flex, resume);
  EXPECT_FALSE(second.diagnostics.has("run.linear-limit"));
  EXPECT_TRUE(second.sink.events().empty());
  EXPECT_GE(second.outcome.energy_error, first.outcome.energy_error);
}

// Between rare samples too; rk4 goes on in the middle of its interval bit by bit.
TEST(Checkpoint, ByTheClockWithinAnInterval) {
  for (const std::string integrator : {"rk4", "adams", "rk"}) {
    auto spec = make_one_body(HingeType::Prismatic);
    spec.hinges[0].stiffness = {18};
    spec.hinges[0].position = {0.5};
    spec.simulation.output_step = 1;
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 0.03 : 0.05;
    SimulateOptions options;
    options.checkpoint_after = std::chrono::seconds(0);
    const RunResult whole = run(spec, {}, options);
    ASSERT_GT(whole.sink.checkpoints().size(), 10u) << integrator;
    SimulateOptions resume;
    for (const auto& checkpoint : whole.sink.checkpoints()) {
      if (checkpoint.time < 0.4) resume.resume = checkpoint;
    }
    EXPECT_GT(resume.resume->time, 0.3);
    const RunResult rest = run(spec, {}, resume);
    ASSERT_EQ(rest.sink.num_samples(), 1);
    const double a = whole.sink.get("/hinges/hinge/q")(1, 0), b = rest.sink.get("/hinges/hinge/q")(0, 0);
    if (integrator == "rk4")
      EXPECT_EQ(a, b);
    else
      EXPECT_NEAR(a, b, 1e-6) << integrator;
  }
}

// The table is a sine sampled 5001 times: as many restarts cost 66,685 evaluations.
TEST(Tables, SampledForcesDoNotRestart) {
  auto spec = make_one_body(HingeType::Free);
  records::FunctionRecord table;
  table.name = "f";
  table.type = "table";
  for (int i = 0; i <= 5000; ++i) {
    table.x.push_back(2e-3 * i);
    table.y.push_back(std::sin(table.x.back()));
  }
  push(spec, table);
  spec.simulation.duration = 10;
  const RunResult r = run(spec);
  EXPECT_LT(r.outcome.last.num_evaluations, 4000);
  EXPECT_NEAR(r.sink.get("/bodies/body/velocity").bottomRows(1)(0, 0), (1 - std::cos(10.0)) / 2, 1e-6);
  EXPECT_LT(r.outcome.energy_error, 1e-5);
}

// A gust of 20 ms in 100 s of rest.
TEST(Tables, AShortGustIsNotMissed) {
  for (const std::string interpolation : {"linear", "cubic"}) {
    auto spec = make_one_body(HingeType::Free);
    records::FunctionRecord table;
    table.name = "f";
    table.type = "table";
    table.interpolation = interpolation;
    table.x = {0, 25, 49, 49.9, 49.98};
    for (int i = -100; i <= 100; ++i) table.x.push_back(50 + 1e-4 * i);
    table.x.insert(table.x.end(), {50.02, 50.1, 51, 75, 100});
    for (double x : table.x) table.y.push_back(std::pow(std::max(0.0, 1 - std::pow(100 * (x - 50), 2)), 4));
    Diagnostics diagnostics;
    const auto f = make_time_function(table, diagnostics);
    double impulse = 0;
    for (int i = 0; i < 1000000; ++i) impulse += 1e-4 * f->calc(1e-4 * (i + 0.5)).f;
    EXPECT_GT(impulse, 0.008);
    push(spec, table);
    spec.simulation.duration = 100;
    spec.simulation.output_step = 100;
    EXPECT_NEAR(run(spec).sink.get("/bodies/body/velocity")(1, 0), impulse / 2, 1e-4 * impulse) << interpolation;
  }
}

// Without stiffening the modes of a body that spins soften: a word at half the first frequency.
TEST(Advice, SpinWithoutStiffening) {
  PointBody points = make_point_body(2, 5, 0.01);
  auto spec = make_one_body(HingeType::Revolute);
  spec.bodies[0].file = "points.h5";
  spec.bodies[0].stiffening = false;
  spec.simulation.duration = spec.simulation.output_step = 0.01;
  const auto flex = std::map<std::string, records::FlexBody>{{"points.h5", points.make_record("points")}};
  const System system = build(spec, flex);
  const double first = calc_first_frequency(system, 0);
  const MatrixXd M = flex.at("points.h5").modal_mass;
  EXPECT_NEAR(first * first, Eigen::EigenSolver<MatrixXd>(M.inverse() * points.K).eigenvalues().real().minCoeff(),
              1e-9 * first * first);
  spec.hinges[0].rate = {0.4 * first};
  EXPECT_FALSE(run(spec, flex).diagnostics.has("run.unstiffened-spin"));
  spec.hinges[0].rate = {0.6 * first};
  const RunResult fast = run(spec, flex);
  ASSERT_TRUE(fast.diagnostics.has("run.unstiffened-spin"));
  EXPECT_EQ(fast.diagnostics.num_warnings(), 1);
  // A prescribed spin is seen before the run, which then says it once.
  spec.hinges[0].rate = {0};
  spec.hinges[0].motion = {"f"};
  spec.functions = {make_f("ramp", {{"value", 0.6 * first * 0.006}, {"from", 0.002}, {"to", 0.008}})};
  Diagnostics ahead;
  check_run(build(spec, flex), spec, ahead);
  ASSERT_TRUE(ahead.has("run.unstiffened-spin"));
  int num_said = 0;
  const RunResult driven = run(spec, flex);
  for (const auto& item : driven.diagnostics.items()) num_said += item.id == "run.unstiffened-spin";
  EXPECT_EQ(num_said, 1);
  EXPECT_TRUE(std::ranges::any_of(driven.sink.events(), [](const auto& event) {
    return event.what.find("has no stiffening and turns at") != std::string::npos;
  }));
  spec.bodies[0].stiffening = true;
  EXPECT_FALSE(run(spec, flex).diagnostics.has("run.unstiffened-spin"));
}

TEST(Advice, FastModesThatExplicitStepsFollow) {
  records::FlexBody flex = make_point_body(2, 4).make_record("boom");
  flex.modal_mass.setIdentity();
  records::SystemSpec spec;
  records::BodyRecord boom;
  boom.name = "boom";
  boom.file = "boom.h5";
  spec.bodies = {boom};
  spec.simulation.duration = 1;
  spec.simulation.output_step = 0.1;
  for (const double frequency : {2000.0, 4000.0}) {
    flex.modal_stiffness = frequency * frequency * flex.modal_mass;
    for (const std::string integrator : {"adams", "rk", "bdf", "radau"}) {
      spec.simulation.integrator = integrator;
      Diagnostics diagnostics;
      const System system = draft_system(spec, {{"boom.h5", flex}}, diagnostics);
      check_run(system, spec, diagnostics);
      EXPECT_EQ(diagnostics.has("run.fast-modes"), frequency > 3000 && (integrator == "adams" || integrator == "rk"))
          << integrator << frequency;
      for (const auto& d : diagnostics.items()) {
        if (d.id == "run.fast-modes") EXPECT_THAT(d.what, HasSubstr("fastest mode of body 'boom'"));
      }
    }
  }
}

TEST(Advice, AutoChoosesByTheFastestMode) {
  auto spec = make_one_body(HingeType::Prismatic);
  spec.hinges[0].stiffness = {2 * 5000.0 * 5000.0};
  spec.hinges[0].damping = {100};
  spec.simulation.integrator = "auto";
  EXPECT_NEAR(calc_fastest_frequency(build(spec)), 5000, 1e-9);
  const RunResult stiff = run(spec);
  EXPECT_THAT(stiff.sink.header().settings,
              ::testing::Contains(std::pair<std::string, std::string>("integrator", "bdf")));
  ASSERT_TRUE(stiff.diagnostics.has("run.integrator-chosen"));
  EXPECT_THAT(format(stiff.diagnostics.items()[0]), HasSubstr("5000 rad per unit of time, 500 rad between samples"));
  spec.simulation.output_step = 0.01;
  EXPECT_THAT(run(spec).sink.header().settings,
              ::testing::Contains(std::pair<std::string, std::string>("integrator", "adams")));
}

}  // namespace
}  // namespace bough::solver::testing
