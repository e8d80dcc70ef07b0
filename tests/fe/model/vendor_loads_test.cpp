/// Loads and constraints that Nastran takes although they are not quite in order: against the decks that say it
/// outright.
#include <gtest/gtest.h>

#include <cmath>

#include "fe/loads/enforced.hpp"
#include "fe/loads/loads.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"
#include "text_model.hpp"

namespace bough::fe::test {
namespace {

struct Case : LoadedModel {
  using LoadedModel::LoadedModel;
  records::StaticSubcase solve() {
    const auto load = calc_static_load(*model, deck, -1, diagnostics);
    diagnostics.throw_if_errors();
    const auto solver = model->num_fdofs() == 0
                            ? std::make_unique<StaticSolver>(*model)
                            : std::make_unique<StaticSolver>(*model, assemble_stiffness(*model, DofSet::Free));
    return solve_static_case(*model, *solver, load);
  }
  int count(const std::string& id, Severity severity) const {
    int n = 0;
    for (const auto& d : diagnostics.items()) n += d.id == id && d.severity == severity ? 1 : 0;
    return n;
  }
};

// One bar of length 2 along x, EI1 = 700 (plane 1: y), EI2 = 350, EA = 7e7.
const std::string kBar =
    "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,1.-3,1.-8,5.-9,1.-8\nMAT1,1,7.+10,,.3,2700.\n"
    "SPC1,1,123456,1\n";
const std::string kHead = "SPC = 1\nLOAD = 4\nBEGIN BULK\n";

/// P2 blank is zero: p from the root to nothing at the tip, w = p L⁴/(30 EI), θ = p L³/(24 EI).
TEST(VendorLoads, BlankP2OfPload1IsZero) {
  Case c(kHead + kBar + "PLOAD1,4,1,FY,FR,0.,3.,1.\n");
  const auto u = c.solve().displacement;
  EXPECT_NEAR(u[7], 3 * 16 / (30 * 700.0), 1e-13);
  EXPECT_NEAR(u[11], 3 * 8 / (24 * 700.0), 1e-13);
  // X2 blank: the force P1 at X1, half way: w = P a² (3 L - a)/(6 EI).
  Case point(kHead + kBar + "PLOAD1,4,1,FY,LE,1.,3.\n");
  EXPECT_NEAR(point.solve().displacement[7], 3 * 5 / (6 * 700.0), 1e-13);
  // Blank P2, P3, P4 of PLOAD4 are P1, and PLOAD2 has one: a square, a quarter of p A on each corner.
  const std::string plate = kHead + kBar +
                            "GRID,11,,0.,0.,1.\nGRID,12,,1.,0.,1.\nGRID,13,,1.,1.,1.\nGRID,14,,0.,1.,1.\n"
                            "CQUAD4,9,9,11,12,13,14\nPSHELL,9,1,.01\n";
  for (const char* card : {"PLOAD4,4,9,8.\n", "PLOAD2,4,8.,9\n"}) {
    Case flat(plate + card);
    const auto F = calc_load(*flat.model, flat.deck, 4, flat.diagnostics);
    for (int g = 11; g <= 14; ++g) EXPECT_NEAR(F[flat.model->node(flat.model->find_node(g)).first_gdof + 2], 2, 1e-14);
  }
}

TEST(VendorLoads, LoadPassesOverMissingSets) {
  Case c(kHead + kBar + "LOAD,4,2.,3.,20,1.,21\nFORCE,20,2,,5.,0.,1.,0.\n");
  EXPECT_NEAR(c.solve().load[7], 30, 1e-13);
  EXPECT_EQ(c.count("fe.missing-load", Severity::Warning), 1);
  EXPECT_EQ(c.diagnostics.num_errors(), 0);
  Case none(kHead + kBar + "LOAD,4,2.,3.,20,1.,21\n");
  EXPECT_THROW(none.solve(), InputError);
  EXPECT_EQ(none.count("fe.missing-load", Severity::Error), 2);
}

TEST(VendorLoads, LoadOfLoadsAddsThemUp) {
  Case c(kHead + kBar +
         "LOAD,4,2.,1.,20,3.,21\nFORCE,20,2,,5.,0.,1.,0.\nLOAD,21,.5,4.,20,1.,22\nFORCE,22,2,,7.,0.,0.,1.\n");
  const auto s = c.solve();
  EXPECT_NEAR(s.load[7], 2 * 5 + 2 * 3 * .5 * 4 * 5, 1e-12);
  EXPECT_NEAR(s.load[8], 2 * 3 * .5 * 7, 1e-12);
  EXPECT_EQ(c.count("fe.nested-load", Severity::Warning), 1);
  // One that comes back to itself has no sum.
  Case loop(kHead + kBar + "LOAD,4,1.,1.,20,1.,21\nFORCE,20,2,,5.,0.,1.,0.\nLOAD,21,1.,1.,4,1.,20\n");
  EXPECT_THROW(loop.solve(), InputError);
  EXPECT_EQ(loop.count("fe.load-circle", Severity::Error), 1);
}

TEST(VendorLoads, AutospcThatIsNeitherYesNorNoIsNamed) {
  for (const auto& [value, count] : {std::pair{"N0", 1}, {"YESS", 1}, {"NO", 0}, {"YES", 0}}) {
    Case c(kHead + kBar + "FORCE,4,2,,5.,0.,1.,0.\nPARAM,AUTOSPC," + value + "\n");
    build_model(c.deck, {}, c.diagnostics);
    EXPECT_EQ(c.count("fe.bad-param", Severity::Warning), count) << value;
  }
}

TEST(VendorLoads, SpcdHoldsWhatItMoves) {
  Case free(kHead + kBar + "SPCD,4,2,1,-.01\nFORCE,4,2,,3.,0.,1.,0.\n");
  Case fixed(kHead + kBar + "SPC1,1,1,2\nSPCD,4,2,1,-.01\nFORCE,4,2,,3.,0.,1.,0.\n");
  const auto a = free.solve(), b = fixed.solve();
  EXPECT_LT((a.displacement - b.displacement).norm(), 1e-15);
  EXPECT_LT((a.reaction - b.reaction).norm(), 1e-9);
  EXPECT_NEAR(a.reaction[6], -.01 * 7e7 / 2, 1e-6);
  EXPECT_EQ(free.count("fe.spcd-not-fixed", Severity::Warning), 1);
  EXPECT_EQ(fixed.diagnostics.items().size(), 0u);
  // What is held for one load is not for another.
  EXPECT_TRUE(is_held_for(*free.model, free.deck, 4));
  EXPECT_FALSE(is_held_for(*free.model, free.deck, 5));
  EXPECT_TRUE(is_held_for(*fixed.model, fixed.deck, 5));
}

/// SPCD cards of the LOAD card's own id act once; those of a set that it combines are said to be combined.
TEST(VendorLoads, SpcdBesideALoadCard) {
  const std::string bulk = kBar + "SPC1,1,1,2\nLOAD,4,2.,1.,20\nFORCE,20,2,,3.,0.,1.,0.\n";
  Case own(kHead + bulk + "SPCD,4,2,1,.01\n");
  const auto s = own.solve();
  EXPECT_NEAR(s.displacement[6], .01, 1e-15);
  EXPECT_NEAR(s.load[7], 6, 1e-13);
  EXPECT_EQ(own.diagnostics.items().size(), 0u);
  Case combined(kHead + bulk + "SPCD,20,2,1,.01\n");
  EXPECT_NEAR(combined.solve().displacement[6], .02, 1e-15);
  EXPECT_EQ(combined.count("fe.spcd-combined", Severity::Warning), 1);
}

/// Every dof prescribed: K d is the reaction.
TEST(VendorLoads, EverythingPrescribedGivesReactions) {
  Case c(kHead + kBar + "SPC1,1,123456,2\nSPCD,4,2,2,.01\n");
  ASSERT_EQ(c.model->num_fdofs(), 0);
  const auto s = c.solve();
  EXPECT_NEAR(s.displacement[7], .01, 1e-16);
  EXPECT_NEAR(s.reaction[7], 12 * 700 * .01 / 8, 1e-10);
  EXPECT_NEAR(s.reaction[11], -6 * 700 * .01 / 4, 1e-10);
  EXPECT_LT(s.reaction_resultant.norm(), 1e-10);
}

/// Nothing at all: the bar is held by all of GA. CNA alone with fewer than six: all of GA holds it, and the same
/// components of GB depend, as by an RBE2.
TEST(VendorLoads, RbarIsCompletedAtItsFirstGrid) {
  const std::string grids = "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,2.,3.\n";
  const auto get_T = [&](const std::string& card) { return MatrixXd(build(grids + card).T()); };
  EXPECT_EQ(get_T("RBAR,5,1,2\n"), get_T("RBAR,5,1,2,123456\n"));
  EXPECT_EQ(count(grids + "RBAR,5,1,2\n", "fe.rbar-completed"), 0);
  EXPECT_EQ(count(grids + "RBAR,5,1,2,123\n", "fe.rbar-completed"), 1);
  EXPECT_LT((get_T("RBAR,5,1,2,123\n") - get_T("RBE2,5,1,123,2\n")).norm(), 1e-14);
  EXPECT_LT((get_T("RBAR,5,1,2,,13\n") - get_T("RBE2,5,2,13,1\n")).norm(), 1e-14);
  // The rotations of GB are free to be held.
  const std::string held = "SPC = 3\n" + grids + "SPC1,3,456,2\nRBAR,5,1,2,123\n";
  EXPECT_EQ(build(held).num_fdofs(), 6);
  EXPECT_EQ(build(grids + "RBAR,5,1,2,123,,,123\n").num_fdofs(), 9);
  EXPECT_EQ(count(grids + "RBAR,5,1,2,123,,456,123456\n", "fe.rigid-independent"), 1);
}

/// Pressure on a face by its grids, whichever way the solid counts them, P1 to P4 at the same grids.
TEST(VendorLoads, PressureOnLeftHandedSolids) {
  const std::string head =
      "LOAD = 4\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,.1\nGRID,3,,1.2,1.,0.\n"
      "GRID,4,,0.,.9,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.2\nGRID,7,,1.,1.1,1.\nGRID,8,,0.,1.,1.1\n"
      "PSOLID,1,1\nMAT1,1,7.,,.3\n";
  const std::pair<std::string, std::string> bodies[] = {
      {"CHEXA,9,1,1,2,3,4,5,6,+\n+,7,8\n", "CHEXA,9,1,5,6,7,8,1,2,+\n+,3,4\n"},
      {"CPENTA,9,1,1,2,4,5,6,8\n", "CPENTA,9,1,1,4,2,5,8,6\n"},
      {"CTETRA,9,1,1,2,4,5\n", "CTETRA,9,1,2,1,4,5\n"}};
  const std::vector<std::string> faces[] = {{"5,7", "7,5", "1,6", "2,7"}, {"1", "1,6", "8,1"}, {"1,5", "2,1"}};
  for (int b = 0; b < 3; ++b)
    for (const auto& face : faces[b]) {
      VectorXd F[2];
      for (int k = 0; k < 2; ++k) {
        Case c(head + (k == 0 ? bodies[b].first : bodies[b].second) + "PLOAD4,4,9,1.,2.,3.,4.," + face + "\n");
        F[k] = calc_load(*c.model, c.deck, 4, c.diagnostics);
        EXPECT_EQ(c.diagnostics.num_errors(), 0) << b << " " << face;
      }
      EXPECT_GT(F[0].norm(), 0.1);
      EXPECT_LT((F[0] - F[1]).norm(), 1e-14) << b << " " << face;
    }
}

}  // namespace
}  // namespace bough::fe::test
