/// The whole way from a deck to a flexible body: what the record holds, and its errors.
#include "stiffening/reduce.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/modal.hpp"

namespace bough {
namespace {

using records::BodyFrame;
using records::BodySpec;
using stiffening::MatrixXd;

BodySpec make_spec(int num_modes) {
  BodySpec spec;
  spec.file = "beam.toml";
  spec.name = "beam";
  spec.num_modes = num_modes;
  return spec;
}

records::FlexBody reduce(const records::Deck& deck, const BodySpec& spec) {
  Diagnostics diagnostics;
  return stiffening::reduce(deck, spec, {}, diagnostics).body;
}

const test::Section kSection = {70e9, 27e9, 2700, 1e-4, 1e-9, 3e-9, 2e-9};

TEST(Reduce, CantileverRecordIsComplete) {
  auto maker = test::make_cantilever(test::get_report_section(), test::kReportLength, 40);
  maker.add_load(30, 41, {0, 2, 0});
  auto spec = make_spec(6);
  spec.interface_nodes = {41};
  spec.output_nodes = {1, 21};
  spec.damping_ratio = 0.01;
  spec.loads.resize(2);
  spec.loads[0] = {"tip", 41, {2, 6}, 0, {}};
  spec.loads[1] = {"push", 0, {}, 30, {}};
  const auto body = reduce(maker.deck, spec);
  EXPECT_EQ(body.name, "beam");
  EXPECT_NEAR(body.mass, 1.6154, 1e-4);
  EXPECT_NEAR(body.cg.x(), 4, 1e-9);
  EXPECT_NEAR(body.inertia(2, 2), 1.6154 * 64 / 3, 2e-3);
  EXPECT_EQ(body.num_modes(), 6);
  EXPECT_NEAR(2 * std::numbers::pi * body.frequency_hz(0), 2.91022, 1e-4);
  EXPECT_NEAR(body.modal_damping(5, 5), 0.02 * 51.067, 1e-3);
  EXPECT_EQ(body.node_id, (std::vector<int>{1, 21, 41}));
  EXPECT_EQ(body.interface_nodes, std::vector<int>{41});
  EXPECT_FALSE(body.is_free_free);
  EXPECT_EQ(body.phi[2].rows(), 6);
  EXPECT_EQ(body.F_I.rows(), 41 * 6);
  EXPECT_EQ(body.dof_map.rows(), 41 * 6);
  EXPECT_EQ(body.full_phi.size(), 0);
  EXPECT_EQ(body.mesh.grid_id.size(), 41u);
  ASSERT_EQ(body.locators.size(), 9u);
  ASSERT_EQ(body.kg_external.size(), 9u);
  for (int d = 1; d <= 6; ++d) EXPECT_EQ(body.find_locator(41, d), d - 1);  // three forces, three moments
  EXPECT_EQ(body.locators[6].name, "tip_y");
  EXPECT_EQ(body.locators[8].name, "push");
  // The pattern is twice the unit force at the tip along y.
  EXPECT_LT((body.kg_external[8] - 2 * body.kg_external[6]).norm(), 1e-9 * body.kg_external[0].norm());
  EXPECT_LT((body.external_load.col(8) - 2 * body.phi[2].row(1).transpose()).norm(), 1e-12);
  // The tip is at (8, 0, 0): 2 along y is the force and 16 about z its moment; a mode moves the tip, v along y and w
  // along z, by which the force gets the arm (v, w): moment (-2 w, 0, 2 u).
  ASSERT_EQ(body.load_resultant.cols(), 9);
  EXPECT_LT((body.load_resultant.col(8) - (Eigen::VectorXd(6) << 0, 2, 0, 0, 0, 16).finished()).norm(), 1e-12);
  EXPECT_LT((body.load_resultant.col(7) - Eigen::VectorXd::Unit(6, 5)).norm(), 1e-12);  // a moment at the tip
  EXPECT_LT((body.load_moment[8].row(0) + 2 * body.phi[2].row(2)).norm(), 1e-12);
  EXPECT_LT(body.load_moment[8].row(1).norm(), 1e-12);
  EXPECT_LT((body.load_moment[8].row(2) - 2 * body.phi[2].row(0)).norm(), 1e-12);
  EXPECT_EQ(body.load_moment[7].norm(), 0);
  // A pull on the tip stiffens: ∫ φ'² dx of the first mode with unit modal mass, 4.64778 / (ρA L²).
  EXPECT_NEAR(body.kg_external[0](0, 0) / (4.6477778 / (1.6154 / 8 * 64)), 1, 1e-3);
  for (const bool computed : body.kg_inertial_computed) EXPECT_TRUE(computed);
  EXPECT_FALSE(body.lumped.empty() || body.consistent.empty() || body.exact.empty());
  EXPECT_EQ(&body.integrals(), &body.exact);
}

TEST(Reduce, MomentsOfInterfaceNodesMayBeLeftOut) {
  const auto maker = test::make_cantilever(kSection, 1, 20);
  auto spec = make_spec(3);
  spec.interface_nodes = {11, 21};
  const auto all = reduce(maker.deck, spec);
  ASSERT_EQ(all.locators.size(), 12u);
  spec.interface_moments = false;
  const auto forces = reduce(maker.deck, spec);
  ASSERT_EQ(forces.locators.size(), 6u);
  for (const int id : {11, 21}) {
    EXPECT_LT(forces.find_locator(id, 4), 0);
    for (int d = 1; d <= 3; ++d) {
      const auto& with = all.kg_external[static_cast<size_t>(all.find_locator(id, d))];
      EXPECT_EQ((with - forces.kg_external[static_cast<size_t>(forces.find_locator(id, d))]).norm(), 0);
    }
  }
}

TEST(Reduce, SubsetsAndSelection) {
  const auto maker = test::make_cantilever(kSection, 1, 20);
  auto spec = make_spec(3);
  spec.select = {5, 1};
  spec.inertial_loads = {InertialLoad::wz2, InertialLoad::ay};
  spec.integrals = "lumped";
  spec.full = true;
  const auto body = reduce(maker.deck, spec);
  const auto all = reduce(maker.deck, make_spec(5));
  ASSERT_EQ(body.num_modes(), 2);
  EXPECT_NEAR(body.eigenvalue(0) / all.eigenvalue(4), 1, 1e-10);
  EXPECT_NEAR(body.eigenvalue(1) / all.eigenvalue(0), 1, 1e-10);
  for (int i = 0; i < 12; ++i) {
    const bool asked = i == static_cast<int>(InertialLoad::wz2) || i == static_cast<int>(InertialLoad::ay);
    EXPECT_EQ(body.kg_inertial_computed[i], asked);
    EXPECT_EQ(body.kg_inertial[i].norm() > 0, asked);
  }
  EXPECT_NEAR(body.kg_inertial[8](1, 1) / all.kg_inertial[8](0, 0), 1, 1e-8);
  EXPECT_EQ(&body.integrals(), &body.lumped);
  EXPECT_EQ(body.full_phi.rows(), 21 * 6);
  EXPECT_EQ(body.node_id.size(), 21u);

  auto ranged = make_spec(0);
  ranged.max_frequency_hz = 0.5 * (all.frequency_hz(2) + all.frequency_hz(3));
  EXPECT_EQ(reduce(maker.deck, ranged).num_modes(), 3);
}

// The SPC set is left out, the rigid modes are dropped, and the elastic modes carry no momentum.
TEST(Reduce, FreeBody) {
  test::DeckMaker maker;
  maker.add_section(1, kSection, true);
  maker.add_line(1, 1, {1, 2, 3}, {3, 2, 3}, 30, Vector3d::UnitY());
  maker.fix(1, 123456);
  auto spec = make_spec(4);
  spec.frame = BodyFrame::Free;
  spec.interface_nodes = {31};
  spec.origin = Vector3d(2, 2, 3);
  const auto body = reduce(maker.deck, spec);
  EXPECT_TRUE(body.is_free_free);
  EXPECT_EQ(body.num_modes(), 4);
  EXPECT_LT(body.cg.norm(), 1e-12);
  const double w = 22.3732854 * std::sqrt(kSection.E * kSection.I1 / (kSection.rho * kSection.A)) / 4;
  EXPECT_NEAR(2 * std::numbers::pi * body.frequency_hz(0) / w, 1, 3e-4);
  EXPECT_LT(body.exact.gamma0.cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT(body.exact.gamma1.cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT(body.effective_mass.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(body.kg_external.size(), 6u);
}

std::vector<std::string> get_errors(const records::Deck& deck, const BodySpec& spec) {
  std::vector<std::string> ids;
  try {
    reduce(deck, spec);
  } catch (const InputError& error) {
    for (const auto& item : error.items())
      if (item.severity == Severity::Error) ids.push_back(item.id);
  }
  return ids;
}

TEST(Reduce, ReportsEveryErrorOfTheSpec) {
  const auto maker = test::make_cantilever(kSection, 1, 4);
  auto bad = make_spec(0);
  bad.mass = "lumpt";
  bad.integrals = "exakt";
  bad.damping_ratio = -1;
  bad.support = {1, 2, 3};
  EXPECT_EQ(get_errors(maker.deck, bad),
            (std::vector<std::string>{"reduce.no-modes", "reduce.bad-mass", "reduce.bad-integrals",
                                      "reduce.bad-support", "reduce.bad-damping"}));

  auto nodes = make_spec(2);
  nodes.interface_nodes = {99};
  nodes.output_nodes = {98, 1};
  nodes.loads.resize(2);
  nodes.loads[0] = {"a", 97, {1}, 0, 0, {"beam.toml", 12, 0}};
  nodes.loads[1] = {"b", 1, {7}, 0, 0, {"beam.toml", 16, 0}};
  EXPECT_EQ(get_errors(maker.deck, nodes), (std::vector<std::string>{"reduce.unknown-node", "reduce.unknown-node",
                                                                     "reduce.unknown-node", "reduce.bad-direction"}));

  auto select = make_spec(2);
  select.select = {3, 3, 0};
  EXPECT_EQ(get_errors(maker.deck, select), (std::vector<std::string>{"reduce.bad-select", "reduce.bad-select"}));
  select.select = {1, 1000};
  EXPECT_EQ(get_errors(maker.deck, select), std::vector<std::string>{"reduce.bad-select"});
  auto damping = make_spec(2);
  damping.damping_ratios = {0.1, 0.1, 0.1};
  EXPECT_EQ(get_errors(maker.deck, damping), std::vector<std::string>{"reduce.bad-damping"});
}

// Mass between scalar points is in no place: nothing that a multibody system could move.
TEST(Reduce, ABodyNeedsMass) {
  records::Deck deck;
  deck.scalar_points = {1, 2};
  deck.scalar_masses.emplace_back();
  deck.scalar_masses.back().id = 3, deck.scalar_masses.back().m = 2, deck.scalar_masses.back().g1 = 2;
  records::ScalarSpring spring;
  spring.id = 4, spring.k = 10, spring.g1 = 1, spring.g2 = 2;
  deck.springs.push_back(spring);
  EXPECT_EQ(get_errors(deck, make_spec(1)), std::vector<std::string>{"reduce.no-mass"});
}

TEST(Reduce, MasslessRigidMotionTakesNoneOfTheModesAskedFor) {
  // A straight CBAR line has no inertia about its own axis: five rigid modes have mass, the roll has none.
  auto maker = test::DeckMaker();
  maker.add_section(1, kSection);
  maker.add_line(1, 1, {0, 0, 0}, {4, 0, 0}, 20, {0, 1, 0});
  auto spec = make_spec(3);
  spec.frame = BodyFrame::Free;
  EXPECT_EQ(reduce(maker.deck, spec).num_modes(), 3);
}

TEST(Reduce, FreeBodyThatIsHeldIsAnError) {
  auto maker = test::make_cantilever(kSection, 1, 4);
  records::ScalarSpring spring;
  spring.id = 500;
  spring.k = 1e4;
  spring.g1 = 3;
  spring.c1 = 2;
  maker.deck.springs.push_back(spring);
  auto spec = make_spec(2);
  spec.frame = BodyFrame::Free;
  EXPECT_EQ(get_errors(maker.deck, spec), std::vector<std::string>{"reduce.grounded"});
}

// A beam held by its axis only, and a free one with a pinned strut: the dofs are named, and the input is to blame.
TEST(Reduce, MechanismIsAnInputError) {
  test::DeckMaker held;
  held.add_section(1, kSection);
  held.add_line(1, 1, Vector3d::Zero(), Vector3d::UnitX(), 4, Vector3d::UnitY());
  held.fix(1, 123);
  EXPECT_THAT(get_errors(held.deck, make_spec(2)), ::testing::IsSupersetOf({"fe.mechanism", "reduce.mechanism"}));

  test::DeckMaker strut;
  strut.add_section(1, kSection);
  strut.add_line(1, 1, Vector3d::Zero(), Vector3d::UnitX(), 4, Vector3d::UnitY());
  strut.add_line(1, 101, Vector3d::UnitX(), {1, 1, 0}, 4, Vector3d::UnitX(), 5);
  for (auto& beam : strut.deck.beams)
    if (beam.id == 101) beam.pin_a = 0b110000;
  auto spec = make_spec(2);
  spec.frame = BodyFrame::Free;
  EXPECT_THAT(get_errors(strut.deck, spec), ::testing::IsSupersetOf({"fe.mechanism", "reduce.mechanism"}));
}

TEST(Reduce, WarnsOfWhatIsNotUsed) {
  const auto maker = test::make_cantilever(kSection, 1, 4);
  auto spec = make_spec(0);
  spec.support = {1};
  spec.max_frequency_hz = 1e-3;
  Diagnostics diagnostics;
  const auto body = stiffening::reduce(maker.deck, spec, {}, diagnostics).body;
  EXPECT_EQ(body.num_modes(), 0);
  EXPECT_TRUE(diagnostics.has("reduce.support-unused"));
  EXPECT_TRUE(diagnostics.has("reduce.rigid"));
}

}  // namespace
}  // namespace bough
