// Whole runs: closed-form motions with every integrator, energy against work, jumps, restart, failures.
#include "solver/simulate/simulate.hpp"
#include "solver/builder/build_system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;
using ::testing::HasSubstr;

records::SystemSpec make_body(HingeType type) {
  auto spec = make_one_body(type);
  spec.simulation.duration = 3;
  return spec;
}

/// A spring on a slide: 2 ẍ = -18 x - c ẋ, x(0) = 0.5.
records::SystemSpec make_oscillator(double damping = 0) {
  auto spec = make_spring_mass();
  spec.simulation.duration = 3;
  spec.hinges[0].damping = {damping};
  return spec;
}

VectorXd calc_energy_balance(const MemorySink& sink) {
  return sink.get("/energy/kinetic") + sink.get("/energy/strain") + sink.get("/energy/potential") -
         sink.get("/energy/work");
}

TEST(Simulate, OscillatorWithEveryIntegrator) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4"}) {
    auto spec = make_oscillator();
    spec.simulation.integrator = integrator;
    spec.simulation.relative_tolerance = 1e-9;
    spec.simulation.absolute_tolerance = 1e-10;
    spec.simulation.step = integrator == "rk4" ? 0.002 : 0;
    const RunResult r = run(spec);
    EXPECT_TRUE(r.outcome.completed);
    EXPECT_TRUE(r.sink.completed());
    const VectorXd t = r.sink.time();
    ASSERT_EQ(t.size(), 31);
    const VectorXd x = r.sink.get("/hinges/hinge/q");
    double worst = 0;
    for (int i = 0; i < t.size(); ++i) worst = std::max(worst, std::abs(x[i] - 0.5 * std::cos(3 * t[i])));
    EXPECT_LT(worst, integrator == "bdf" ? 1e-6 : 2e-7) << integrator;
    EXPECT_LT(std::abs(r.outcome.last.energy_error), 3e-6) << integrator;
    EXPECT_GT(r.outcome.last.num_steps, 10);
    EXPECT_EQ(r.outcome.last.time, 3);
  }
}

TEST(Simulate, ErrorShrinksWithTheTolerance) {
  for (const std::string integrator : {"adams", "rk"}) {
    double last = 1;
    for (double tolerance : {1e-5, 1e-7, 1e-9, 1e-11}) {
      auto spec = make_oscillator();
      spec.simulation.integrator = integrator;
      spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = tolerance;
      spec.simulation.output_step = 1.5;  // rk ends its steps on the outputs: close ones would hide the tolerance
      const RunResult r = run(spec);
      const VectorXd t = r.sink.time(), x = r.sink.get("/hinges/hinge/q");
      const double error = (x.array() - 0.5 * (3 * t.array()).cos()).abs().maxCoeff();
      EXPECT_LT(error, last / 5) << integrator << " " << tolerance;
      last = std::max(error, 1e-13);
    }
  }
}

TEST(Simulate, Rk4HasOrderFourOnASpinningTop) {
  const auto solve = [](double step) {
    auto spec = make_body(HingeType::Free);
    spec.hinges[0].rate = {0.3, 2, 0.1, 0, 0, 0};  // angular velocity first
    spec.simulation.integrator = "rk4";
    spec.simulation.step = step;
    spec.simulation.output_step = 1;
    return VectorXd(run(spec).sink.get("/bodies/body/quaternion").bottomRows(1).transpose());
  };
  const VectorXd a = solve(0.02), b = solve(0.01), c = solve(0.005);
  EXPECT_NEAR(std::log2((a - b).norm() / (b - c).norm()), 4, 0.15);
}

// The quaternion's length is not controlled by the equations; it must not drift with the number of turns.
TEST(Simulate, OrientationStaysARotation) {
  auto spec = make_body(HingeType::Free);
  spec.hinges[0].rate = {0, 0, 5, 0, 0, 0};
  spec.simulation.duration = 40;
  spec.simulation.output_step = 1;
  spec.simulation.relative_tolerance = 1e-10;
  const RunResult r = run(spec);
  const MatrixXd q = r.sink.get("/bodies/body/quaternion");
  for (int i = 0; i < q.rows(); ++i) {
    EXPECT_NEAR(q.row(i).norm(), 1, 1e-14);
    EXPECT_NEAR(std::abs(q(i, 0)), std::abs(std::cos(2.5 * i)), 1e-6);
  }
  const MatrixXd raw = r.sink.get("/hinges/hinge/q");
  for (int i = 0; i < raw.rows(); ++i) EXPECT_NEAR(raw.row(i).head(4).norm(), 1, 1e-6);
}

TEST(Simulate, EnergyLessWorkIsConstant) {
  // A damped pendulum driven by a prescribed slide and pushed by a force, with flexible bodies in random trees beside
  // it.
  RandomTreeOptions options;
  options.num_bodies = 5;
  for (unsigned seed : {3u, 8u}) {
    RandomTree tree = make_random_tree(seed, options);
    tree.spec.simulation.duration = 1;
    tree.spec.simulation.output_step = 0.1;
    tree.spec.simulation.integrator = "rk";
    tree.spec.simulation.relative_tolerance = 1e-11;
    tree.spec.simulation.absolute_tolerance = 1e-12;
    const RunResult r = run(tree.spec, tree.flex);
    const VectorXd balance = calc_energy_balance(r.sink);
    const double scale = r.sink.get("/energy/kinetic").maxCoeff() + r.sink.get("/energy/work").cwiseAbs().maxCoeff();
    EXPECT_GT(r.sink.get("/energy/work").cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_LT((balance.array() - balance[0]).abs().maxCoeff(), 1e-9 * scale) << seed;
    EXPECT_LT(std::abs(r.outcome.last.energy_error), 1e-9);
  }
}

TEST(Simulate, DampingIsLostWork) {
  auto spec = make_oscillator(3);
  spec.simulation.relative_tolerance = 1e-10;
  const RunResult r = run(spec);
  const VectorXd work = r.sink.get("/energy/work"), t = r.sink.time(), x = r.sink.get("/hinges/hinge/q");
  EXPECT_LT(work[30], -0.9 * 0.5 * 18 * 0.25);
  for (int i = 1; i < work.size(); ++i) EXPECT_LE(work[i], work[i - 1] + 1e-12);
  // x = e^{-δt}(cos νt + δ/ν sin νt)/2, δ = c/2m.
  const double d = 0.75, nu = std::sqrt(9 - d * d);
  for (int i = 0; i < t.size(); ++i)
    EXPECT_NEAR(x[i], 0.5 * std::exp(-d * t[i]) * (std::cos(nu * t[i]) + d / nu * std::sin(nu * t[i])), 1e-8);
}

// A pulse between two output times: the velocity it leaves is F width / m to rounding, since steps end on both jumps.
TEST(Simulate, PulseIsHitByEveryIntegrator) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4"}) {
    auto spec = make_body(HingeType::Free);
    spec.functions = {make_function("pulse", "pulse", {{"value", 7}, {"at", 1.03}, {"width", 0.005}})};
    spec.forces = {make_force("push", "body", {1, 0, 0}, "pulse")};
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 0.1 : 0;
    const RunResult r = run(spec);
    const MatrixXd v = r.sink.get("/bodies/body/velocity"), p = r.sink.get("/bodies/body/position");
    EXPECT_EQ(v(10, 0), 0);
    EXPECT_NEAR(v(30, 0), 7 * 0.005 / 2, 1e-14) << integrator;
    EXPECT_NEAR(p(30, 0), 7 * 0.005 / 2 * (3 - 1.03 - 0.0025), 1e-9) << integrator;
    EXPECT_NEAR(r.sink.get("/energy/work")(30, 0), std::pow(7 * 0.005, 2) / 4, 7 * 1e-9) << integrator;  // F × position
  }
}

TEST(Simulate, ResumedRunEqualsTheWholeOne) {
  for (const std::string integrator : {"rk4", "adams", "rk"}) {
    auto spec = make_oscillator(0.3);
    spec.simulation.gravity = {0, 0, -1};
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 0.03 : 0;  // does not divide 0.1: adjusted
    spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-10;
    const RunResult whole = run(spec);

    std::atomic<bool> stop{false};
    SimulateOptions options;
    options.stop = &stop;
    options.progress = [&](const Progress& p) { stop = p.time > 1.25; };
    const RunResult first = run(spec, {}, options);
    EXPECT_FALSE(first.outcome.completed);
    EXPECT_FALSE(first.sink.completed());
    EXPECT_THAT(first.sink.reason(), ::testing::HasSubstr("stopped on request at t = 1.3"));
    ASSERT_FALSE(first.sink.checkpoints().empty());
    EXPECT_EQ(first.sink.checkpoints().back().time, first.sink.time()[13]);
    EXPECT_EQ(first.sink.num_samples(), 14);

    SimulateOptions resume;
    resume.resume = first.sink.checkpoints().back();
    const RunResult second = run(spec, {}, resume);
    EXPECT_TRUE(second.outcome.completed);
    ASSERT_EQ(second.sink.num_samples(), 17);
    EXPECT_EQ(second.sink.time()[0], whole.sink.time()[14]);
    for (const std::string channel : {"/hinges/hinge/q", "/hinges/hinge/qdot", "/energy/work"}) {
      const VectorXd a = whole.sink.get(channel).bottomRows(17), b = second.sink.get(channel);
      const double difference = (a - b).cwiseAbs().maxCoeff();
      if (integrator == "rk4")
        EXPECT_EQ(difference, 0) << channel;
      else
        EXPECT_LT(difference, 1e-7) << integrator << channel;
    }
    EXPECT_NEAR(second.outcome.last.energy_error, whole.outcome.last.energy_error, 1e-7);
  }
}

TEST(Simulate, ForeignCheckpointIsRefused) {
  SimulateOptions options;
  options.resume = records::Checkpoint{0.15, VectorXd::Zero(3)};
  try {
    run(make_oscillator(), {}, options);
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_EQ(e.items()[0].id, "run.bad-checkpoint");
  }
}

TEST(Simulate, DivergenceKeepsTheSamplesAndNamesTheBody) {
  auto spec = make_oscillator(-40);  // a negative damper
  spec.simulation.divergence_limit = 1e3;
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4"}) {
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 0.01 : 0;
    MemorySink sink;
    Diagnostics diagnostics;
    const System system = build(spec);
    try {
      simulate(system, spec, sink, {}, diagnostics);
      ADD_FAILURE() << integrator;
    } catch (const ComputationError& e) {
      EXPECT_EQ(e.exit_code(), 3);
      EXPECT_EQ(e.items()[0].id, "run.diverged");
      EXPECT_THAT(e.items()[0].what, ::testing::HasSubstr("body 'body' (hinge"));
      EXPECT_THAT(e.items()[0].what, ::testing::HasSubstr("at t = "));
      EXPECT_EQ(e.items()[0].where.line, 20);
    }
    EXPECT_TRUE(sink.ended());
    EXPECT_FALSE(sink.completed());
    EXPECT_GT(sink.num_samples(), 2) << integrator;
    EXPECT_LT(sink.num_samples(), 31) << integrator;
    EXPECT_TRUE(sink.get("/hinges/hinge/q").allFinite());
    EXPECT_EQ(sink.events().size(), 1u);
  }
}

TEST(Simulate, UnreachableToleranceStalls) {
  // Far below rounding.
  auto spec = make_oscillator();
  spec.simulation.relative_tolerance = 1e-30;
  spec.simulation.absolute_tolerance = 1e-30;
  MemorySink sink;
  EXPECT_EQ(run_to_failure<ComputationError>(spec, sink)[0].id, "run.stalled");
  EXPECT_FALSE(sink.completed());
}

// The message says how short the steps are, what asks for them, and what to do.
TEST(Simulate, AStallNamesTheStateThatStiffens) {
  for (const std::string integrator : {"rk", "adams", "bdf"}) {
    auto spec = make_oscillator();
    add_copy(spec, "quick", "spring");
    spec.hinges[1].stiffness = {1e8};
    spec.simulation.integrator = integrator;
    spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-30;
    try {
      run(spec);
      ADD_FAILURE() << integrator;
    } catch (const ComputationError& e) {
      const Diagnostic& d = e.items().at(0);
      EXPECT_EQ(d.id, "run.stalled");
      EXPECT_THAT(d.what, HasSubstr("the integrator makes no progress at t = ")) << integrator;
      EXPECT_THAT(d.what,
                  ::testing::MatchesRegex(".*; it is body 'quick' .hinge (rate|coordinate) 1. that asks for them most"))
          << integrator;
      if (integrator == "rk") {
        EXPECT_THAT(d.what, HasSubstr(": steps of "));
        EXPECT_THAT(d.what, HasSubstr(" tolerances; it is"));
      }
      EXPECT_THAT(d.advice, HasSubstr(integrator == "bdf" ? "leave out the fastest modes" : "integrator = \"bdf\""));
      EXPECT_EQ(d.where.file, "system.toml");
    }
  }
}

TEST(Simulate, SensorFaultsStopARunBeforeItStarts) {
  auto spec = make_oscillator();
  records::SensorRecord s;
  s.name = "s";
  s.body = "boby";
  spec.sensors = {s};
  spec.simulation.integrator = "euler";
  MemorySink sink;
  Diagnostics diagnostics;
  EXPECT_THROW(build(spec), InputError);
  const System system = draft_system(spec, {}, diagnostics);
  EXPECT_THROW(simulate(system, spec, sink, {}, diagnostics), InputError);
  EXPECT_TRUE(diagnostics.has("sensor.unknown-body"));
  EXPECT_TRUE(diagnostics.has("run.unknown-integrator"));
  EXPECT_TRUE(sink.header().channels.empty());
}

TEST(Simulate, LargeDeflectionIsReportedOncePerBody) {
  const PointBody points = make_point_body(2, 5, 0.01);
  records::SystemSpec spec = make_body(HingeType::Fixed);
  spec.bodies[0].file = "points.h5";
  spec.bodies[0].eta = {0.8, 0};
  spec.simulation.duration = 1;
  const RunResult r = run(spec, {{"points.h5", points.make_record("points")}});
  EXPECT_EQ(r.diagnostics.num_warnings(), 1);
  EXPECT_TRUE(r.diagnostics.has("run.linear-limit"));
  ASSERT_EQ(r.sink.events().size(), 1u);
  EXPECT_EQ(r.sink.events()[0].time, 0);
  EXPECT_THAT(r.sink.events()[0].what, ::testing::HasSubstr("body 'body' deflects by"));
  spec.bodies[0].eta = {1e-3, 0};
  EXPECT_EQ(run(spec, {{"points.h5", points.make_record("points")}}).diagnostics.num_warnings(), 0);
}

TEST(Simulate, HeaderListsTheChannels) {
  auto spec = make_oscillator();
  spec.text = "# the file";
  const RunResult r = run(spec);
  std::vector<std::string> paths;
  for (const auto& c : r.sink.header().channels) {
    paths.push_back(c.path);
    EXPECT_FALSE(c.description.empty());
    EXPECT_FALSE(c.dims.empty());
  }
  EXPECT_THAT(paths, ::testing::ElementsAre("/time", "/bodies/body/position", "/bodies/body/quaternion",
                                            "/bodies/body/velocity", "/bodies/body/angular_velocity", "/hinges/hinge/q",
                                            "/hinges/hinge/qdot", "/hinges/hinge/force", "/hinges/hinge/reaction_force",
                                            "/hinges/hinge/reaction_moment", "/energy/kinetic", "/energy/strain",
                                            "/energy/potential", "/energy/work", "/energy/dissipated",
                                            "/momentum/linear", "/momentum/angular", "/system_mass/mass",
                                            "/system_mass/cg", "/system_mass/inertia"));
  EXPECT_EQ(r.sink.header().system_text, "# the file");
  EXPECT_THAT(r.sink.header().settings,
              ::testing::Contains(std::pair<std::string, std::string>("integrator", "adams")));
}

}  // namespace
}  // namespace bough::solver::testing
