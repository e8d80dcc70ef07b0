// Two links on revolute joints with modes clamped at the joints: 2, 4, 6, 10 modes each (docs/theory/flexible-body.md
// §5). Such modes leave next to no inertia about the free joint; cut off after η² the kinetic energy lost its sign
// there, and 4 modes and more stopped within half a second.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/builder/build_system.hpp"
#include "tests/cases/support/example.hpp"
#include "tests/support/beam_decks.hpp"

namespace bough::test {
namespace {

constexpr int kBars = 16;
constexpr double kE = 3e9, kRho = 2700, kArea = 1e-4, kI = 8e-10, kTipMass = 0.05;

// tests/oracle/hermite_chain.py 16: inextensible links of 16 pieces each, masses and bending stiffness those of the
// bars, no limit on rotations.
constexpr double kChainTip[] = {-1.59206329, -1.17050536};

struct Links {
  Example example;
  records::FlexBody flex;
};

Links make_links(int num_modes) {
  DeckMaker maker = make_cantilever({kE, kE / 2.6, kRho, kArea, kI, kI, 2 * kI}, 1, kBars, true);
  maker.fix_all(345);
  records::BodySpec spec;
  spec.name = "link";
  spec.num_modes = 16;
  spec.interface_nodes = {kBars + 1};
  spec.output_nodes = {1, kBars + 1};
  const auto all = reduce(maker.deck, spec);
  for (int j = 0; j < all.num_modes() && static_cast<int>(spec.select.size()) < num_modes; ++j)
    if (all.phi[1].row(1).col(j).norm() > 1e-6 * all.phi[1].col(j).norm()) spec.select.push_back(j + 1);
  Links links;
  links.flex = reduce(maker.deck, spec);
  links.example = load_example("ex03-two-link", "two-link.toml");
  auto& system = links.example.spec;
  links.example.flex = {{system.bodies[0].file, links.flex}};
  for (auto& hinge : system.hinges)
    if (hinge.parent_node == 11) hinge.parent_node = kBars + 1;
  for (auto& sensor : system.sensors)
    if (sensor.node == 11) sensor.node = kBars + 1;
  records::BodyRecord mass;
  mass.name = "mass";
  mass.mass = kTipMass;
  system.bodies.push_back(mass);
  records::HingeRecord weld;
  weld.name = "weld";
  weld.type = records::HingeType::Fixed;
  weld.parent = "lower";
  weld.parent_node = kBars + 1;
  weld.child = "mass";
  system.hinges.push_back(weld);
  system.simulation.duration = 1;
  system.simulation.output_step = 0.05;
  return links;
}

// tests/oracle/point_links.py links 2 4 6 10: the same links as points, at relative tolerance 1e-10. `x`, `y` have the
// affine second-order field of the solver, `whole_x`, `whole_y` the field of the bars itself: the places of theory.
struct Place {
  int num_modes;
  double x, y, whole_x, whole_y;
};
constexpr Place kPlaces[] = {{2, -1.5911722, -1.1710896, -1.591206, -1.171063},
                             {4, -1.5921599, -1.1704091, -1.592191, -1.170382},
                             {6, -1.5922431, -1.1703589, -1.592274, -1.170332},
                             {10, -1.5922625, -1.1703468, -1.592294, -1.170319}};

TEST(TwoLinkModes, TenClampedModesRunAndConverge) {
  double last_change = 1;
  VectorXd last;
  for (const Place& place : kPlaces) {
    const std::string name = std::to_string(place.num_modes);
    const Links links = make_links(place.num_modes);
    ASSERT_EQ(links.flex.num_modes(), place.num_modes);
    solver::MemorySink sink;
    ASSERT_TRUE(links.example.run(sink).completed) << name;
    const MatrixXd tips = sink.get("/sensors/tip_position");
    const VectorXd tip = tips.row(tips.rows() - 1);
    record("x_" + name, tip[0]);
    record("y_" + name, tip[1]);
    EXPECT_NEAR(tip[0], place.x, 5e-7) << name;
    EXPECT_NEAR(tip[1], place.y, 5e-7) << name;
    // What the affine field takes for the whole one, on 5 % of deflection.
    EXPECT_LT(std::hypot(tip[0] - place.whole_x, tip[1] - place.whole_y), 5e-5) << name;
    if (last.size() > 0) {
      EXPECT_LT((tip - last).norm(), 0.5 * last_change) << name;
      last_change = (tip - last).norm();
    }
    last = tip;
    if (place.num_modes >= 4) {
      EXPECT_NEAR(tip[0], kChainTip[0], 5e-4);
      EXPECT_NEAR(tip[1], kChainTip[1], 5e-4);
    }
    EXPECT_LT(record_energy_drift(sink, "drift_" + name), 1e-8);
  }
}

// What leaves the inertia about the joint is said, with the number.
TEST(TwoLinkModes, ClampedModesBehindAFreeHingeAreNoted) {
  for (const int num_modes : {1, 10}) {
    const Links links = make_links(num_modes);
    Diagnostics diagnostics;
    solver::build_system(links.example.spec, links.example.flex, diagnostics);
    int count = 0;
    for (const auto& item : diagnostics.items()) {
      count += item.id == "system.spanned-hinge" ? 1 : 0;
      EXPECT_NE(item.id, "system.inconsistent-integrals") << num_modes;
    }
    EXPECT_EQ(count, num_modes == 1 ? 0 : 2) << num_modes;  // both links
  }
}

// The drift grows with time at most: a quarter of what a minute may have.
TEST(TwoLinkModes, ExampleRunsForAQuarterOfAMinute) {
  Example example = load_example("ex03-two-link", "two-link.toml");
  example.spec.simulation.duration = 15;
  example.spec.simulation.output_step = 0.1;
  solver::MemorySink sink;
  ASSERT_TRUE(example.run(sink).completed);
  EXPECT_LT(record_energy_drift(sink, "energy_drift_15_s"), 2.5e-10);
}

}  // namespace
}  // namespace bough::test
