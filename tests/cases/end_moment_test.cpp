// Moments through hinges to second order: a strip under an end moment about its strong axis, cut into 1, 2, 4 bodies by
// fixed hinges, and a two-link arm with a motor at its elbow.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/cases/support/example.hpp"
#include "tests/support/beam_decks.hpp"

namespace bough::test {
namespace {

constexpr double kLength = 1;
// 20 mm x 1 mm of aluminium, upright in the xy-plane: √(EI2 GJ) = 0.145 N m².
const Section kStrip = {7e10, 7e10 / 2.6, 2700, 2e-5, 6.66667e-10, 1.66667e-12, 6.66667e-12};

/// CBEAM: a section has inertia about the axis, without which no mode twists.
records::Deck make_deck(double length, int num_elements) {
  DeckMaker maker;
  maker.add_section(1, kStrip, true);
  maker.add_line(1, 1, Vector3d::Zero(), length * Vector3d::UnitX(), num_elements, Vector3d::UnitY());
  maker.fix(1, 123456);
  return maker.deck;
}

/// The strip in parts, clamped; at its tip a light bar upright in y whose ends are pulled by a couple of dead forces
/// along x: a moment about z.
Example make_strip(int num_parts, bool interface_moments) {
  const int num_elements = 24 / num_parts, outer = num_elements + 1;
  records::BodySpec spec;
  spec.name = "part";
  spec.basis = records::BodyBasis::CraigBampton;
  spec.num_modes = 12;
  spec.interface_nodes = {outer};
  spec.interface_moments = interface_moments;
  spec.output_nodes = {1, outer};
  Example example;
  example.flex = {{"part.h5", reduce(make_deck(kLength / num_parts, num_elements), spec)}};
  records::HingeRecord joint;
  joint.type = records::HingeType::Fixed;
  joint.parent = "ground";
  for (int i = 0; i <= num_parts; ++i) {
    records::BodyRecord part;
    part.name = i < num_parts ? "part" + std::to_string(i) : "bar";
    if (i < num_parts) {
      part.file = "part.h5";
    } else {
      part.mass = 1e-4;
      part.inertia = 1e-7 * Eigen::Matrix3d::Identity();
      part.nodes = {{1, {0, 0.5, 0}}, {2, {0, -0.5, 0}}};
    }
    example.spec.bodies.push_back(part);
    joint.name = "joint" + std::to_string(i);
    joint.child = part.name;
    example.spec.hinges.push_back(joint);
    joint.parent = part.name;
    joint.parent_node = outer;
  }
  return example;
}

/// Lowest eigenvalue of -∂u̇/∂q at the equilibrium under the moment.
double calc_lowest_eigenvalue(Example& example, double moment) {
  example.spec.forces.clear();
  for (const int end : {1, 2}) {
    records::ForceRecord pull;
    pull.name = "pull" + std::to_string(end);
    pull.kind = records::ForceKind::Force;
    pull.frame = records::VectorFrame::Inertial;
    pull.body = "bar";
    pull.node = end;
    pull.direction = {end == 1 ? -moment : moment, 0, 0};
    if (moment != 0) example.spec.forces.push_back(pull);
  }
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
  // Steps of one size of energy: a unit of a mode of rotary inertia turns the thin strip by 1e4 rad.
  VectorXd size = VectorXd::Constant(n, 1e-9);
  for (int step = 0; step < 4; ++step) {
    for (int j = 0; j < n; ++j) {
      const VectorXd h = size(j) * VectorXd::Unit(n, j);
      A.col(j) = -(calc(q + h) - calc(q - h)) / (2 * size(j));
    }
    size = 1e-4 * A.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
    q += A.fullPivLu().solve(calc(q));
  }
  return A.eigenvalues().real().minCoeff();
}

// EI2 θ_y' = M (φ - φ(L)), GJ φ' = -M θ_y: the couple follows the twist of the tip and not its slope, so cos(kL) = 0
// with k = M/√(EI2 GJ), M = (π/2) √(EI2 GJ)/L. It neglects the bend in the strong plane: EI2/EI1 = 0.25 %, GJ/EI1 = 0.4
// %.
TEST(EndMoment, LateralTorsionalBucklingDoesNotDependOnTheCuts) {
  const double exact = std::acos(0.0) * std::sqrt(kStrip.E * kStrip.I2 * kStrip.G * kStrip.J) / kLength;
  const auto find_critical = [&](Example example) {
    double low = 0.5 * exact, high = 1.5 * exact;
    EXPECT_GT(calc_lowest_eigenvalue(example, low), 0);
    EXPECT_LT(calc_lowest_eigenvalue(example, high), 0);
    while (high - low > 1e-4 * exact) {
      const double middle = (low + high) / 2;
      (calc_lowest_eigenvalue(example, middle) > 0 ? low : high) = middle;
    }
    return low / exact;
  };
  const double whole = find_critical(make_strip(1, true));
  record("whole", whole);
  EXPECT_NEAR(whole, 1, 0.01);
  for (const int num_parts : {2, 4}) {
    const double parts = find_critical(make_strip(num_parts, true));
    record("parts_" + std::to_string(num_parts), parts);
    EXPECT_NEAR(parts / whole, 1, 0.01) << num_parts;
    EXPECT_NEAR(parts, 1, 0.01) << num_parts;
  }
  // Without the second order of rotations the cuts and the tip let the moment through straight.
  Example first_order = make_strip(1, false);
  const double at_critical = calc_lowest_eigenvalue(first_order, exact),
               at_rest = calc_lowest_eigenvalue(first_order, 0);
  record("without_moments", at_critical / at_rest);
  EXPECT_GT(std::abs(at_critical / at_rest), 0.1);
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
  EXPECT_LT(record_energy_drift(sink, "energy_drift"), 1e-9);
}

}  // namespace
}  // namespace bough::test
