/// Cards of MSC and NX decks in whole models: nonstructural mass, splines, accelerations of grids.
#include <gtest/gtest.h>

#include <cmath>

#include "fe/loads/loads.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe {
namespace {

struct Made {
  records::Deck deck;
  Model model;
};

Made make(const std::string& text, Diagnostics& d) {
  auto deck = nastran::read_deck_text(text, "deck.bdf", {}, d);
  d.throw_if_errors();
  ModelOptions options;
  options.autospc = false;
  options.uses_enforced = true;
  auto model = build_model(deck, options, d);
  return {std::move(deck), std::move(model)};
}

Made make(const std::string& text) {
  Diagnostics d;
  return make(text, d);
}

/// Mass, and first moments about the origin along x.
std::pair<double, double> weigh(const Model& model, MassKind kind) {
  const MatrixXd rigid = model.calc_rigid_modes();
  const VectorXd f = calc_mass_times(model, kind, rigid.col(1));
  return {rigid.col(1).dot(f), rigid.col(5).dot(f)};
}

// A plate of 2 x 1 (t = 0.1) beside a bar of length 3, density 2.
const std::string kPlateAndBar =
    "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,2.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,5.,0.,0.\n"
    "CQUAD4,1,1,1,2,3,4\nCBAR,2,2,2,5,0.,1.,0.\nPSHELL,1,1,.1,1\nPBAR,2,1,.5,.1,.1,.1\nMAT1,1,10.,,.3,2.\n";

TEST(NonstructuralMass, IsAddedWhereItIsNamed) {
  const double plate = 2 * 2 * 1 * 0.1, bar = 2 * 0.5 * 3;
  const auto mass = [](const std::string& cards) { return weigh(make(cards).model, MassKind::Consistent).first; };
  EXPECT_NEAR(mass(kPlateAndBar), plate + bar, 1e-13);
  EXPECT_NEAR(mass("NSM = 7\n" + kPlateAndBar + "NSM,7,PSHELL,1,.3,9,5.\n"), plate + bar + 0.3 * 2, 1e-13);
  EXPECT_NEAR(mass("NSM = 7\n" + kPlateAndBar + "NSM1,7,PBAR,.3,ALL\n"), plate + bar + 0.3 * 3, 1e-13);
  EXPECT_NEAR(mass("NSM = 7\n" + kPlateAndBar + "NSM1,7,ELEMENT,.3,1,THRU,9\n"), plate + bar + 0.3 * 5, 1e-13);
  EXPECT_NEAR(mass("NSM = 7\n" + kPlateAndBar + "NSML1,7,ELEMENT,.3,1,THRU,9\n"), plate + bar + 0.3, 1e-13);
  EXPECT_NEAR(mass("NSM = 9\n" + kPlateAndBar + "NSML,7,PBAR,2,.3\nNSM,8,PSHELL,1,.1\nNSM,6,PBAR,2,5.\nNSMADD,9,7,8\n"),
              plate + bar + 0.5, 1e-13);
}

TEST(NonstructuralMass, IsSpreadAsTheHostAndWithoutAHostAtTheGrids) {
  for (MassKind kind : {MassKind::Lumped, MassKind::Consistent}) {
    // The same on the property card.
    const auto by_card = make("NSM = 7\n" + kPlateAndBar + "NSM1,7,PSHELL,.3,1\n");
    auto text = kPlateAndBar;
    text.replace(text.find("PSHELL,1,1,.1,1"), 15, "PSHELL,1,1,.1,1,,,,.3");
    const auto by_property = make(text);
    const VectorXd x = VectorXd::LinSpaced(by_card.model.num_gdofs(), -1, 2);
    EXPECT_LT((calc_mass_times(by_card.model, kind, x) - calc_mass_times(by_property.model, kind, x)).norm(), 1e-13);
    auto massless = kPlateAndBar;
    massless.replace(massless.find(".3,2.\n"), 5, ".3,0.");
    const auto [mass, moment] = weigh(make("NSM = 7\n" + massless + "NSM1,7,PBAR,.4,2\n").model, kind);
    EXPECT_NEAR(mass, 1.2, 1e-14);
    EXPECT_NEAR(moment, 1.2 * 3.5, 1e-14);
  }
}

TEST(NonstructuralMass, WhatIsNotSelectedOrNotFoundIsSaid) {
  Diagnostics unused, missing, none;
  make(kPlateAndBar + "NSM,7,PSHELL,1,.3\n", unused);
  EXPECT_TRUE(unused.has("fe.nsm-unused"));
  EXPECT_THROW(make("NSM = 8\n" + kPlateAndBar + "NSM,7,PSHELL,1,.3\n", missing), InputError);
  EXPECT_TRUE(missing.has("fe.missing-set"));
  make("NSM = 7\n" + kPlateAndBar + "NSM,7,PROD,1,.3\n", none);
  EXPECT_TRUE(none.has("fe.nsm-no-element"));
}

TEST(MpcSelection, WithoutCardsIsAWarningAndSoIsAMissingMemberOfAUnion) {
  Diagnostics empty, member;
  const auto coupled = make("MPC = 3\n" + kPlateAndBar, empty);
  EXPECT_TRUE(empty.has("fe.empty-mpc-set"));
  EXPECT_EQ(coupled.model.num_fdofs(), make(kPlateAndBar).model.num_fdofs());
  const auto united = make("MPC = 3\n" + kPlateAndBar + "MPCADD,3,4\n", member);
  EXPECT_TRUE(member.has("fe.missing-set"));
  EXPECT_EQ(united.model.num_fdofs(), coupled.model.num_fdofs());
}

/// Displacements of a deck whose end grids are enforced by load set 4.
VectorXd enforce(const std::string& text) {
  Diagnostics d;
  const auto l = make(text, d);
  const StaticSolver solver(l.model, assemble_stiffness(l.model, DofSet::Free));
  const auto load = calc_static_load(l.model, l.deck, 4, d);
  d.throw_if_errors();
  return solve_static_case(l.model, solver, load).displacement;
}

// A curve of four grids in space, its ends given; grid 9 only keeps the spline's model from having no free dof.
const std::string kCurve =
    "SPC = 1\nBEGIN BULK\nCORD2R,5,,0.,0.,0.,.3,.2,1.,+\n+,1.,.1,0.\nGRID,1,,0.,0.,0.\nGRID,2,,1.,.4,.1,5\n"
    "GRID,3,,2.,.5,.6\nGRID,4,,2.5,0.,1.2\nSPC1,1,123456,1,4\nSPCD,4,1,1,.3,1,5,-.2\nSPCD,4,1,6,.7,4,2,.4\n"
    "SPCD,4,4,3,-.6,4,4,.5\nGRID,9\nCELAS2,90,1.,9,1\nSPC1,1,23456,9\n";

TEST(Rspline, FollowsTheUnloadedTube) {
  const double length = std::sqrt(1 + .16 + .01) + std::sqrt(1 + .01 + .25) + std::sqrt(.25 + .25 + .36);
  const double diameter = 0.25 * length, I = diameter * diameter / 8;
  char pbar[120];
  std::snprintf(pbar, sizeof pbar, "PBAR,1,1,1.,%.15g,%.15g,%.15g\nMAT1,1,1.,%.15g\n", I, I, 2 * I, 1 / 2.6);
  const VectorXd tube =
      enforce(kCurve + "CBAR,1,1,1,2,0.,0.,1.\nCBAR,2,1,2,3,0.,0.,1.\nCBAR,3,1,3,4,0.,1.,0.\n" + pbar);
  const VectorXd spline = enforce(kCurve + "RSPLINE,7,.25,1,2,123456,3,123456,4\n");
  EXPECT_GT(tube.segment<12>(6).norm(), 0.1);
  EXPECT_LT((spline - tube).norm(), 1e-10 * tube.norm());
}

TEST(Rspline, OnALineIsTheCubicAndKeepsWhatIsNotNamed) {
  // w = 0.4 (3 s² - 2 s³), ends at x = 0 and 2, s = x/2; component 3 alone depends at grid 2.
  const VectorXd u = enforce(
      "SPC = 1\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,.5,0.,0.\nGRID,3,,2.,0.,0.\nSPC1,1,123456,1,3\nSPC1,1,12456,2\n"
      "SPCD,4,3,3,.4\nGRID,9\nCELAS2,90,1.,9,1\nSPC1,1,23456,9\nRSPLINE,7,,1,2,3,3\n");
  EXPECT_NEAR(u[8], 0.4 * (3 / 16. - 2 / 64.), 1e-13);
  Diagnostics d;
  EXPECT_THROW(make("BEGIN BULK\nGRID,1\nGRID,2\nGRID,3,,1.\nRSPLINE,7,,1,2,123,3\n", d), InputError);
  EXPECT_TRUE(d.has("fe.zero-length"));
}

TEST(Accelerations, OfAllGridsAreGravity) {
  Diagnostics d;
  const auto l = make("BEGIN BULK\nCORD2R,5,,0.,0.,0.,.3,.2,1.,+\n+,1.,.1,0.\n" + kPlateAndBar.substr(11) +
                          "ACCEL1,2,5,9.81,1.,2.,-3.,,,+\n+,ALL\nGRAV,3,5,9.81,1.,2.,-3.\nACCEL1,4,,2.,0.,1.,0.,,,+\n"
                          "+,5,THRU,8\nACCEL,6,,0.,0.,3.,X,,,+\n+,0.,1.,5.,3.\n",
                      d);
  const VectorXd gravity = calc_load(l.model, l.deck, 3, d);
  EXPECT_LT((calc_load(l.model, l.deck, 2, d) - gravity).norm(), 1e-13 * gravity.norm());
  // Lumped: half of the bar's mass 3 at grid 5.
  const VectorXd one = calc_load(l.model, l.deck, 4, d);
  EXPECT_NEAR(one[l.model.node(l.model.find_node(5)).first_gdof + 1], 2 * 1.5, 1e-13);
  EXPECT_NEAR(one.cwiseAbs().sum(), 3, 1e-13);
  // 3 (1 + 2 x/5) by the lumped masses: plate 0.1 at x = 0, 0, 2, 2, bar 1.5 at 2 and 5.
  const VectorXd sloped = calc_load(l.model, l.deck, 6, d);
  EXPECT_NEAR(calc_resultant(l.model, sloped)[2], 3 * (0.2 + (0.2 + 1.5) * 1.8 + 1.5 * 3), 1e-12);
  EXPECT_EQ(d.num_errors(), 0);
}

TEST(AutospcNo, WhatNothingStiffensIsHeldAndWithMassItFloats) {
  // A rod along x from a fixed grid; grid 3 has a mass and nothing else, grid 4 nothing at all.
  const std::string text =
      "SPC = 1\nBEGIN BULK\nPARAM,AUTOSPC,NO\nGRID,1\nGRID,2,,1.\nGRID,3,,2.\nGRID,4,,3.\nCROD,1,1,1,2\n"
      "PROD,1,1,1.,1.\nMAT1,1,1.,,.3,1.\nCONM2,2,3,,5.\nSPC1,1,123456,1\n";
  const auto build = [&](bool is_static, Diagnostics& d) {
    const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, d);
    ModelOptions options;
    options.uses_enforced = is_static;
    return build_model(deck, options, d);
  };
  Diagnostics d;
  EXPECT_EQ(build(true, d).num_fdofs(), 2);  // the rod's stretch and twist
  EXPECT_TRUE(d.has("fe.null-dofs"));
  EXPECT_FALSE(d.has("fe.autospc"));
  Diagnostics modes;
  // Translations of the rod's end across it and of grid 3 have mass.
  EXPECT_EQ(build(false, modes).num_fdofs(), 2 + 2 + 3);
}

TEST(Rbe3OnALine, FollowsWhereTheLineSaysEnough) {
  // Grids 2 to 4 and the reference on a line along y: their x, weighted, is that of the reference (three stations at
  // distances -1, 0, 2 from it), and so is any motion but the rotation about y.
  const auto l = make(
      "BEGIN BULK\nGRID,1,,5.,2.,0.\nGRID,2,,5.,1.,0.\nGRID,3,,5.,2.,0.\nGRID,4,,5.,4.,0.\n"
      "RBE3,7,,1,12346,2.,123,2,1.,+\n+,123,3,1.,123,4\n");
  const MatrixXd T = MatrixXd(l.model.T());
  const MatrixXd rigid = l.model.calc_rigid_modes();
  const MatrixXd q = T.completeOrthogonalDecomposition().solve(rigid);
  EXPECT_LT((T * q - rigid).norm(), 1e-12 * rigid.norm());
  // Least squares of x over the distance: weights 2, 1, 1 at -1, 0, 2 have their mean at 0.
  const int f2 = l.model.find_fdof(l.model.find_node(2), 1), f4 = l.model.find_fdof(l.model.find_node(4), 1);
  const int row = l.model.node(l.model.find_node(1)).first_gdof;
  EXPECT_NEAR(T(row, f2), 0.5, 1e-13);
  EXPECT_NEAR(T(row, f4), 0.25, 1e-13);
  Diagnostics d;
  EXPECT_THROW(make("BEGIN BULK\nGRID,1,,5.,2.,0.\nGRID,2,,5.,1.,0.\nGRID,3,,5.,3.,0.\nRBE3,7,,1,5,1.,123,2,3\n", d),
               InputError);
  EXPECT_TRUE(d.has("fe.rbe3-mechanism"));
}

TEST(Sload, AtAGridActsAlongItsFirstAxis) {
  Diagnostics d;
  const auto l = make(
      "BEGIN BULK\nCORD2R,5,,0.,0.,0.,0.,1.,0.,+\n+,0.,0.,1.\nGRID,1,,,,,5\nGRID,2,,1.\nCROD,1,1,1,2\nPROD,1,1,1.\n"
      "MAT1,1,1.,,.3\nSLOAD,3,1,2.5,2,4.\n",
      d);
  const VectorXd F = calc_load(l.model, l.deck, 3, d);
  EXPECT_LT((F.head<3>() - Vector3d(0, 0, 2.5)).norm(), 1e-15);  // x of system 5 is z of basic
  EXPECT_EQ(F[6], 4);
}

}  // namespace
}  // namespace bough::fe
