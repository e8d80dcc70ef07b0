// Mechanisms that pass positions in which more dofs open for an instant, and long chains of loops.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

records::BodyRecord make_rod(const std::string& name, double mass) {
  records::BodyRecord rod;
  rod.name = name;
  rod.mass = mass;
  rod.cg = {0.5, 0, 0};
  rod.inertia = Vector3d(1e-3 * mass, mass / 12, mass / 12).asDiagonal();
  rod.nodes = {{1, {1, 0, 0}}};
  return rod;
}

double get_mass(int k, bool is_even) { return is_even ? 1 : 1 + std::fmod(0.7 * k * k, 3); }

/// IFToMM A02: N + 1 rockers of 1 m joined by N couplers, upright, the ends at 1 m/s.
records::SystemSpec make_n_four_bar(int N, bool is_even = true) {
  records::SystemSpec spec;
  const double upright = std::acos(-1.0) / 2;
  for (int k = 0; k <= N; ++k) {
    const std::string id = std::to_string(k);
    spec.bodies.push_back(make_rod("rocker" + id, get_mass(k, is_even)));
    auto pin = make_hinge_record("rocker" + id, HingeType::Revolute, "ground", "rocker" + id);
    pin.parent_position = {static_cast<double>(k), 0, 0};
    pin.position = {upright};
    pin.rate = {-1};
    spec.hinges.push_back(pin);
    if (k == N) continue;
    spec.bodies.push_back(make_rod("coupler" + id, 1));
    auto joint = make_hinge_record("coupler" + id, HingeType::Revolute, "rocker" + id, "coupler" + id);
    joint.parent_node = 1;
    joint.position = {-upright};
    joint.rate = {1};
    spec.hinges.push_back(joint);
    records::ConstraintRecord c;
    c.name = "pin" + id;
    c.hinge = HingeType::Revolute;
    c.parent = "coupler" + id;
    c.parent_node = c.child_node = 1;
    c.child = "rocker" + std::to_string(k + 1);
    spec.constraints.push_back(c);
  }
  spec.simulation.gravity = {0, -9.81, 0};
  spec.simulation.duration = 10;
  spec.simulation.output_step = 0.05;
  spec.simulation.integrator = "rk";
  spec.simulation.at = {"chain.toml", 50, 1};
  return spec;
}

/// The largest errors of energy, by its closed form at the first rocker's angle, and of the others' angles.
struct Errors {
  double energy = 0, spread = 0, turns = 0;
};
Errors calc_errors(const records::SystemSpec& spec, int N, bool is_even) {
  const RunResult r = run(spec);
  EXPECT_TRUE(r.outcome.completed);
  double inertia = N, weight = N;
  for (int k = 0; k <= N; ++k) {
    inertia += get_mass(k, is_even) / 3;
    weight += get_mass(k, is_even) / 2;
  }
  const double energy = 0.5 * inertia + 9.81 * weight;
  const MatrixXd q = r.sink.get("/hinges/rocker0/q"), rate = r.sink.get("/hinges/rocker0/qdot");
  Errors e;
  for (int k = 0; k < r.sink.num_samples(); ++k)
    e.energy = std::max(
        e.energy,
        std::abs(0.5 * inertia * rate(k, 0) * rate(k, 0) + 9.81 * weight * std::sin(q(k, 0)) - energy) / energy);
  for (int i = 1; i <= N; ++i) {
    const MatrixXd other = r.sink.get("/hinges/rocker" + std::to_string(i) + "/q");
    for (int k = 0; k < r.sink.num_samples(); ++k)
      e.spread = std::max(e.spread, std::abs(std::remainder(other(k, 0) - q(k, 0), 2 * std::acos(-1.0))));
  }
  e.turns = std::abs(q(r.sink.num_samples() - 1, 0) - q(0, 0)) / (2 * std::acos(-1.0));
  return e;
}

// Twice a turn all links lie in a line and a row of G vanishes in each loop.
TEST(ChangePoints, NFourBarByEveryTolerance) {
  for (const int N : {1, 3, 5}) {
    for (const bool is_even : {true, false}) {
      for (const double tolerance : {1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
        auto spec = make_n_four_bar(N, is_even);
        spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = tolerance;
        const Errors e = calc_errors(spec, N, is_even);
        EXPECT_LT(e.energy, 1e-7) << N << is_even << tolerance;
        EXPECT_LT(e.spread, 1e-9) << N << is_even << tolerance;
        EXPECT_GT(e.turns, 4) << N << is_even << tolerance;
      }
    }
  }
}

TEST(ChangePoints, NFourBarAtFixedSteps) {
  for (const double step : {1e-2, 3e-3, 1e-3}) {
    auto spec = make_n_four_bar(3, false);
    spec.simulation.integrator = "rk4";
    spec.simulation.step = step;
    const Errors e = calc_errors(spec, 3, false);
    EXPECT_LT(e.energy, 1e-9 + 10 * std::pow(step, 4)) << step;
    EXPECT_LT(e.spread, 1e-9) << step;
  }
}

// It starts flat, and every other sample is taken just when it is flat again: there rounding of the gap, 1e-15, leaves
// rates across the constraints open by 5e-15/θ² (1e-4 at the edge of what is left out); they go as it leaves.
TEST(ChangePoints, StartsFlat) {
  for (const double off : {0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4}) {
    auto spec = make_n_four_bar(2);
    for (int k = 0; k <= 2; ++k) {
      auto& rocker = spec.hinges[static_cast<size_t>(2 * k)];
      rocker.position = {off};
      rocker.rate = {-5};
      if (k == 2) continue;
      spec.hinges[static_cast<size_t>(2 * k + 1)].position = {-off};
      spec.hinges[static_cast<size_t>(2 * k + 1)].rate = {5};
    }
    spec.simulation.duration = 2;
    spec.simulation.gravity.setZero();  // flat again at k π/5
    spec.simulation.output_step = std::acos(-1.0) / 10;
    spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-10;
    const RunResult r = run(spec);
    EXPECT_TRUE(r.outcome.completed) << off;
    const MatrixXd rate = r.sink.get("/hinges/rocker0/qdot"), last = r.sink.get("/hinges/rocker2/qdot");
    for (int k = 0; k + 1 < r.sink.num_samples(); ++k) {
      EXPECT_NEAR(rate(k, 0), -5, k % 2 == 0 ? 1e-3 : 1e-7) << off << " " << k;
      EXPECT_NEAR(last(k, 0), -5, k % 2 == 0 ? 1e-3 : 1e-7) << off << " " << k;
    }
  }
}

// Both wheels of a pair of gears driven, each its own way: nothing is left that could close it.
TEST(Drivers, TwoOfOneCoordinateAreAnError) {
  records::SystemSpec spec;
  for (const std::string name : {"small", "large"}) {
    spec.bodies.push_back(make_rod(name, 1));
    spec.hinges.push_back(make_hinge_record(name, HingeType::Revolute, "ground", name));
    records::FunctionRecord f;
    f.name = name;
    f.type = "ramp";
    f.values = {{"value", name == "small" ? 1 : 2}, {"from", 0}, {"to", 1}};
    spec.functions.push_back(f);
    spec.hinges.back().motion = {name};
  }
  records::ConstraintRecord gear;
  gear.name = "gear";
  gear.type = records::ConstraintType::Coupler;
  gear.terms = {{"small", 1, 1}, {"large", 1, 3}};
  spec.constraints = {gear};
  spec.simulation.duration = 1;
  spec.simulation.integrator = "rk";
  try {
    run(spec);
    FAIL();
  } catch (const Failure& error) {
    const std::string id = error.items().at(0).id;
    EXPECT_TRUE(id == "run.open-constraint" || id == "system.cannot-assemble") << id;
  }
  // With the ratio of the gears they agree.
  spec.functions[1].values["value"] = -1.0 / 3;
  EXPECT_TRUE(run(spec).outcome.completed);
}

// Forty loops in a chain, as in the IFToMM library: each row of A is coupled to its neighbours only.
TEST(ChangePoints, FortyLoopsInOneChain) {
  auto spec = make_n_four_bar(40);
  spec.simulation.duration = 2;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-8;
  const System system = build(spec);
  auto data = system.make_data();
  ASSERT_EQ(data->loops.blocks.size(), 1u);
  EXPECT_EQ(data->loops.blocks[0].factor.num_fronts(), 39);
  const Errors e = calc_errors(spec, 40, true);
  EXPECT_LT(e.energy, 1e-7);
  EXPECT_LT(e.spread, 1e-8);
  // Against the second route, where it falls.
  for (auto& hinge : spec.hinges) hinge.position[0] *= 0.6;
  const System leaning = build(spec);
  data = leaning.make_data();
  VectorXd q(leaning.num_q()), u(leaning.num_u()), dense(leaning.num_u());
  leaning.calc_initial_state(q, u);
  const VectorXd u_dot = calc_u_dot(leaning, *data, 0, q, u);
  calc_accelerations_dense(leaning, *data, 0, dense);
  EXPECT_GT(dense.norm(), 1);
  EXPECT_LT((u_dot - dense).norm(), 1e-9 * dense.norm());
}

}  // namespace
}  // namespace bough::solver::testing
