/// Cards and writing of decks from MSC and NX Nastran.
#include <filesystem>

#include "deck_text.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::nastran {
namespace {

namespace fs = std::filesystem;

TEST(MscCards, WhatBelongsToOtherAnalysesIsAWarningThatSaysWhatIsLost) {
  const auto r = read("GRID,1\nEPOINT,9,10\nCBARAO,1,FR,2,.1\nSESET,1,1,THRU,5\nSPCOFF,1,3\nRVDOF,1,3\nBNDFIX,1,3\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  ASSERT_EQ(r.count("deck.unused-card"), 6) << r.get_messages();
  EXPECT_NE(r.diagnostics.items()[0].advice.find("extra points"), std::string::npos);
  EXPECT_NE(r.diagnostics.items()[2].advice.find("superelements are not formed"), std::string::npos);
  EXPECT_NE(r.diagnostics.items()[3].advice.find("AUTOSPC"), std::string::npos);
  // Names a preprocessor leaves for itself.
  const auto names = read("ABSNMVS 1\n+       ABSNAME Constraint 1\nABSTRCT BCEVENT 1       SPC     1\n");
  EXPECT_EQ(names.diagnostics.num_errors(), 0) << names.get_messages();
  ASSERT_EQ(names.count("deck.unused-card"), 2) << names.get_messages();
  EXPECT_NE(names.get_messages().find("carries nothing"), std::string::npos);
  // Rotors and manufacturing limits of NX; bolts in sequence load the model.
  const auto nx = read("ROTORD,99,0.,200.,118,FIX\nDMRLAW,1,LINEAR\nBOLTFRC,1,2,3.\nBCTPARM,1,NCONT,3\n");
  EXPECT_EQ(nx.diagnostics.num_errors(), 0) << nx.get_messages();
  EXPECT_EQ(nx.count("deck.unused-card"), 4) << nx.get_messages();
  // Superelements that move or copy grids change the model.
  EXPECT_EQ(read("SELOC,1,1,2,3\nSEMPLN,1,PLANE,1,2,3\nCSUPER,1,2,3\n").diagnostics.num_errors(), 2);
}

TEST(MscCards, Mat11IsTheMat9OfItsLaw) {
  const auto deck = read_clean("MAT11,3,10.,20.,30.,.1,.2,.3,4.,+\n+,5.,6.,.7\n");
  ASSERT_EQ(deck.mat9.size(), 1u);
  const auto& G = deck.mat9[0].G;
  // Stretched along 1 alone in stress: strains 1/E1, -nu12/E1, -nu13/E1.
  Eigen::Matrix<double, 6, 1> strain;
  strain << 1 / 10., -.1 / 10, -.2 / 10, 0, 0, 0;
  Eigen::Matrix<double, 6, 1> stress = G * strain;
  EXPECT_LT((stress - Eigen::Matrix<double, 6, 1>::Unit(0)).norm(), 1e-14);
  strain << -.1 / 10, 1 / 20., -.3 / 20, 0, 0, 0;
  stress = G * strain;
  EXPECT_LT((stress - Eigen::Matrix<double, 6, 1>::Unit(1)).norm(), 1e-14);
  // Shear xy, yz, zx: G12, G23, G13.
  EXPECT_EQ(values(G(3, 3), G(4, 4), G(5, 5)), values(4, 6, 5));
  EXPECT_EQ(values(deck.mat9[0].rho, read("MAT11,3,10.,20.,30.,9.,.2,.3,4.,+\n+,5.,6.\n").count("deck.field-range")),
            values(.7, 1));
}

TEST(MscCards, RigidElementsMayEndWithAlphaAndTref) {
  const auto deck = read_clean(
      "RBE2,1,5,123,6,7,1.-5,20.\nRBE2,2,5,123,6,7,1.-5\nRBE2,3,5,123,6\nRBE1,4,5,123456,,,,,,+\n+,UM,6,123,1.-5,20.\n"
      "RBAR,8,1,2,123456,,,,1.-5,+\n+,20.\n");
  ASSERT_EQ(deck.rbe2.size(), 3u);
  EXPECT_EQ(deck.rbe2[0].gm, (std::vector<int>{6, 7}));
  EXPECT_EQ(deck.rbe2[1].gm, (std::vector<int>{6, 7}));
  ASSERT_EQ(deck.rbe1.size(), 1u);
  EXPECT_EQ(deck.rbe1[0].dependent.size(), 1u);
}

/// IN and ISOP by word and by number (Quick Reference Guide, PSOLID).
TEST(MscCards, PsolidSchemes) {
  const auto deck =
      read_clean("PSOLID,1,9,,THREE,GRID,FULL\nPSOLID,2,9,,2,,1\nPSOLID,3,9,,BUBBLE,,REDUCED\nPSOLID,4,9\n");
  ASSERT_EQ(deck.psolid.size(), 4u);
  EXPECT_EQ(deck.psolid[0].points, 3);
  EXPECT_TRUE(deck.psolid[0].is_full);
  EXPECT_EQ(deck.psolid[1].points, 2);
  EXPECT_TRUE(deck.psolid[1].is_full);
  EXPECT_EQ(deck.psolid[2].points, 0);
  EXPECT_TRUE(deck.psolid[2].is_reduced && !deck.psolid[2].is_full);
  EXPECT_TRUE(deck.psolid[3].points == 0 && !deck.psolid[3].is_full && !deck.psolid[3].is_reduced);
  const auto odd = read("PSOLID,1,9,,FOUR\n");
  EXPECT_EQ(odd.diagnostics.num_errors(), 0);
  EXPECT_EQ(odd.count("deck.solid-scheme"), 1);
}

/// CNA blank is 123456; fewer than six on one grid are the model's to complete.
TEST(MscCards, RbarWithoutSixComponents) {
  const auto deck = read_clean("RBAR,1,1,2\nRBAR,2,1,2,123\nRBAR,3,1,2,,123\n");
  ASSERT_EQ(deck.rbar.size(), 3u);
  EXPECT_EQ(values(deck.rbar[0].cna, deck.rbar[0].cmb, deck.rbar[1].cna), values(63u, 63u, 7u));
  EXPECT_EQ(values(deck.rbar[1].cmb, deck.rbar[2].cnb), values(0u, 7u));
}

TEST(MscCards, PcompsOfOneMaterialIsThePsolid) {
  const auto deck = read_clean("PCOMPS,2,5,13,,,20.,,,+\n+,1,7,5.,0.,,YES,ABS,,+\n+,2,7,4.\n");
  ASSERT_EQ(deck.psolid.size(), 1u);
  EXPECT_EQ(values(deck.psolid[0].id, deck.psolid[0].mid, deck.psolid[0].cordm), values(2, 7, 5));
  EXPECT_EQ(values(read("PCOMPS,2,5,13,,,,,,+\n+,1,7,5.,0.,,,,,+\n+,2,8,4.\n").count("deck.field-range"),
                   read("PCOMPS,2,5,13,,,,,,+\n+,1,7,5.,45.\n").count("deck.field-range")),
            values(1, 1));
}

class Moved : public testing::Test {
 protected:
  test::TempFolder temp;  // one a test: they run side by side
  fs::path folder = temp.get_path();
  void write(const std::string& name, const std::string& text) { temp.write(name, text); }
};

TEST_F(Moved, IncludesOfAnotherMachineAreFoundWithAWarning) {
  write("a.bdf", "GRID,1\n");
  write("sub/b.bdf", "GRID,2\n");
  write("Case.BDF", "GRID,3\n");
  write("main.bdf",
        "INCLUDE 'OUTDIR:a.bdf'\nINCLUDE 'C:\\work\\b.bdf'\nINCLUDE 'HERE:sub/b.bdf'\nINCLUDE 'CASE.bdf'\n");
  Read r;
  r.deck = read_deck((folder / "main.bdf").string(), {}, r.diagnostics);
  EXPECT_EQ(r.count("deck.include-moved"), 3) << r.get_messages();
  EXPECT_EQ(r.count("deck.include-missing"), 1) << r.get_messages();
  EXPECT_EQ(r.deck.grids.size(), 3u);
}

TEST_F(Moved, DmapThatIsMissingDoesNotStopTheDeck) {
  write("main.bdf", "SOL 101\nINCLUDE 'alter.v70'\nCEND\nBEGIN BULK\nGRID,1\nINCLUDE 'x.bdf'\nENDDATA\n");
  Read r;
  r.deck = read_deck((folder / "main.bdf").string(), {}, r.diagnostics);
  ASSERT_EQ(r.count("deck.include-missing"), 2) << r.get_messages();
  EXPECT_EQ(r.diagnostics.num_errors(), 1) << r.get_messages();
  EXPECT_EQ(r.deck.sol, "101");
}

}  // namespace
}  // namespace bough::nastran
