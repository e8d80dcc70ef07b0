/// \file Cards in their rarer spellings, each against the same structure written in another way or in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/fe/model/same_decks.hpp"

namespace bough::fe::test {
namespace {

const std::string kHead = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\n";
const std::string kSteel = "MAT1,1,7.+10,,.3,2700.\n";
/// Unsymmetric enough that turned axes are seen.
const std::string kBar = "PBAR,1,1,1.-3,2.-7,5.-8,8.-8\n" + kSteel;
const std::string kLine = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nSPC1,1,123456,1\n";
const std::string kPush = "FORCE,2,2,,100.,.3,1.,-.7\nMOMENT,2,2,,10.,1.,.4,.2\n";
const std::string kTurned = "CORD2R,7,,0.,0.,0.,0.,0.,1.,+\n+,.6,.8,0.\n";  // x along (.6, .8, 0), y along (-.8, .6, 0)

TEST(Probes, OfftOfBars) {
  // Vector and offsets in the axes of GA (G), in basic (B), or the offsets in the element's (O).
  const std::string grids = kTurned + "GRID,1,,0.,0.,0.,7\nGRID,2,,1.,0.,0.,7\nSPC1,1,123456,1\n" + kBar + kPush;
  const auto deck = [&](const std::string& vector, const std::string& offt, const std::string& offsets,
                        const std::string& grid = {}) {
    return kHead + (grid.empty() ? grids : grid) + "CBAR,1,1,1,2," + vector + "," + offt + ",+\n+,,," + offsets + "\n";
  };
  // (.1, .2, .3) of basic is (.22, .04, .3) in system 7; the vector (0, 1, 0) is (.8, .6, 0).
  const auto oracle = deck("0.,1.,0.", "GGG", ".1,.2,.3,.1,-.1,.2",
                           "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nSPC1,1,123456,1\n" + kBar + kPush);
  expect_same(deck(".8,.6,0.", "GGG", ".22,.04,.3,-.02,-.14,.2"), oracle);
  expect_same(deck("0.,1.,0.", "BGG", ".22,.04,.3,-.02,-.14,.2"), oracle);
  // Offsets in element axes: x from GA to GB, then the plane of the vector: those of basic here.
  expect_same(deck("0.,1.,0.", "BOO", ".1,.2,.3,.1,-.1,.2"), oracle);
  expect_same(deck(".8,.6,0.", "GOO", ".1,.2,.3,.1,-.1,.2"), oracle);
  expect_same(deck("0.,1.,0.", "BGO", ".22,.04,.3,.1,-.1,.2"), oracle);
  expect_same(deck(".8,.6,0.", "GOG", ".1,.2,.3,-.02,-.14,.2"), oracle);
}

TEST(Probes, OffsetsAreRigidArms) {
  const std::string bar = kHead + kBar + kPush + kLine;
  expect_same(bar + "CBAR,1,1,1,2,0.,1.,0.,,+\n+,,,.1,.2,.3,.1,-.1,.2\n",
              bar +
                  "GRID,11,,.1,.2,.3\nGRID,12,,1.1,-.1,.2\nCBAR,1,1,11,12,0.,1.,0.\nRBE2,8,1,123456,11\n"
                  "RBE2,9,2,123456,12\n");
}

TEST(Probes, PbeamNeutralAxisAndMassOffTheShearCentre) {
  // A pull at the grid, the neutral axis .05 above it (y): the section turns by N e L / EI1 about z, and goes along
  // with it.
  const double E = 7e10, A = 1e-3, I1 = 2e-7, L = 1, e = .05, N = 1000;
  const auto u = solve_at(kHead + kLine + kSteel +
                              "FORCE,2,2,,1000.,1.,0.,0.\nCBEAM,1,1,1,2,0.,1.,0.\n"
                              "PBEAM,1,1,1.-3,2.-7,5.-8,,8.-8,,+\n+,,,,,,,,,+\n+,0.,0.,,,,,,,+\n+,,,,,.05,0.,.05,0.\n",
                          2);
  EXPECT_NEAR(u[5] / (N * e * L / (E * I1)), u[5] > 0 ? 1 : -1, 1e-9);
  EXPECT_GT(u[5], 0);
  EXPECT_NEAR(u[0], N * L / (E * A) + u[5] * e, 1e-9 * std::abs(u[0]));
  // Nonstructural mass at M = (.02, -.03) from the shear centre is mass on a line beside the beam.
  const auto nsm = [&](const std::string& more, const std::string& nsm_and_m) {
    return kHead + "PARAM,COUPMASS,-1\n" + kLine + kPush +
           "MAT1,1,7.+10,,.3\nCBEAM,1,1,1,2,0.,1.,0.\nPBEAM,1,1,1.-3,2.-7,5.-8,,8.-8," + nsm_and_m + more;
  };
  const std::string masses = "CONM2,51,1,,2.,0.,.02,-.03\nCONM2,52,2,,2.,0.,.02,-.03\n";
  expect_same(nsm("", "4.,+\n+,,,,,,,,,+\n+,0.,0.,,,,,,,+\n+,.02,-.03,.02,-.03\n"),
              nsm(masses, "0.,+\n+,,,,,,,,,+\n+,0.,0.\n"), 1e-8);
}

TEST(Probes, PinFlags) {
  const std::string bar = kHead + kBar + kPush + kLine;
  const std::string prop = "GRID,3,,1.,1.,0.\nCBAR,2,1,2,3,0.,0.,1.\nSPC1,1,123456,3\n";
  expect_same(bar + prop + "CBAR,1,1,1,2,0.,1.,0.,,+\n+,,6\n",
              bar + prop + "GRID,12,,1.,0.,0.\nCBAR,1,1,1,12,0.,1.,0.\nRBE2,9,2,12345,12\n");
  expect_same(bar + prop + "CBAR,1,1,1,2,0.,1.,0.,,+\n+,56,4\n",
              bar + prop +
                  "GRID,11,,0.,0.,0.\nGRID,12,,1.,0.,0.\nCBAR,1,1,11,12,0.,1.,0.\nRBE2,8,1,1234,11\n"
                  "RBE2,9,2,12356,12\n");
}

TEST(Probes, TaperedBeam) {
  // N L ln(A1/A0) / (E (A1 - A0)), torsion alike.
  const auto u = solve_at(kHead + kLine + kSteel +
                              "FORCE,2,2,,1000.,1.,0.,0.\nMOMENT,2,2,,10.,1.,0.,0.\n"
                              "CBEAM,1,1,1,2,0.,1.,0.\nPBEAM,1,1,1.-3,2.-7,5.-8,,8.-8,,+\n+,,,,,,,,,+\n"
                              "+,NO,1.,5.-4,1.-7,2.-8,,4.-8,,+\n+,0.,0.\n",
                          2);
  EXPECT_NEAR(u[0] / (1000 * std::log(2) / (7e10 * 5e-4)), 1, 1e-3);
  EXPECT_NEAR(u[3] / (10 * std::log(2) / (7e10 / 2.6 * 4e-8)), 1, 1e-3);
}

TEST(Probes, SystemsInSystems) {
  // A spherical system inside a cylindrical one that lies in a turned one: the grid by hand in basic.
  const double r = 2, angle = 30 * M_PI / 180;
  // 8: cylindrical in 7 at (1, 0, 0) of 7; its z along that of 7, its x along x of 7. 9: spherical, origin at r = 2,
  // 30 deg, z = 1 of 8; z axis straight up; x towards r = 3, 30 deg.
  const double x7 = 1 + r * std::cos(angle), y7 = r * std::sin(angle);
  const double sx = x7 + .5 * std::cos(angle), sy = y7 + .5 * std::sin(angle);  // theta 90, phi 0, rho .5
  char line[120];
  std::snprintf(line, sizeof line, "GRID,2,,%.15f,%.15f,1.\n", .6 * sx - .8 * sy, .8 * sx + .6 * sy);
  const std::string more = kBar + kPush + "GRID,1,,0.,0.,0.\nSPC1,1,123456,1\nCBAR,1,1,1,2,0.,0.,1.\n";
  expect_same(kHead + more + kTurned +
                  "CORD2C,8,7,1.,0.,0.,1.,0.,1.,+\n+,2.,0.,0.\nCORD2S,9,8,2.,30.,1.,2.,30.,2.,+\n"
                  "+,3.,30.,1.\nGRID,2,9,.5,90.,0.\n",
              kHead + more + line);
  // CORD1R by three grids is the CORD2R through their points; GRDSET gives CP, CD and PS where a GRID is blank.
  const std::string points =
      "GRID,11,0,1.,2.,0.,0,123456\nGRID,12,0,1.,2.,1.,0,123456\nGRID,13,0,1.6,2.8,0.,0,123456\n";
  const std::string rest = kBar + "SPC1,1,123456,1\nFORCE,2,2,5,100.,.3,1.,-.7\nCBAR,1,1,1,2,0.,0.,1.\n";
  const std::string plain = kHead + rest + "GRID,1,5,0.,0.,0.,5,123456\nGRID,2,5,1.,.5,.2,5,6\n";
  expect_same(plain + "CORD1R,5,11,12,13\n" + points, plain + "CORD2R,5,,1.,2.,0.,1.,2.,1.,+\n+,1.6,2.8,0.\n");
  expect_same(kHead + rest +
                  "CORD2R,5,,1.,2.,0.,1.,2.,1.,+\n+,1.6,2.8,0.\nGRDSET,,5,,,,5,6\n"
                  "GRID,1,,0.,0.,0.,,123456\nGRID,2,,1.,.5,.2\n",
              plain + "CORD2R,5,,1.,2.,0.,1.,2.,1.,+\n+,1.6,2.8,0.\n");
}

TEST(Probes, LoadsInSystemsAndCombinations) {
  const std::string bar = kBar + "CBAR,1,1,1,2,0.,1.,0.\n" + kTurned + kLine;
  // (1, 2, 3) of 7 is (-1, 2, 3) of basic: .6 - 1.6, .8 + 1.2.
  expect_same(kHead + bar + "FORCE,2,2,7,10.,1.,2.,3.\nMOMENT,2,2,7,4.,1.,2.,3.\n",
              kHead + bar + "FORCE,2,2,0,10.,-1.,2.,3.\nMOMENT,2,2,0,4.,-1.,2.,3.\n");
  // In a cylindrical system the axes are those at the grid.
  expect_same(kHead + bar + "CORD2C,8,,1.,-1.,0.,1.,-1.,1.,+\n+,2.,-1.,0.\nMOMENT,2,2,8,4.,1.,0.,2.\n",
              kHead + bar + "MOMENT,2,2,0,4.,0.,1.,2.\n");
  expect_same(kHead + bar + "GRAV,2,7,9.81,1.,2.,3.\n", kHead + bar + "GRAV,2,0,9.81,-1.,2.,3.\n");
  expect_same(kHead + bar + "LOAD,2,2.,1.5,11,-.5,12\nFORCE,11,2,,10.,1.,1.,0.\nMOMENT,12,2,,4.,0.,1.,1.\n",
              kHead + bar + "FORCE,2,2,,30.,1.,1.,0.\nMOMENT,2,2,,-4.,0.,1.,1.\n");
  // Spin about an axis through grid 9, off every mass: m ω² from the axis.
  const double w = 2 * M_PI * 1.5;
  char force[100];
  std::snprintf(force, sizeof force, "FORCE,2,2,0,%.15g,1.,-2.,0.\n", 3 * w * w);
  const std::string mass = "CONM2,5,2,,3.\nGRID,9,,0.,2.,5.,,123456\n";
  const std::string light = "PBAR,1,1,1.-3,2.-7,5.-8,8.-8\nMAT1,1,7.+10,,.3\nCBAR,1,1,1,2,0.,1.,0.\n" + kLine + mass;
  expect_same(kHead + light + "RFORCE,2,9,0,1.5,0.,0.,1.\n", kHead + light + force);
}

TEST(Probes, PressureAlongAVectorAndOnATriangle) {
  const std::string plate =
      "PSHELL,1,1,.01,1,,1\n" + kSteel +
      "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,2.,3.,0.\nGRID,4,,0.,3.,0.\nSPC1,1,123456,1,2\n";
  const std::string quad = plate + "CQUAD4,1,1,1,2,3,4\n";
  // Area 6, each corner a quarter; (1, 2, 3) of 7 has the length sqrt(14): the vector is a direction.
  std::string forces;
  for (int g = 1; g <= 4; ++g) {
    char line[100];
    std::snprintf(line, sizeof line, "FORCE,2,%d,0,%.15g,-1.,2.,3.\n", g, 50 * 6 / 4.0 / std::sqrt(14));
    forces += line;
  }
  expect_same(kHead + quad + kTurned + "PLOAD4,2,1,50.,,,,,,+\n+,7,1.,2.,3.\n", kHead + quad + forces);
  const std::string tri = plate + "CTRIA3,1,1,1,2,3\nCTRIA3,2,1,1,3,4\n";
  const std::string third = "FORCE,2,1,0,50.,0.,0.,1.\nFORCE,2,2,0,50.,0.,0.,1.\nFORCE,2,3,0,50.,0.,0.,1.\n";
  expect_same(kHead + tri + "PLOAD,2,50.,1,2,3\n", kHead + tri + third);
}

TEST(Probes, SpcdOfTwoSubcasesAndUnitedSets) {
  const std::string deck =
      "SOL 101\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 11\nSUBCASE 2\nLOAD = 12\nBEGIN BULK\n" + kBar + kLine +
      "GRID,3,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nCBAR,2,1,2,3,0.,1.,0.\nSPC1,1,2,3\nSPCD,11,3,2,.01\nSPCD,12,3,2,-.03\n";
  const auto one = solve_at(deck, 2, 1), two = solve_at(deck, 2, 2);
  EXPECT_NEAR(one[1], .01 * 5 / 16, 1e-12);  // a cantilever's line: (3 x² L - x³) / (2 L³) at its middle
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(two[i], -3 * one[i], 1e-13);
  const std::string bars = kBar + kPush +
                           "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\n"
                           "CBAR,1,1,1,2,0.,1.,0.\nCBAR,2,1,2,3,0.,1.,0.\n";
  const std::string united = "SOL 101\nCEND\nSPC = 9\nMPC = 8\nLOAD = 2\nBEGIN BULK\n" + bars;
  expect_same(
      united + "SPCADD,9,1,3\nSPC1,1,123,1\nSPC1,3,456,1\nMPCADD,8,4,5\nMPC,4,3,2,1.,2,2,-1.\nMPC,5,3,3,2.,2,3,1.\n",
      united + "SPC1,9,123456,1\nMPC,8,3,2,1.,2,2,-1.\nMPC,8,3,3,2.,2,3,1.\n");
}

TEST(Probes, SpringsBetweenTurnedGrids) {
  const std::string bars = kHead + kTurned + kBar + kPush +
                           "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.,7\nGRID,3,,1.,1.,0.,,456\nSPC1,1,123456,1\n"
                           "CBAR,1,1,1,2,0.,1.,0.\nCELAS2,31,500.,3,1\nCELAS2,32,500.,3,2\nCELAS2,33,500.,3,3\n";
  // y of 7 at grid 2 is (-.8, .6, 0): the spring's stretch as an MPC of basic components.
  const std::string oracle_bars = [&] {
    auto text = bars;
    text.replace(text.find("GRID,2,,1.,0.,0.,7"), 18, "GRID,2,,1.,0.,0.");
    text.replace(text.find("SPC = 1\n"), 8, "SPC = 1\nMPC = 6\n");
    return text;
  }();
  expect_same(bars + "CELAS2,9,2000.,2,2,3,3\n",
              oracle_bars + "SPOINT,90\nMPC,6,90,0,1.,2,1,.8,,+\n+,,2,2,-.6\nCELAS2,9,2000.,90,0,3,3\n");
  // A bush in system 7 between coincident grids is springs along its axes.
  const std::string pair = kHead + kTurned + kBar + kPush + kLine +
                           "CBAR,1,1,1,2,0.,1.,0.\nGRID,3,,1.,0.,0.,,456\nCELAS2,31,500.,3,1\nCELAS2,32,500.,3,2\n"
                           "CELAS2,33,500.,3,3\n";
  expect_same(pair + "CBUSH,9,9,2,3,,,,7\nPBUSH,9,K,100.,2000.,0.,0.,0.,0.\n",
              pair +
                  "GRID,40,,1.,0.,0.,7,456\nGRID,41,,1.,0.,0.,7,456\nRBE2,42,3,123,40\nRBE2,43,2,123,41\n"
                  "CELAS2,9,100.,41,1,40,1\nCELAS2,10,2000.,41,2,40,2\n");
}

TEST(Probes, BushAwayFromItsGrids) {
  const std::string bars = kHead + kTurned + kBar + kPush + kLine +
                           "GRID,3,,2.,.5,0.\nSPC1,1,123456,3\nCBAR,1,1,1,2,0.,1.,0.\n"
                           "PBUSH,9,K,1.+5,2.+5,3.+5,400.,500.,600.\n";
  // At S of the line GA-GB, or at an offset from GA in system 7: (1.4, -.3, .2) is .84 + .24, 1.12 - .18, .2 of basic.
  const std::string ends = "RBE2,41,2,123456,51\nRBE2,42,3,123456,52\n";
  expect_same(bars + "CBUSH,9,9,2,3,,,,7,+\n+,.25\n",
              bars + ends + "GRID,51,,1.25,.125,0.\nGRID,52,,1.25,.125,0.\nCBUSH,9,9,51,52,,,,7\n");
  expect_same(bars + "CBUSH,9,9,2,3,,,,7,+\n+,,7,1.4,-.3,.2\n",
              bars + ends + "GRID,51,,2.08,.94,.2\nGRID,52,,2.08,.94,.2\nCBUSH,9,9,51,52,,,,7\n");
}

TEST(Probes, PointMasses) {
  const std::string bar = kHead + kTurned + kBar + kPush + "CBAR,1,1,1,2,0.,1.,0.\nGRID,1,,0.,0.,0.\n";
  const std::string basic = bar + "GRID,2,,1.,0.,0.\nSPC1,1,123456,1\n",
                    turned = bar + "GRID,2,,1.,0.,0.,7\nSPC1,1,123456,1\n";
  // m = 2 at (.1, .2, .3): S and I about the grid are m of the arm.
  const std::string offset = basic + "CONM2,9,2,0,2.,.1,.2,.3,,+\n+,.5,.02,.6,.03,-.01,.7\n";
  expect_same(
      basic + "CONM1,9,2,0,2.,0.,2.,0.,0.,+\n+,2.,0.,-.6,.4,.76,.6,0.,-.2,+\n+,-.06,.8,-.4,.2,0.,-.09,-.11,.8\n",
      offset, 1e-9);
  // CID -1: the offset counts as a place in basic, the inertia stands in basic axes.
  expect_same(basic + "CONM2,9,2,-1,2.,1.1,.2,.3,,+\n+,.5,.02,.6,.03,-.01,.7\n", offset);
  // In the system of the grid's displacements or in any other, the same body.
  expect_same(turned + "CONM2,9,2,7,2.,.22,.04,.3\n", basic + "CONM2,9,2,0,2.,.1,.2,.3\n");
  expect_same(basic + "CMASS2,9,3.,2,2\nCELAS2,8,10.,2,2\n", basic + "CELAS2,8,10.,2,2\nCONM1,9,2,0,0.,0.,3.\n");
}

TEST(Probes, PropertiesOfPlates) {
  const std::string plate =
      "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,2.,3.,0.\nGRID,4,,0.,3.,0.\nSPC1,1,123456,1,2\n"
      "CQUAD4,1,1,1,2,3,4\nFORCE,2,3,,10.,1.,.2,3.\nMOMENT,2,4,,10.,.3,.2,0.\n" +
      kSteel;
  const std::string head = kHead + plate;
  expect_same(head + "PSHELL,1,1,.01,1,8.,1\n", head + "MAT1,2,5.6+11,,.3\nPSHELL,1,1,.01,2,,1\n");
  expect_same(head + "PSHELL,1,1,.01,1,,1,1.25\n",
              head + "MAT1,2,7.+10,,.3\nMAT1,3,8.75+10,,.3\nPSHELL,1,1,.01,2,,3,1.\n");
  // Membrane and bending alone, each on its own element, are the whole.
  expect_same(head + "PSHELL,1,1,.01,1,,1\n",
              head + "PSHELL,1,1,.01\nCQUAD4,2,2,1,2,3,4\nMAT1,2,7.+10,,.3\nPSHELL,2,,.01,2,,2\nPARAM,K6ROT,100.\n",
              1e-6);
  const std::string ply = "MAT8,8,1.4+11,1.+10,.3,5.+9,4.+9,3.+9,1600.\n";
  expect_same(head + ply + "PCOMP,1,,,,,,,SYM,+\n+,8,.001,0.,,8,.002,45.,,+\n+,8,.001,-30.\n",
              head + ply +
                  "PCOMP,1,,,,,,,,+\n+,8,.001,0.,,8,.002,45.,,+\n+,8,.001,-30.,,8,.001,-30.,,+\n"
                  "+,8,.002,45.,,8,.001,0.\n");
  // Plies from Z0 = 0 up: A = Q t, B = Q t²/2, D = Q t³/3; MID4 couples with the other sign.
  const std::string light = head.substr(0, head.find(",2700.")) + "\n";  // the plies carry their mass where they are
  expect_same(light + "PCOMP,1,0.,,,,,,,+\n+,1,.004,0.,,1,.006,0.\n",
              light +
                  "PSHELL,1,1,.01,1,4.,1,,,+\n+,,,4\nMAT2,4,-3.8461538461538+10,-1.1538461538462+10,0.,"
                  "-3.8461538461538+10,0.,-1.3461538461538+10\n",
              1e-6);
}

TEST(Probes, WeightIsTurnedIntoMass) {
  const std::string bar = kHead + kPush + kLine + "CBAR,1,1,1,2,0.,1.,0.\n";
  expect_same(
      bar + "PARAM,WTMASS,2.59-3\nPBAR,1,1,1.-3,2.-7,5.-8,8.-8,40.\nMAT1,1,7.+10,,.3,5000.\nCONM2,9,2,,7.,0.,.1\n",
      bar + "PBAR,1,1,1.-3,2.-7,5.-8,8.-8,.1036\nMAT1,1,7.+10,,.3,12.95\nCONM2,9,2,,.01813,0.,.1\n");
}

TEST(Probes, RigidBarsOfMixedComponents) {
  const std::string bars = kHead + kBar + kPush + kLine +
                           "CBAR,1,1,1,2,0.,1.,0.\nGRID,3,,1.,.5,0.\n"
                           "GRID,4,,2.,.5,0.\nCBAR,2,1,3,4,0.,1.,0.\nFORCE,2,4,,50.,.2,.4,1.\n";
  expect_same(bars + "RBAR,9,2,3,123456,,,123456\n", bars + "RBE2,9,2,123456,3\n");
  // Independent components at both ends: 12356 of grid 2 and 4 of grid 3 are six of one rigid body.
  expect_same(bars + "RBAR,9,2,3,12356,4,4,12356\n", bars + "RBE2,9,2,123456,3\n");
  // Rotations about y and z stay free at 3.
  expect_same(bars + "CELAS2,21,1000.,3,5\nCELAS2,22,1000.,3,6\nRBAR,9,2,3,123456,,,1234\n",
              bars + "CELAS2,21,1000.,3,5\nCELAS2,22,1000.,3,6\nRBE2,9,2,1234,3\n");
}

TEST(Probes, EquationsThatNameEachOther) {
  // u1 = u2/2 + u3/2 and u2 = u1/2 + u3/2 make all three equal: three springs side by side.
  const std::string deck =
      "SOL 101\nCEND\nSPC = 1\nMPC = 5\nLOAD = 2\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\n"
      "CELAS2,1,100.,1,1\nCELAS2,2,100.,2,1\nCELAS2,3,100.,3,1\nSPC1,1,23456,1,2,3\nFORCE,2,3,,6.,1.,0.,0.\n";
  const std::string pair = "MPC,5,1,1,1.,2,1,-.5,,+\n+,,3,1,-.5\nMPC,5,2,1,1.,1,1,-.5,,+\n+,,3,1,-.5\n";
  for (const int grid : {1, 2, 3}) EXPECT_NEAR(solve_at(deck + pair, grid)[0], .02, 1e-15);
  // A dependent dof twice in its own equation: 2 u1 - u1 = u3; and a chain behind a circle.
  expect_same(deck + "MPC,5,1,1,2.,1,1,-1.,,+\n+,,3,1,-1.\n", deck + "MPC,5,1,1,1.,3,1,-1.\n");
  const std::string behind =
      "GRID,4,,3.,0.,0.\nSPC1,1,23456,4\nCELAS2,4,100.,4,1\nMPC,5,4,1,1.,1,1,-2.,,+\n+,,2,1,1.\n";
  EXPECT_NEAR(solve_at(deck + behind + pair, 4)[0], .015, 1e-15);
  // Rigid elements may close the circle too.
  expect_same(kHead + kBar + kPush + kLine + "CBAR,1,1,1,2,0.,1.,0.\nGRID,3,,1.,1.,0.\nRBE2,9,2,123456,3\n",
              "SOL 101\nCEND\nSPC = 1\nMPC = 5\nLOAD = 2\nBEGIN BULK\n" + kBar + kPush + kLine +
                  "CBAR,1,1,1,2,0.,1.,0.\nGRID,3,,1.,1.,0.\nRBE2,9,2,12345,3\nMPC,5,3,6,2.,2,6,-1.,,+\n+,,3,6,-1.\n");
}

}  // namespace
}  // namespace bough::fe::test
