/// \file Elements of NASTRAN-95 as those of today (User's Manual, section 2.4).
#include <cmath>

#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

Read read_old(const std::string& text) {
  auto r = read("MAT1,1,7.+10,,.3,2700.\nMAT1,9,7.+9,,.3,300.\n" + text);
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  return r;
}

const records::Pshell& find(const records::Deck& deck, int id) {
  for (const auto& p : deck.pshell)
    if (p.id == id) return p;
  throw std::out_of_range("PSHELL " + std::to_string(id));
}

TEST(OldElements, PropertiesOfEachCardHaveIdsOfTheirOwn) {
  const auto r = read_old(
      "CQUAD2,1,5,1,2,3,4,30.\nPQUAD2,5,1,.02,.5,6,1,.03\n"
      "CTRIA2,2,5,1,2,3\nPTRIA2,5,9,.04\n"
      "CQUAD4,3,5,1,2,3,4\nPSHELL,5,1,.01\n");
  const auto& deck = r.deck;
  ASSERT_EQ(deck.shells.size(), 3u);
  EXPECT_EQ(values(deck.shells[0].card, deck.shells[0].theta_deg, deck.shells[1].card),
            values("CQUAD4", 30.0, "CTRIA3"));
  EXPECT_EQ(deck.shells[2].pid, 5);
  // A homogeneous plate: all three parts of one material, shear thickness T.
  const auto& quad = find(deck, deck.shells[0].pid);
  EXPECT_EQ(values(quad.mid1, quad.mid2, quad.mid3, quad.t), values(1, 1, 1, .02));
  EXPECT_NEAR(quad.bending_ratio, 1, 1e-14);
  EXPECT_EQ(values(quad.shear_ratio, quad.nsm, find(deck, deck.shells[1].pid).mid1), values(1.0, .5, 9));
  EXPECT_EQ(find(deck, 5).t, .01);
  ASSERT_EQ(r.count("deck.old-element"), 1);
  EXPECT_NE(r.find("deck.old-element")->what.find("1 CQUAD2 as CQUAD4, 1 CTRIA2 as CTRIA3"), std::string::npos);
}

TEST(OldElements, ThreeMaterials) {
  const auto r = read_old("CQUAD1,1,1,1,2,3,4\nPQUAD1,1,1,.1,9,2.-4,1,.05,.7\n+,.1,-.1\n");
  const auto& p = find(r.deck, r.deck.shells.at(0).pid);
  EXPECT_EQ(values(p.mid1, p.mid2, p.mid3), values(1, 9, 1));
  EXPECT_NEAR(p.bending_ratio, 12 * 2e-4 / 1e-3, 1e-12);
  EXPECT_NEAR(p.shear_ratio, .5, 1e-14);
  EXPECT_EQ(p.nsm, .7);
  // T3 blank: rigid in shear.
  EXPECT_EQ(read_old("PTRIA1,1,1,.1,9,2.-4\n").deck.pshell.at(0).mid3, 0);
}

TEST(OldElements, PlatesWithoutMembraneHaveNoMass) {
  for (const char* text :
       {"CQDPLT,1,1,1,2,3,4\nPQDPLT,1,1,2.-4,1,.05,.7\n", "CTRPLT,1,1,1,2,3\nPTRPLT,1,1,2.-4,1,.05,.7\n",
        "CTRBSC,1,1,1,2,3\nPTRBSC,1,1,2.-4,1,.05,.7\n"}) {
    const auto deck = read_old(text).deck;
    const auto& p = find(deck, deck.shells.at(0).pid);
    EXPECT_EQ(p.mid1, 0);
    const double t = p.t.value();
    EXPECT_NEAR(p.bending_ratio * t * t * t / 12, 2e-4, 1e-18);
    EXPECT_NEAR(p.shear_ratio * t, .05, 1e-15);
    EXPECT_EQ(p.nsm, .7);
    ASSERT_NE(p.mid2, 1);
    const auto& copy = deck.mat1.back();
    EXPECT_EQ(values(copy.id, copy.rho, copy.E), values(p.mid2, 0.0, 7e10));
  }
}

TEST(OldElements, Membranes) {
  const auto deck = read_old(
                        "CQDMEM,1,1,1,2,3,4\nPQDMEM,1,1,.1,.2\nCQDMEM1,2,1,1,2,3,4\nPQDMEM1,1,1,.2\nCQDMEM2,3,1,1,2,3,"
                        "4\nPQDMEM2,1,1,.3\n"
                        "CTRMEM,4,1,1,2,3\nPTRMEM,1,1,.4\nCIS2D8,5,1,1,2,3,4,5,6\n+,7,8,2,15.\nPIS2D8,1,1,.5\n"
                        "CTRIM6,6,1,1,2,3,4,5,6\nPTRIM6,1,1,.6,.7,,.1\n")
                        .deck;
  ASSERT_EQ(deck.shells.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& p = find(deck, deck.shells[i].pid);
    EXPECT_NEAR(p.t.value(), .1 * static_cast<double>(i + 1), 1e-15);
    EXPECT_EQ(p.mid1, 1);
    EXPECT_EQ(p.mid2, 0);
  }
  EXPECT_EQ(values(deck.shells[4].card, deck.shells[4].midsides, deck.shells[4].theta_deg),
            values("CQUAD8", (std::vector<int>{5, 6, 7, 8}), 15.0));
  // Corners and midsides by turns; a thickness that is blank is that of the first corner.
  EXPECT_EQ(
      values(deck.shells[5].card, deck.shells[5].grids, deck.shells[5].midsides, deck.shells[5].t),
      values("CTRIA6", (std::vector<int>{1, 3, 5}), (std::vector<int>{2, 4, 6}), (std::vector<double>{.6, .7, .6})));
}

TEST(OldElements, HigherOrderShell) {
  const auto deck = read_old("CTRSHL,1,1,1,2,3,4,5,6\n+,16.2\nPTRSHL,1,1,3.,,,9,2.25,\n+,,1,2.5,,,50.\n").deck;
  const auto& p = find(deck, deck.shells.at(0).pid);
  EXPECT_EQ(deck.shells[0].theta_deg, 16.2);
  EXPECT_TRUE(deck.shells[0].t.empty());
  EXPECT_NEAR(p.bending_ratio, 1, 1e-14);
  EXPECT_NEAR(p.shear_ratio, 2.5 / 3, 1e-14);
  EXPECT_EQ(p.mid2, 9);
  EXPECT_EQ(p.nsm, 50.0);
}

TEST(OldElements, SolidsNameMaterials) {
  const auto r = read_old(
      "CHEXA1,1,1,1,2,3,4,5,6,7,8\nCHEXA2,2,9,1,2,3,4,5,6,7,8\nCWEDGE,3,1,1,2,3,5,6,7\nCTETRA,4,9,1,2,3,5\n"
      "CTETRA,5,3,1,2,3,5\nPSOLID,3,1\nCHEXA,6,1,1,2,3,4,5,6,7,8\nPSOLID,1,9\n");
  const auto& deck = r.deck;
  ASSERT_EQ(deck.solids.size(), 6u);
  const auto find_mid = [&](std::size_t i) {
    for (const auto& p : deck.psolid)
      if (p.id == deck.solids[i].pid) return p.mid;
    return -1;
  };
  EXPECT_EQ(values(find_mid(0), find_mid(1), find_mid(2)), values(1, 9, 1));
  EXPECT_EQ(deck.solids[2].card, "CPENTA");
  EXPECT_EQ(find_mid(3), 9);  // no PSOLID 9: a material, as the old program has it
  EXPECT_EQ(find_mid(4), 1);  // PSOLID 3
  EXPECT_EQ(find_mid(5), 9);  // PSOLID 1, not MAT1 1
}

TEST(OldElements, IsoparametricHexahedra) {
  const auto deck =
      read_old("CIHEX2,110,7,3,8,12,13,14,9,5,4,16,19,20,17,23,27,31,32,33,28,25,24\nPIHEX,7,1,0,3\n").deck;
  const auto& e = deck.solids.at(0);
  // The example of the manual: G1 G3 G5 G7 and G13 G15 G17 G19 are corners.
  EXPECT_EQ(values(e.corners, e.midsides, deck.psolid.at(0).mid),
            values((std::vector<int>{3, 12, 14, 5, 23, 31, 33, 25}),
                   (std::vector<int>{8, 13, 9, 4, 16, 19, 20, 17, 27, 32, 28, 24}), 1));
  std::string cubic = "CIHEX3,1,7";
  for (int g = 1; g <= 32; ++g) cubic += "," + std::to_string(g);
  const auto third = read_old((cubic + "\nPIHEX,7,1\n").c_str()).deck;
  EXPECT_EQ(third.solids.at(0).corners, (std::vector<int>{1, 4, 7, 10, 21, 24, 27, 30}));
  EXPECT_EQ(third.solids.at(0).midsides, (std::vector<int>{2,  3,  5,  6,  8,  9,  11, 12, 13, 17, 14, 18,
                                                           15, 19, 16, 20, 22, 23, 25, 26, 28, 29, 31, 32}));
}

// Points a direction: blank is 3 for CIHEX3 (User's Manual, PIHEX, remark 2), and CIHEX1 has its inner modes.
TEST(OldElements, PointsOfPihex) {
  std::string cubic = "CIHEX3,1,7", quadratic = "CIHEX2,2,7", linear = "CIHEX1,3,7";
  for (int g = 1; g <= 32; ++g) cubic += "," + std::to_string(g);
  for (int g = 1; g <= 20; ++g) quadratic += "," + std::to_string(g);
  for (int g = 1; g <= 8; ++g) linear += "," + std::to_string(g);
  const auto find_points = [&](const records::Deck& deck, std::size_t i) {
    for (const auto& p : deck.psolid)
      if (p.id == deck.solids.at(i).pid) return p.points;
    return -1;
  };
  const std::string all = cubic + "\n" + quadratic + "\n" + linear + "\n";
  const auto check = [&](const char* pihex, int of_cubic, int of_quadratic, int num_notes) {
    const auto r = read_old(all + pihex);
    EXPECT_EQ(find_points(r.deck, 0), of_cubic) << pihex;
    EXPECT_EQ(find_points(r.deck, 1), of_quadratic) << pihex;
    EXPECT_EQ(find_points(r.deck, 2), 0) << pihex;
    EXPECT_EQ(r.count("deck.old-points"), num_notes) << pihex;
  };
  check("PIHEX,7,1\n", 3, 0, 0);
  check("PIHEX,7,1,,2\n", 2, 2, 0);
  check("PIHEX,7,1,,3\n", 3, 3, 1);
  check("PIHEX,7,1,,4\n", 4, 3, 2);
  EXPECT_EQ(read(all + "PIHEX,7,1,,5\n").count("deck.field-range"), 1);
  const auto same = read_old(cubic + "\nPIHEX,7,1\n");
  EXPECT_NE(same.find("deck.old-element")->advice.find("old formulation"), std::string::npos);
  EXPECT_EQ(same.find("deck.old-element")->advice.find("stiffer"), std::string::npos);
}

// Outward pressure on faces by two opposite corners (User's Manual, PLOAD3): PLOAD4 of the other sign.
TEST(OldElements, Pload3) {
  const auto deck = read_old("PLOAD3,3,-15.1,15,7,25,16,117,135\n").deck;
  ASSERT_EQ(deck.load_cards.pressures.size(), 2u);
  const auto& second = deck.load_cards.pressures[1];
  EXPECT_TRUE(second.sid == 3 && second.element == 16 && second.g1 == 117 && second.g34 == 135);
  for (const double p : second.p) EXPECT_EQ(p, 15.1);
  EXPECT_GE(read("PLOAD3,3,1.\n").diagnostics.num_errors(), 1);
}

TEST(OldElements, Elbow) {
  const auto deck =
      read_old(
          "CELBOW,29,2,3,45,-1.,0.,0.,1\nPELBOW,2,1,16.,211.,211.,422.,6.\n+,5.3,0.,5.3,90.,5.3,180.,5.3,270.\n"
          "+,2.,2.,1.,1.,5.76,5.76,15.,90.\n")
          .deck;
  ASSERT_EQ(deck.special.cbend.size(), 1u);
  EXPECT_EQ(deck.special.cbend[0].geom, 1);
  const auto& p = deck.special.pbend.at(0);
  EXPECT_EQ(p.A, 16.0);
  EXPECT_NEAR(p.I1, 211 / 5.76, 1e-12);  // KELBOW divides by KZ and KY
  EXPECT_EQ(values(p.J, p.k1, p.rb, p.theta_b_deg), values(422.0, .5, 15.0, 90.0));
}

// One note a deck that is heated, and none for a zero.
TEST(RigidElements, AlphaIsNamed) {
  const std::string head = "TEMP(LOAD) = 5\nBEGIN BULK\n";
  EXPECT_EQ(
      read(head + "RBE2,9,8,12,10,12\nRBAR,5,1,2,123456\nRBAR,6,1,2,123456,,,,0.\n").count("deck.rigid-expansion"), 0);
  for (const char* card :
       {"RBE2,9,8,12,10,12,1.-5\n", "RBE2,9,8,12,10,12,1.-5,20.\n", "RBAR,5,1,2,123456,,,,1.-5\n",
        "RROD,14,1,2,2,,1.-5\n", "RBE3,15,,100,123,1.,123,1,2\n,ALPHA,1.-5\n", "RBAR1,6,1,2,123,1.-5\n",
        "RBE1,104,11,123,12,23,13,3\n+,UM,21,123,1.-5\n", "RTRPLT,7,1,2,3,1236,3,3\n,,,,1.-5\n"}) {
    const auto r = read(head + card);
    EXPECT_EQ(r.count("deck.rigid-expansion"), 1) << card;
    EXPECT_EQ(r.diagnostics.num_errors(), 0) << card << r.get_messages();
  }
  const auto both = read(head + "RBE2,9,8,12,10,12,1.-5\nRBAR,5,1,2,123456,,,,1.-5\n");
  EXPECT_EQ(both.count("deck.rigid-expansion"), 1);
  EXPECT_EQ(read("RBE2,9,8,12,10,12,1.-5\n").count("deck.rigid-expansion"), 0);
}

TEST(OldElements, RigidOnesUnderTheirOldNames) {
  const auto deck =
      read_old(
          "CRBE2,9,8,12,10,12\nCRIGD3,103,11,123,12,23,13,3\n+,MSET,21,123\nCRBE1,104,11,123,12,23,13,3\n+,UM,21,123\n"
          "CRBAR,5,1,2,123456\nCRROD,14,1,2,2\nCRBE3,15,,100,123,1.,123,1,2\nCRTRPLT,7,1,2,3,1236,3,3\n"
          "CRSPLINE,73,.05,27,28,123456,29\n")
          .deck;
  EXPECT_EQ(deck.rbe2.size(), 1u);
  ASSERT_EQ(deck.rbe1.size(), 3u);
  EXPECT_EQ(values(deck.rbe1[0].dependent.size(), deck.rbar.size(), deck.rrod.at(0).cma), values(1u, 1u, 2));
  EXPECT_EQ(values(deck.rbe3.size(), deck.special.rspline.size()), values(1u, 1u));
}

TEST(OldElements, MissingPropertiesAreNamed) {
  // A PSHELL of the same id is not the PQUAD2 that is missing.
  const auto r = read("CQUAD2,1,5,1,2,3,4\nPSHELL,5,1,.1\nCIHEX1,2,5,1,2,3,4,5,6,7,8\nPSOLID,5,1\n");
  expect_messages(r, "deck.old-property", 2, "element 1 refers to PQUAD2 5");
  EXPECT_EQ(read("PQUAD2,5,1,.1\nPQUAD2,5,1,.2\n").count("deck.duplicate-id"), 1);
}

TEST(OldElements, LaminatesOfEqualPlies) {
  const auto deck =
      read_old("PCOMP1,1,,1.7,,,9,.25,SYM\n+,-45.,45.,90.\nPCOMP2,2,-.5,,,,9,,MEM\n+,.1,0.,.2,90.,,45.\n").deck;
  ASSERT_EQ(deck.pcomp.size(), 2u);
  ASSERT_EQ(deck.pcomp[0].plies.size(), 6u);
  EXPECT_EQ(deck.pcomp[0].plies[3].theta_deg, 90.0);
  EXPECT_EQ(deck.pcomp[0].z0, -.75);
  EXPECT_TRUE(deck.pcomp[0].bending);
  ASSERT_EQ(deck.pcomp[1].plies.size(), 3u);
  EXPECT_EQ(deck.pcomp[1].plies[2].t, .2);  // of the ply before
  EXPECT_FALSE(deck.pcomp[1].bending);
}

}  // namespace
}  // namespace bough::nastran
