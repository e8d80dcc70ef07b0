// Forces out of balance at a point: round-off of forces in balance is none.
#include <gtest/gtest.h>

#include "solver/linear/plant.hpp"
#include "solver/tree/data.hpp"
#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {
namespace {

/// A mass on a vertical spring.
records::SystemSpec make_hanging_mass(double mass, double stiffness, double position) {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, 0, -9.81};
  spec.bodies = {make_body_record("bob", mass, {1, 1, 1})};
  spec.hinges = {make_hinge_record("slide", records::HingeType::Prismatic, "ground", "bob")};
  spec.hinges[0].stiffness = {stiffness};
  spec.hinges[0].position = {position};
  return spec;
}

// At q = -m g / k the spring and the weight differ by their rounding alone: exactly 0 is left of them. A force of 1e-12
// of the weight is above it, and stays.
TEST(Imbalance, RoundoffOfForcesInBalanceIsZero) {
  int num_rounded = 0;
  for (int i = 1; i <= 20; ++i) {
    const double m = 0.1 * i, k = 3 + 0.7 * i, weight = m * 9.81;
    const System system = build(make_hanging_mass(m, k, -weight / k));
    auto data = system.make_data();
    const VectorXd zero = VectorXd::Zero(1);
    calc_u_dot(system, *data, 0, VectorXd::Constant(1, -weight / k), zero);
    const double rest = calc_imbalance(system.tree, data->tree, zero).force[0];
    EXPECT_LT(std::abs(rest), 1e-15 * weight);
    num_rounded += rest != 0 ? 1 : 0;

    Plant plant(system);
    auto point = plant.make_initial_point();
    plant.evaluate(point);
    EXPECT_EQ(plant.calc_imbalance()[0], 0) << i;
    point.q[0] *= 1 + 1e-12;
    plant.evaluate(point);
    EXPECT_NEAR(plant.calc_imbalance()[0], 1e-12 * weight, 1e-15 * weight) << i;
  }
  EXPECT_GT(num_rounded, 2);
}

}  // namespace
}  // namespace bough::solver::testing
