/// SUPORT in statics: against SPC; inertia relief against the free-flying beam in closed form.
#include "fe/statics/inertia_relief.hpp"

#include <gtest/gtest.h>

#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe {
namespace {

struct Solved {
  Diagnostics diagnostics;
  records::StaticSubcase result;
  MatrixXd rigid_momentum;  ///< Φ_Rᵀ M u

  int count(const std::string& id) const {
    int n = 0;
    for (const auto& d : diagnostics.items()) n += d.id == id ? 1 : 0;
    return n;
  }
  /// Displacement of a dof of grid `id` (ids 1.. in order).
  double u(int id, int component) const { return result.displacement[6 * (id - 1) + component - 1]; }
};

Solved solve(const std::string& text) {
  Solved s;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, s.diagnostics);
  s.diagnostics.throw_if_errors();
  ModelOptions options;
  options.uses_enforced = true;
  const Model model = build_model(deck, options, s.diagnostics);
  const auto relief = read_inertia_relief(deck, s.diagnostics);
  const auto held = choose_suport(model, deck, relief, s.diagnostics);
  s.diagnostics.throw_if_errors();
  const StaticSolver solver(model, assemble_stiffness(model, DofSet::Free), held);
  const Suport suport = calc_suport(model, solver, held, relief, locate_relief(model, deck), s.diagnostics);
  s.result = solve_static_case(model, solver, calc_static_load(model, deck, -1, s.diagnostics), suport);
  s.rigid_momentum =
      model.calc_rigid_modes().transpose() * calc_mass_times(model, model.mass_kind(), s.result.displacement);
  return s;
}

int count(const std::string& text, const std::string& id) {
  try {
    return solve(text).count(id);
  } catch (const InputError& error) {
    int n = 0;
    for (const auto& d : error.items()) n += d.id == id ? 1 : 0;
    return n;
  } catch (const ComputationError& error) {
    return error.items().front().id == id ? 1 : 0;
  }
}

const std::string kCase = "SOL 101\nCEND\nLOAD = 3\nBEGIN BULK\n";
/// A frame in space with displacement systems.
const std::string kFrame =
    "CORD2R,3,,1.,2.,3.,2.,3.,5.\n,4.,1.,0.\nCORD2C,4,,0.,0.,-1.,0.,1.,1.\n,3.,0.,0.\n"
    "GRID,1,,0.,0.,0.,3\nGRID,2,,1.,.2,.1,4\nGRID,3,,1.3,1.4,-.2\nGRID,4,,.5,2.7,2.,3\n"
    "CBAR,1,5,1,2,0.,1.,1.\nCBAR,2,5,2,3,0.,0.,1.\nCBAR,3,5,3,4,1.,0.,0.\nCBAR,4,5,4,1,1.,0.,0.\n"
    "PBAR,5,6,.01,2.-4,1.-4,1.5-4\nMAT1,6,7.+7,,.3,2700.\n"
    "FORCE,3,4,,100.,.1,.2,1.\nMOMENT,3,2,,30.,1.,0.,-1.\nFORCE,3,1,,20.,0.,1.,0.\n";

void expect_same(const Solved& a, const Solved& b) {
  EXPECT_LT((a.result.displacement - b.result.displacement).norm(), 1e-10 * b.result.displacement.norm());
  EXPECT_LT((a.result.reaction - b.result.reaction).norm(), 1e-9 * b.result.reaction.norm());
  EXPECT_LT(a.result.mpc_force.norm(), 1e-9 * b.result.reaction.norm());
}

TEST(Suport, InStaticsIsAnSpcThatIsCheckedMpi) {
  for (const auto& [suport, spc] : {std::pair("SUPORT,1,123456\n", "SPC1,1,123456,1\n"),
                                    std::pair("SUPORT,1,123,2,13,3,2\n", "SPC,1,1,123\nSPC,1,2,13,,3,2\n")}) {
    const auto a = solve(kCase + kFrame + suport);
    const auto b = solve("SOL 101\nCEND\nLOAD = 3\nSPC = 1\nBEGIN BULK\n" + kFrame + spc);
    expect_same(a, b);
    EXPECT_EQ(a.count("fe.suport-strained"), 0);
    ASSERT_EQ(a.result.support.size(), 6u);
    EXPECT_LT(a.result.support_epsilon, 1e-12);
    EXPECT_EQ(a.count("fe.suport"), 1);
  }
  const auto a =
      solve("SOL 101\nCEND\nLOAD = 3\nSUPORT1 = 8\nBEGIN BULK\n" + kFrame + "SUPORT1,8,1,246\nSUPORT,1,135\n");
  expect_same(a, solve(kCase + kFrame + "SUPORT,1,123456\n"));
}

/// A slender line of bars: to hold its far end too is nearly nothing beside the stiffness of one bar.
std::string make_line(int num, const std::string& more) {
  std::string text = kCase + "PARAM,COUPMASS,1\nPBAR,5,6,.01,2.-4,1.-4,1.5-4\nMAT1,6,7.+7,,.3,2700.\n";
  char line[80];
  for (int i = 0; i <= num; ++i) {
    std::snprintf(line, sizeof line, "GRID,%d,,%.15g,0.,0.\n", i + 1, 12.0 * i / num);
    text += line;
  }
  for (int i = 1; i <= num; ++i)
    text += "CBAR," + std::to_string(i) + ",5," + std::to_string(i) + "," + std::to_string(i + 1) + ",0.,1.,0.\n";
  // A bar has no inertia about its own line.
  return text + "CONM2,9001,1,,0.,,,,\n,3.\n" + more;
}
constexpr double kEI = 7e7 * 2e-4, kLength = 12, kMass = 2700 * .01 * 12;

TEST(Suport, TooManyDofsAndHiddenGroundAreSeen) {
  const std::string load = "FORCE,3,101,,1.,0.,1.,0.\n";
  EXPECT_EQ(count(make_line(200, load + "SUPORT,1,123456\n"), "fe.suport-strained"), 0);
  EXPECT_EQ(count(make_line(200, load + "SUPORT,1,123456,201,2\n"), "fe.suport-strained"), 1);
  EXPECT_EQ(count(make_line(200, load + "SUPORT,1,123456\nCELAS2,9000,.1,201,2\n"), "fe.suport-strained"), 1);
}

TEST(InertiaRelief, IsWhatTheOldSolTwoIs) {
  Diagnostics d;
  records::Deck deck;
  deck.sol = "2";
  EXPECT_EQ(read_inertia_relief(deck, d), InertiaRelief::None);
  deck.suport.emplace_back();
  EXPECT_EQ(read_inertia_relief(deck, d), InertiaRelief::Supported);
  deck.sol = "1";
  EXPECT_EQ(read_inertia_relief(deck, d), InertiaRelief::None);
}

TEST(Suport, Errors) {
  EXPECT_EQ(count(kCase + kFrame + "SUPORT,77,1\n", "fe.missing-grid"), 1);
  EXPECT_EQ(count(kCase + kFrame + "SUPORT,1,0\n", "fe.bad-component"), 1);
  EXPECT_EQ(count("CEND\nLOAD=3\nSPC=1\nBEGIN BULK\n" + kFrame + "SPC1,1,123456,1\nSUPORT,1,2\n", "fe.suport-not-free"),
            1);
  EXPECT_EQ(count(kCase + kFrame + "RBE2,9,1,123456,2\nSUPORT,2,1\n", "fe.suport-not-free"), 1);
  EXPECT_EQ(count("CEND\nLOAD=3\nSUPORT1=5\nBEGIN BULK\n" + kFrame, "fe.missing-set"), 1);
  EXPECT_EQ(count(kCase + kFrame + "PARAM,INREL,-1\n", "fe.missing-suport"), 1);
  EXPECT_EQ(count(kCase + kFrame + "PARAM,INREL,-3\n", "fe.bad-param"), 1);
  EXPECT_EQ(count(kCase + kFrame + "PARAM,INREL,-2\nSUPORT,1,123456\n", "fe.suport-unused"), 1);
  EXPECT_EQ(count(kCase + kFrame + "SPOINT,9\nSUPORT,1,123456,9,0\n", "fe.suport-autospc"), 1);
  // SOL 2 asks for inertia relief without a PARAM: all dofs of its SUPORT are without stiffness here.
  const std::string old = "SOL 2\nCEND\nLOAD=3\nBEGIN BULK\n" + kFrame + "SPOINT,9\nSUPORT,9,0\n";
  EXPECT_EQ(count(old, "fe.missing-suport"), 1);
  EXPECT_EQ(count(old, "fe.suport"), 0);
  // Not enough dofs: what is left is a mechanism.
  EXPECT_EQ(count(kCase + kFrame + "SUPORT,1,12345\n", "fe.mechanism"), 1);
  EXPECT_EQ(count(kCase + kFrame + "SUPORT,1,123456\nCELAS2,9,5.,4,1\nPARAM,INREL,-1\n", "fe.suport-strained"), 1);
  EXPECT_EQ(count(kCase + kFrame + "CELAS2,9,5.,4,1\nPARAM,INREL,-2\n", "fe.suport-strained"), 1);
  const std::string massless = kFrame.substr(0, kFrame.find(",2700.")) + kFrame.substr(kFrame.find(",2700.") + 6);
  EXPECT_EQ(count(kCase + massless + "PARAM,INREL,-2\n", "fe.inertia-massless"), 1);
}

TEST(InertiaRelief, FreeBeamPushedAtItsEnd) {
  const double P = 50;
  const auto s = solve(make_line(7, "FORCE,3,8,,50.,0.,1.,0.\nSUPORT,1,123456\nPARAM,INREL,-1\n"));
  // a = P/m (6 ξ - 2), EI w'' = P L (ξ² - ξ³): exact at the grids.
  for (int i = 0; i <= 7; ++i) {
    const double xi = i / 7.0;
    EXPECT_NEAR(s.u(i + 1, 2), P * std::pow(kLength, 3) / kEI * (std::pow(xi, 4) / 12 - std::pow(xi, 5) / 20), 1e-9);
  }
  ASSERT_EQ(s.result.support.size(), 6u);
  EXPECT_NEAR(s.result.support[1].acceleration, -2 * P / kMass, 1e-9 * P / kMass);
  EXPECT_NEAR(s.result.support[5].acceleration, 6 * P / (kMass * kLength), 1e-9 * P / kMass);
  EXPECT_LT(s.result.reaction.norm(), 1e-9 * P);
  EXPECT_LT((s.result.load_resultant + s.result.inertia_resultant).norm(), 1e-9 * P * kLength);
  EXPECT_LT(s.result.epsilon, 1e-10);
}

TEST(InertiaRelief, SymmetricHalf) {
  // Grid 1 is the middle of a beam of length 24 pushed there by 100: uniform inertia, w_tip - w_mid = -P L³ / (128 EI).
  const auto s = solve("SOL 101\nCEND\nLOAD = 3\nSPC = 1\nBEGIN BULK\nSPC1,1,13456,1\n" +
                       make_line(5, "FORCE,3,1,,50.,0.,1.,0.\nSUPORT,1,2\nPARAM,INREL,-1\n").substr(kCase.size()));
  EXPECT_NEAR(s.u(6, 2), -100 * std::pow(24.0, 3) / (128 * kEI), 1e-9);
  EXPECT_NEAR(s.result.support.at(0).acceleration, 50 / kMass, 1e-9);
}

/// Without SUPORT: the same deformation, and no rigid motion in the sense of the mass.
TEST(InertiaRelief, WithoutSuport) {
  const std::string loads = "FORCE,3,1,,7.,0.,0.,1.\nCONM2,9,3,,500.,.1,.2,.3\n,9.,,8.,,,7.\n";
  const auto a = solve(kCase + kFrame + loads + "PARAM,INREL,-2\n");
  const auto b = solve(kCase + kFrame + loads + "PARAM,INREL,-1\nSUPORT,1,123456\n");
  const auto c = solve(kCase + kFrame + loads + "PARAM,INREL,-1\nSUPORT,3,123,4,13,2,2\n");
  EXPECT_NEAR(a.result.strain_energy / b.result.strain_energy, 1, 1e-9);
  EXPECT_NEAR(c.result.strain_energy / b.result.strain_energy, 1, 1e-9);
  EXPECT_LT((a.result.inertia - b.result.inertia).norm(), 1e-9 * a.result.inertia.norm());
  EXPECT_LT(a.rigid_momentum.norm(), 1e-9 * b.rigid_momentum.norm());
  EXPECT_LT(a.result.reaction.norm(), 1e-8 * a.result.load.norm());
  EXPECT_LT((a.result.load_resultant + a.result.inertia_resultant).norm(), 1e-9 * a.result.load_resultant.norm());
}

}  // namespace
}  // namespace bough::fe
