// Energy and momentum of whole runs with stiffening on; order-n accelerations against the dense solve along them.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/cases/support/example.hpp"

namespace bough::test {
namespace {

/// Largest relative difference of the two routes to u̇ at the checkpoints of a run.
double compare_with_dense(const Example& example, const solver::MemorySink& sink) {
  const solver::System system = example.build();
  auto data = system.make_data();
  VectorXd u_dot(system.num_u()), dense(system.num_u());
  double worst = 0;
  for (const auto& checkpoint : sink.checkpoints()) {
    const VectorXd q = checkpoint.state.head(system.num_q()),
                   u = checkpoint.state.segment(system.num_q(), system.num_u());
    calc_kinematics(system, *data, checkpoint.time, q, u);
    add_forces(system, *data, checkpoint.time);
    calc_accelerations(system, *data, checkpoint.time, u_dot);
    calc_kinematics(system, *data, checkpoint.time, q, u);
    add_forces(system, *data, checkpoint.time);
    calc_accelerations_dense(system, *data, checkpoint.time, dense);
    worst = std::max(worst, (u_dot - dense).norm() / dense.norm());
  }
  return worst;
}

TEST(TwoLink, EnergyIsConservedAndBothRoutesAgree) {
  Example example = load_example("ex03-two-link", "two-link.toml");
  example.spec.simulation.relative_tolerance = 1e-12;
  example.spec.simulation.absolute_tolerance = 1e-13;
  example.spec.simulation.integrator = "rk";
  solver::MemorySink sink;
  EXPECT_TRUE(example.run(sink).completed);
  const VectorXd balance = calc_energy_balance(sink);
  const double scale = sink.get("/energy/kinetic").maxCoeff();
  EXPECT_GT(scale, 1);
  EXPECT_GT(sink.get("/energy/strain").maxCoeff(), 1e-4);
  const double drift = (balance.array() - balance[0]).abs().maxCoeff() / scale;
  record("energy_drift", drift);
  EXPECT_LT(drift, 1e-9);
  ASSERT_GE(sink.checkpoints().size(), 5u);
  const double difference = compare_with_dense(example, sink);
  record("order_n_against_dense", difference);
  EXPECT_LT(difference, 1e-10);
}

TEST(FreeFlyer, EnergyAndMomentumAreConserved) {
  Example example = load_example("ex04-free-flyer", "free-flyer.toml");
  ASSERT_TRUE(example.spec.bodies[0].stiffening);
  example.spec.simulation.integrator = "rk";
  example.spec.simulation.relative_tolerance = 1e-12;
  example.spec.simulation.absolute_tolerance = 1e-13;
  solver::MemorySink sink;
  EXPECT_TRUE(example.run(sink).completed);
  EXPECT_EQ(sink.time()[sink.num_samples() - 1], 5);
  const VectorXd balance = calc_energy_balance(sink);
  const double drift = (balance.array() - balance[0]).abs().maxCoeff() / balance[0];
  record("energy_drift", drift);
  EXPECT_LT(drift, 1e-9);
  // The modes do exchange energy with the rigid motion.
  EXPECT_GT(sink.get("/energy/strain").maxCoeff() - sink.get("/energy/strain").minCoeff(), 1e-3 * balance[0]);
  for (const std::string part : {"linear", "angular"}) {
    const MatrixXd p = sink.get("/momentum/" + part);
    ASSERT_GT(p.row(0).norm(), 0.1);
    const double change = (p.rowwise() - p.row(0)).rowwise().norm().maxCoeff() / p.row(0).norm();
    record(part + "_momentum_drift", change);
    EXPECT_LT(change, 1e-9) << part;
  }
  const double difference = compare_with_dense(example, sink);
  record("order_n_against_dense", difference);
  EXPECT_LT(difference, 1e-10);
}

}  // namespace
}  // namespace bough::test
