// Equilibria of what controllers keep (hidden states, integrals of rates, samples), and multipliers of samples that
// wait for others, against statics and maps by hand.
#include "solver/linear/equilibrium.hpp"
#include "solver/linear/linearize.hpp"
#include "tests/solver/control/support.hpp"

namespace bough::solver::testing {
namespace {

constexpr double kMass = 1.5, kPull = 4, kDamping = 2, kWeight = kMass * kPull;

/// A mass on a rail that gravity pulls back, with sensors x and v and a drive that follows "law".
records::SystemSpec make_rail(double stiffness) {
  records::SystemSpec spec;
  records::BodyRecord body;
  body.name = "cart";
  body.mass = kMass;
  spec.bodies = {body};
  spec.hinges = {make_hinge_record("rail", records::HingeType::Prismatic, "ground", "cart")};
  spec.hinges[0].axis = {1, 0, 0};
  spec.hinges[0].stiffness = {stiffness};
  spec.hinges[0].damping = {kDamping};
  spec.sensors = {make_sensor("x", records::SensorType::HingeAngle, "", "rail"),
                  make_sensor("v", records::SensorType::HingeRate, "", "rail")};
  spec.actuators = {make_drive("drive", "rail", "law")};
  spec.simulation.gravity = {-kPull, 0, 0};
  spec.simulation.duration = 40;
  spec.simulation.output_step = 1;
  spec.simulation.at = {"system.toml", 20, 1};
  return spec;
}

Equilibrium find(const records::SystemSpec& spec) {
  const System system = build(spec);
  Plant plant(system);
  return find_equilibrium(plant, plant.make_initial_point(), {"system.toml"});
}

double run_to_rest(const records::SystemSpec& spec) {
  const MatrixXd q = run(spec).sink.get("/hinges/rail/q");
  return q(q.rows() - 1, 0);
}

TEST(EquilibriumOfLaws, APidWithoutAnIntegralHoldsByItsGain) {
  auto spec = make_rail(0);
  spec.controllers = {make_law("law", "pid", {"x"}, {{"kp", {25}}})};
  const auto found = find(spec);
  EXPECT_NEAR(found.point.q[0], -kWeight / 25, 1e-10);
  EXPECT_TRUE(found.unstable.empty());
  EXPECT_EQ(found.point.z.size(), 0);
  EXPECT_NEAR(run_to_rest(spec), found.point.q[0], 1e-6);
}

TEST(EquilibriumOfLaws, AStateThatNothingChangesStays) {
  auto spec = make_rail(0);
  records::ControllerRecord kept = make_law("kept", "state_space", {"x"}, {{"initial", {3}}});
  kept.settings.matrices = {{"A", MatrixXd::Zero(1, 1)}, {"B", MatrixXd::Zero(1, 1)}, {"C", MatrixXd::Identity(1, 1)}};
  spec.controllers = {kept, make_law("gain", "gain", {"x"}, {{"gain", {-25}}}),
                      make_law("law", "sum", {"kept", "gain"})};
  const auto found = find(spec);
  EXPECT_NEAR(found.point.q[0], (3 - kWeight) / 25, 1e-10);
  EXPECT_EQ(found.point.z[0], 3);
  EXPECT_EQ(found.kept, std::vector<std::string>{"controller 'kept' (state 1)"});
  EXPECT_NEAR(run_to_rest(spec), found.point.q[0], 1e-6);
}

TEST(EquilibriumOfLaws, AnIntegralOfARateIsADisplacement) {
  auto spec = make_rail(0);
  spec.hinges[0].position = {0.2};
  spec.controllers = {make_law("law", "transfer_function", {"v"}, {{"numerator", {-25}}, {"denominator", {1, 0}}})};
  const auto found = find(spec);
  EXPECT_NEAR(found.point.q[0], 0.2 - kWeight / 25, 1e-9);
  EXPECT_NE(found.point.z[0], 0);
  EXPECT_TRUE(found.kept.empty());
  EXPECT_TRUE(found.neutral.empty());
  EXPECT_NEAR(run_to_rest(spec), found.point.q[0], 1e-6);
}

TEST(EquilibriumOfLaws, TwoIntegralsOfOneErrorShareAsTheyGrow) {
  auto spec = make_rail(0);
  spec.controllers = {make_law("a", "pid", {"x"}, {{"kp", {20}}, {"ki", {2}}}),
                      make_law("b", "pid", {"x"}, {{"kp", {20}}, {"ki", {6}}}), make_law("law", "sum", {"a", "b"})};
  const auto found = find(spec);
  EXPECT_NEAR(found.point.q[0], 0, 1e-10);
  ASSERT_EQ(found.point.z.size(), 2);
  EXPECT_NEAR(found.point.z[0], kWeight / 4, 1e-8);
  EXPECT_NEAR(found.point.z[1], kWeight * 3 / 4, 1e-8);
}

TEST(EquilibriumOfLaws, ASampledLawHoldsWithAndWithoutASpring) {
  for (const double spring : {0.0, 12.0}) {
    auto spec = make_rail(spring);
    spec.controllers = {make_law("law", "pid", {"x"}, {{"kp", {25}}, {"sample_time", {0.02}}})};
    const auto found = find(spec);
    EXPECT_NEAR(found.point.q[0], -kWeight / (25 + spring), 1e-10);
    EXPECT_TRUE(found.unstable.empty());
    EXPECT_NEAR(run_to_rest(spec), found.point.q[0], 1e-6);
  }
}

TEST(EquilibriumOfLaws, ASampledIntegralBringsItToItsSetpoint) {
  auto spec = make_rail(12);
  spec.sensors[0].chain.numbers = {{"sample_time", {0.01}}, {"delay", {0.015}}, {"noise_density", {1e-3}}};
  spec.controllers = {
      make_law("law", "pid", {"x"},
               {{"kp", {25}}, {"ki", {10}}, {"setpoint", {0.3}}, {"sample_time", {0.02}}, {"delay", {0.005}}})};
  const auto found = find(spec);
  EXPECT_NEAR(found.point.q[0], 0.3, 1e-10);
  EXPECT_TRUE(found.unstable.empty());
  EXPECT_LT(found.residual, 1e-7);
}

TEST(EquilibriumOfLaws, ASampledLawThatIsTooSlowIsToldToBeUnstable) {
  auto spec = make_rail(12);
  spec.controllers = {make_law("law", "gain", {"x"}, {{"gain", {-60}}, {"sample_time", {0.4}}})};
  const auto found = find(spec);
  EXPECT_NEAR(found.point.q[0], -kWeight / 72, 1e-10);
  EXPECT_FALSE(found.unstable.empty());
}

/// [x; v] over a time with a force held: the last column is what the force does.
MatrixXd calc_flow(double stiffness, double time) {
  MatrixXd rates = MatrixXd::Zero(3, 3);
  rates << 0, 1, 0, -stiffness / kMass, -kDamping / kMass, 1 / kMass, 0, 0, 0;
  return (rates * time).exp();
}

std::vector<double> sort_sizes(const Eigen::VectorXcd& values) {
  std::vector<double> sizes;
  for (const auto& z : values)
    if (std::abs(z) > 1e-9) sizes.push_back(std::abs(z));
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

records::Multipliers calc(const records::SystemSpec& spec) {
  const System system = build(spec);
  Plant plant(system);
  Diagnostics diagnostics;
  return linearize(plant, plant.make_initial_point(), {}, {}, diagnostics).multipliers;
}

void expect_sizes(const records::Multipliers& found, const MatrixXd& map) {
  Eigen::VectorXcd values(found.real.size());
  values.real() = found.real;
  values.imag() = found.imag;
  const auto sizes = sort_sizes(values), wanted = sort_sizes(map.eigenvalues());
  ASSERT_EQ(sizes.size(), wanted.size());
  for (size_t i = 0; i < sizes.size(); ++i) EXPECT_NEAR(sizes[i], wanted[i], 1e-8);
}

// y[k] arrives after the law's sample k: u[k] = g y[k - 1]. Two samples are on their way: a cycle of two.
TEST(MultipliersOfChains, ADelayedSensorIsInTheLoop) {
  const double k = 30, g = -9, T = 0.08;
  auto spec = make_rail(k);
  spec.sensors[0].chain.numbers = {{"sample_time", {T}}, {"delay", {0.03}}};
  spec.controllers = {make_law("law", "gain", {"x"}, {{"gain", {g}}, {"sample_time", {T}}})};
  const MatrixXd flow = calc_flow(k, T);
  MatrixXd map = MatrixXd::Zero(3, 3);  // of [x; v; y before]
  map.topLeftCorner(2, 2) = flow.topLeftCorner(2, 2);
  map.topRightCorner(2, 1) = g * flow.topRightCorner(2, 1);
  map(2, 0) = 1;
  const auto found = calc(spec);
  EXPECT_NEAR(found.period, 2 * T, 1e-12);
  expect_sizes(found, map * map);
}

// A value held by a slow sensor is read twice by a fast controller.
TEST(MultipliersOfChains, ASlowSensorIsHeldForAFastLaw) {
  const double k = 30, g = -9, T = 0.05;
  auto spec = make_rail(k);
  spec.sensors[0].chain.numbers = {{"sample_time", {2 * T}}};
  spec.controllers = {make_law("law", "gain", {"x"}, {{"gain", {g}}, {"sample_time", {T}}})};
  const MatrixXd flow = calc_flow(k, 2 * T);
  MatrixXd map = flow.topLeftCorner(2, 2);
  map.col(0) += g * flow.topRightCorner(2, 1);
  expect_sizes(calc(spec), map);
}

}  // namespace
}  // namespace bough::solver::testing
