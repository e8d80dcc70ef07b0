// Moments through hinges to second order: a strip under an end moment about its strong axis, cut into 1, 2, 4 bodies by
// fixed hinges, and a two-link arm with a motor at its elbow.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/cases/support/example.hpp"
#include "tests/support/beam_decks.hpp"

namespace bough::test {
namespace {

constexpr double kLength = 1;
// 20 mm x 1 mm of aluminium, upright in the xy-plane: √(E I2 G J) = 0.145 N m².
const Section kStrip = {7e10, 7e10 / 2.6, 2700, 2e-5, 6.66667e-10, 1.66667e-12, 6.66667e-12};

/// Lowest eigenvalue of -∂u̇/∂q at the equilibrium under a moment about z at the tip.
double calc_lowest_eigenvalue(int num_bodies, double moment, bool interface_moments) {
  const int num_elements = 24 / num_bodies, outer = num_elements + 1;
  DeckMaker maker = make_cantilever(kStrip, kLength / num_bodies, num_elements);
  records::BodySpec spec;
  spec.name = "part";
  spec.basis = records::BodyBasis::CraigBampton;
  spec.num_modes = 6;
  spec.interface_nodes = {outer};
  spec.interface_moments = interface_moments;
  spec.output_nodes = {1, outer};
  Example example;
  example.flex = {{"part.h5", reduce(maker.deck, spec)}};
  for (int i = 0; i < num_bodies; ++i) {
    records::BodyRecord part;
    part.name = "part" + std::to_string(i);
    part.file = "part.h5";
    example.spec.bodies.push_back(part);
    records::HingeRecord hinge;
    hinge.name = "joint" + std::to_string(i);
    hinge.type = records::HingeType::Fixed;
    hinge.child = part.name;
    hinge.parent = i == 0 ? "ground" : "part" + std::to_string(i - 1);
    hinge.parent_node = i == 0 ? 0 : outer;
    example.spec.hinges.push_back(hinge);
  }
  records::ForceRecord push;
  push.name = "moment";
  push.kind = records::ForceKind::Moment;
  push.frame = records::VectorFrame::Inertial;
  push.body = example.spec.bodies.back().name;
  push.node = outer;
  push.direction = {0, 0, moment};
  if (moment != 0) example.spec.forces = {push};

  const solver::System system = example.build();
  auto data = system.make_data();
  const int n = system.num_u();
  VectorXd q = VectorXd::Zero(n), u = q;
  const auto calc = [&](const VectorXd& at) {
    VectorXd u_dot(n);
    calc_kinematics(system, *data, 0, at, u);
    add_forces(system, *data, 0);
    calc_accelerations(system, *data, 0, u_dot);
    return u_dot;
  };
  MatrixXd A(n, n);
  for (int step = 0; step < 4; ++step) {
    for (int j = 0; j < n; ++j) {
      const VectorXd h = 1e-6 * VectorXd::Unit(n, j);
      A.col(j) = -(calc(q + h) - calc(q - h)) / 2e-6;
    }
    q += A.fullPivLu().solve(calc(q));
  }
  return A.eigenvalues().real().minCoeff();
}

TEST(EndMoment, LateralTorsionalSofteningDoesNotDependOnTheCuts) {
  const double moment = 0.15;
  const double at_rest = calc_lowest_eigenvalue(1, 0, true), whole = calc_lowest_eigenvalue(1, moment, true);
  record("at_rest", at_rest);
  record("whole", whole);
  EXPECT_GT(std::abs(whole / at_rest - 1), 0.05);  // the moment matters
  for (const int num_bodies : {2, 4}) {
    const double parts = calc_lowest_eigenvalue(num_bodies, moment, true);
    record("parts_" + std::to_string(num_bodies), parts);
    EXPECT_NEAR(parts / whole, 1, 0.01) << num_bodies;
    record("without_moments_" + std::to_string(num_bodies), calc_lowest_eigenvalue(num_bodies, moment, false));
  }
}

TEST(EndMoment, MotorsOfTheTwoLinkArmBalanceTheEnergy) {
  Example example = load_example("ex03-two-link", "two-link.toml");
  records::FunctionRecord torque;
  torque.name = "torque";
  torque.type = "sine";
  torque.values = {{"amplitude", 0.5}, {"frequency_hz", 1.3}};
  example.spec.functions.push_back(torque);
  const auto add_moment = [&](const std::string& name, const std::string& body, int node, double sign) {
    records::ForceRecord force;
    force.name = name;
    force.kind = records::ForceKind::Moment;
    force.body = body;
    force.node = node;
    force.direction = {0, 0, sign};
    force.function = "torque";
    example.spec.forces.push_back(force);
  };
  add_moment("shoulder", "upper", 0, 1);
  add_moment("elbow", "lower", 0, -1);
  add_moment("elbow_reaction", "upper", 11, 1);
  example.spec.simulation.duration = 2;
  example.spec.simulation.integrator = "rk";
  example.spec.simulation.relative_tolerance = 1e-12;
  example.spec.simulation.absolute_tolerance = 1e-13;
  solver::MemorySink sink;
  ASSERT_TRUE(example.run(sink).completed);
  ASSERT_GT(sink.get("/energy/work").cwiseAbs().maxCoeff(), 0.01);
  const VectorXd balance = calc_energy_balance(sink);
  const double drift = (balance.array() - balance[0]).abs().maxCoeff() / sink.get("/energy/kinetic").maxCoeff();
  record("energy_drift", drift);
  EXPECT_LT(drift, 1e-9);
}

}  // namespace
}  // namespace bough::test
