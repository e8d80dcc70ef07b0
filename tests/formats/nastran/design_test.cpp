/// \file Values of design variables (SOL 200), fluid, sets of component modes, names that are not read.
#include "formats/nastran/writer.hpp"
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

const std::string kDesign =
    "DESVAR,1,THICK,.25,.1,1.\nDESVAR,2,AREA,3.\nDESVAR,3,LINKED,9.\nDLINK,1,3,1.,2.,1,4.\n"  // 1 + 2 (4 .25) = 3
    "PSHELL,1,1,.1,1\nDVPREL1,1,PSHELL,1,T,,,.05,\n+,1,2.\n"                                  // .05 + 2 .25
    "PBAR,2,1,1.,1.,1.,1.\nDVPREL1,2,PBAR,2,4\n+,2,1.5,3,1.\n"                                // FID 4: A = 4.5 + 3
    "PBARL,3,1,,BAR\n+,1.,2.\nDVPREL1,3,PBARL,3,DIM2\n+,2,1.\n"
    "PCOMP,4,,,,,,,\n+,8,.1,0.,,8,.2,45.\nDVPREL1,4,PCOMP,4,13\n+,2,.1\nDVPREL1,5,PCOMP,4,THETA2\n+,2,10.\n"
    "PELAS,5,1.,,,6,2.\nDVPREL1,6,PELAS,6,K1\n+,2,100.\n"
    "MAT1,8,7.+10,,.3\nDVMREL1,7,MAT1,8,E\n+,2,1.+9\n"
    "CONM2,9,1,,5.\nDVCREL1,8,CONM2,9,M\n+,2,PVAL\n";

Read read_design(const std::string& sol, const std::string& bulk) {
  return read("SOL " + sol + "\nCEND\nBEGIN BULK\n" + bulk);
}

TEST(Design, InitialValuesOverwriteTheCards) {
  const auto r = read_design("200", kDesign);
  EXPECT_EQ(r.diagnostics.num_errors() + r.diagnostics.num_warnings(), 0) << r.get_messages();
  const auto& deck = r.deck;
  EXPECT_NEAR(deck.pshell.at(0).t.value(), .55, 1e-15);
  EXPECT_NEAR(deck.pbar.at(0).A, 7.5, 1e-14);
  EXPECT_EQ(deck.pbarl.at(0).dims[1], 3.0);
  EXPECT_NEAR(deck.pcomp.at(0).plies[0].t, .3, 1e-15);
  EXPECT_EQ(deck.pcomp[0].plies[1].t, .2);
  EXPECT_EQ(deck.pcomp[0].plies[1].theta_deg, 30.0);
  EXPECT_EQ(deck.pelas.at(0).k, 1.0);
  EXPECT_EQ(deck.pelas.at(1).k, 300.0);
  EXPECT_EQ(deck.mat1.at(0).E, 3e9);
  EXPECT_NEAR(deck.mat1[0].G, 3e9 / 2.6, 1e-3);
  EXPECT_EQ(deck.conm2.at(0).m, 15.0);
  ASSERT_EQ(r.count("deck.design-values"), 1);
  EXPECT_NE(r.find("deck.design-values")->what.find("PSHELL 1 T = .55 (was .1)"), std::string::npos)
      << r.get_messages();
}

TEST(Design, OtherSolutionsTakeTheCards) {
  const auto r = read_design("101", kDesign);
  EXPECT_EQ(r.deck.pshell.at(0).t, .1);
  EXPECT_EQ(r.deck.mat1.at(0).E, 7e10);
  ASSERT_EQ(r.count("deck.design-values"), 1);
  EXPECT_NE(r.find("deck.design-values")->what.find("SOL is 101"), std::string::npos);
}

TEST(Design, WhatIsNotDoneIsSaid) {
  const auto r =
      read_design("200",
                  "DESVAR,1,X,2.\nPSHELL,1,1,.1\nDVPREL1,1,PSHELL,1,TT\n+,1,1.\nDVPREL1,2,PSHELL,7,T\n+,1,1.\n"
                  "DVPREL2,3,PSHELL,1,T,,,5\nDVPREL1,4,PSHELL,1,T\n+,9,1.\n");
  EXPECT_EQ(r.count("deck.design-relation"), 3) << r.get_messages();
  EXPECT_EQ(r.diagnostics.num_errors(), 2);  // DESVAR 9 and DEQATN 5 are missing
  ASSERT_EQ(r.count("deck.design-equation"), 1);
  EXPECT_NE(r.find("deck.design-equation")->what.find("has no DEQATN 5"), std::string::npos);
  EXPECT_NE(r.get_messages().find("PSHELL 1 'TT' is not found"), std::string::npos);
}

TEST(Fluid, IsLeftOutWithAllThatNamesIt) {
  const auto r = read(
      "GRID,1\nGRID,2,,1.,0.,0.,-1\nGRID,3,,1.,1.,0.,-1\nMAT10,5,1.,1.\nPSOLID,5,5,,,,,PFLUID\nPSOLID,6,1\n"
      "CTETRA,7,5,2,3,4,5\nCTETRA,8,6,1,9,10,11\nSPC1,1,1,2,THRU,9\nSPC1,1,1,1,3\nASET1,1,1,2\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  EXPECT_EQ(r.deck.grids.size(), 1u);
  ASSERT_EQ(r.deck.solids.size(), 1u);
  EXPECT_EQ(r.deck.solids[0].id, 8);
  EXPECT_EQ(r.deck.psolid.size(), 1u);
  ASSERT_EQ(r.deck.spc.size(), 1u);
  EXPECT_EQ(r.deck.spc[0].g, 1);
  EXPECT_EQ(r.deck.aset.size(), 1u);
  ASSERT_EQ(r.count("deck.fluid"), 1);
  EXPECT_NE(r.find("deck.fluid")->what.find("2 fluid GRID, 1 fluid PSOLID, 1 fluid solids"), std::string::npos);
  Diagnostics diagnostics;
  write_deck(r.deck, {}, diagnostics);
  ASSERT_TRUE(diagnostics.has("deck.left-out"));
  EXPECT_NE(diagnostics.items()[0].what.find("2 fluid GRID"), std::string::npos);
}

TEST(ComponentModes, QsetGoesWithTheDeck) {
  const auto r = read("GRID,1\nSPOINT,51,THRU,53\nASET,1,123\nQSET1,0,51,THRU,53\nQSET1,0,901,THRU,950\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  ASSERT_EQ(r.deck.qset.size(), 3u);
  Diagnostics diagnostics;
  const auto text = write_deck(r.deck, {}, diagnostics);
  EXPECT_FALSE(diagnostics.has("deck.left-out"));
  EXPECT_EQ(read(text).deck.qset.size(), 3u) << text;
}

TEST(UnreadNames, AreKnownAndCounted) {
  for (const char* name : {"TABLEM5", "PLOTOPT", "GRIDG", "RANDVAR", "BFRIC", "MAT1F", "YLDJC", "EOSGAM", "FBODYLD",
                           "ROTOR", "MONCARL", "HDF5OUT", "BCMOVE", "TABLED6", "MATTPZ1"}) {
    const auto r = read(std::string(name) + ",1,2.\n" + name + ",2,x,3.,4.,5.,6.,7.,8.,9\n");
    EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
    ASSERT_EQ(r.count("deck.unused-card"), 1) << name;
    EXPECT_NE(r.find("deck.unused-card")->what.find("is not read (2 cards"), std::string::npos) << r.get_messages();
  }
}

TEST(UnreadNames, WrongContentOfATableRefusesNoDeck) {
  const auto r = read("TABLED1,1\n+,0.,1.,x,y,ENDT,5,6,7,8,9\n+,,,,,,,,,77\nTABLEM1,2,LINEAR,BAD\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
}

}  // namespace
}  // namespace bough::nastran
