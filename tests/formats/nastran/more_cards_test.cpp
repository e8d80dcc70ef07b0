/// \file Quadratic shells, shear panels, dampers, RBE1, direct matrices, sets of degrees of freedom: fields and errors.
#include <cmath>

#include "formats/nastran/writer.hpp"
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

TEST(QuadraticShells, FieldsInTheirPlaces) {
  const auto shells = read_list(&records::Deck::shells, 4,
                                "CQUAD8,1,7,11,12,13,14,15,16\n,17,18,.1,.2,.3,.4,30.,.05\n,1\n"
                                "CQUAD8,2,7,11,12,13,14,,16\n,,,,,,,5\n"
                                "CTRIA6,3,7,11,12,13,14,15,16\n,-10.,.05,.1,.2,.3,1\n"
                                "CTRIA6,4,,11,12,13\n");
  const auto& quad = shells[0];
  EXPECT_EQ(values(quad.card, quad.grids, quad.midsides, quad.t, quad.theta_deg, quad.z_offset),
            values("CQUAD8", (std::vector<int>{11, 12, 13, 14}), (std::vector<int>{15, 16, 17, 18}),
                   (std::vector<double>{.1, .2, .3, .4}), 30, .05));
  EXPECT_TRUE(quad.relative_thickness);
  EXPECT_EQ(shells[1].midsides, (std::vector<int>{0, 16, 0, 0}));
  EXPECT_EQ(shells[1].mcid, 5);
  EXPECT_TRUE(shells[1].t.empty());
  const auto& triangle = shells[2];
  EXPECT_EQ(values(triangle.grids, triangle.midsides, triangle.theta_deg, triangle.z_offset, triangle.t),
            values((std::vector<int>{11, 12, 13}), (std::vector<int>{14, 15, 16}), -10, .05,
                   (std::vector<double>{.1, .2, .3})));
  EXPECT_TRUE(triangle.relative_thickness);
  EXPECT_EQ(shells[3].pid, 4);
  EXPECT_TRUE(shells[3].midsides.empty());
}

TEST(ShellCards, ABlankCornerIsTheProperty) {
  const auto d = read_clean("CQUAD4,1,7,11,12,13,14\n,,,.1,,.3\n");
  ASSERT_EQ(d.shells.size(), 1u);
  ASSERT_EQ(d.shells[0].t.size(), 4u);
  EXPECT_EQ(d.shells[0].t[0], .1);
  EXPECT_TRUE(std::isnan(d.shells[0].t[1]));
  EXPECT_EQ(d.shells[0].t[2], .3);
  EXPECT_TRUE(std::isnan(d.shells[0].t[3]));
  Diagnostics diagnostics;
  EXPECT_TRUE(std::isnan(read_clean(write_deck(d, {}, diagnostics)).shells.at(0).t.at(1)));
}

TEST(MoreElements, DampersShearPanelsLines) {
  const auto d = read_clean(
      "CQUADR,1,7,11,12,13,14,30.\nCTRIAR,2,7,11,12,13,5,.1\nCSHEAR,3,8,1,2,3,4\nPSHEAR,8,1,.5,.1,.2,.3\n"
      "CBUSH1D,4,9,1,2\nCBUSH1D,5,9,1,,6\nPBUSH1D,9,10.,11.,12.\n"
      "CDAMP1,1,3,1,2,3,4\nCDAMP2,2,5.5,,,3,4\nCDAMP3,3,3,61\nCDAMP4,4,6.5,61,62\nPDAMP,3,1.,4,2.,,,6,3.\n"
      "CVISC,1,2,3,4\nPVISC,2,1.,2.,,3,4.\nPLOTEL,1,2,3,,2,3,4\n");
  EXPECT_EQ(values(d.shells[0].card, d.shells[0].theta_deg, d.shells[1].card), values("CQUADR", 30, "CTRIAR"));
  EXPECT_EQ(values(d.shells[1].mcid, d.shear_panels[0].grids, d.pshear[0].f2),
            values(5, (std::array<int, 4>{1, 2, 3, 4}), .3));
  EXPECT_EQ(d.cbush1d[0].gb, 2);
  EXPECT_FALSE(d.cbush1d[0].cid);
  EXPECT_EQ(values(d.cbush1d[1].cid, d.pbush1d[0].k, d.pbush1d[0].c), values(6, 10, 11));
  EXPECT_EQ(d.pbush1d[0].m, 12);
  ASSERT_EQ(d.dampers.size(), 4u);
  EXPECT_EQ(values(d.dampers[0].pid, d.dampers[0].c2, d.dampers[1].b), values(3, 4, 5.5));
  EXPECT_EQ(values(d.dampers[1].g1, d.dampers[2].g1), values(0, 61));
  EXPECT_TRUE(d.dampers[3].by_scalar_points);
  EXPECT_EQ(d.scalar_points.size(), 3u);
  ASSERT_EQ(d.pdamp.size(), 3u);
  EXPECT_EQ(values(d.pdamp[2].id, d.pvisc[1].ce, d.pvisc[1].cr), values(6, 4, 0));
  EXPECT_EQ(d.plotel[1].gb, 4);
}

TEST(MoreElements, Rbe1) {
  const auto rbe1 = read_list(&records::Deck::rbe1, 2,
                              "RBE1,1,11,123,12,23,13,3\n,UM,14,123456,15,4,16,5\n,,17,6,1.-6\n"
                              "RBE1,2,11,1,12,2,13,3\n,,14,4,15,5,16,6\n,UM,17,123\n");
  const auto& e = rbe1[0];
  ASSERT_EQ(e.independent.size(), 3u);
  EXPECT_EQ(e.independent[1].g, 12);
  EXPECT_EQ(e.independent[1].c, 0b110u);
  ASSERT_EQ(e.dependent.size(), 4u);
  EXPECT_EQ(values(e.dependent[0].c, e.dependent[3].g, e.dependent[3].c), values(63u, 17, 32u));
  EXPECT_EQ(rbe1[1].independent.size(), 6u);
}

TEST(DofSets, PairsListsAndRanges) {
  const auto d = read_clean(
      "GRID,1\nGRID,2\nGRID,5\nSPOINT,9\nSUPORT,1,123,2,23,5,3\nSUPORT1,4,9,0,1,123456\nSUPORT1,4,2,1\n"
      "ASET,1,12,9\nASET1,3,2,5\nASET1,456,1,THRU,8\nOMIT,1,3\nOMIT1,4,2,THRU,9\n");
  ASSERT_EQ(d.suport.size(), 3u);
  EXPECT_EQ(d.suport[2].c, 4u);
  ASSERT_EQ(d.suport1.at(4).size(), 3u);
  EXPECT_EQ(d.suport1.at(4)[0].c, 0u);
  ASSERT_EQ(d.aset.size(), 7u);  // 1 and 9; 2 and 5; 1, 2, 5
  EXPECT_EQ(values(d.aset[1].g, d.aset[6].g, d.aset[6].c), values(9, 5, 0b111000u));
  ASSERT_EQ(d.omit.size(), 4u);  // 1; 2, 5, 9
}

TEST(DirectMatrices, TermsOfTheirForms) {
  const auto matrices =
      read_list(&records::Deck::direct_matrices, 2,
                "DMIG,K1,1,1,,2,3,4.5,9.,\n,3,0,5.5\n"  // before its header; the imaginary part means nothing
                "DMIG,K1,0,6,1,0\nDMIG*   C1                             0               1               4\n"
                "*                                      1\n"
                "DMIG*   C1                             1               2\n"
                "*                      3               4   2.00000000D+0          60.0D0\n");
  const auto& k = matrices[0];
  EXPECT_EQ(k.form, 6);
  EXPECT_FALSE(k.is_complex);
  ASSERT_EQ(k.entries.size(), 2u);
  EXPECT_EQ(values(k.entries[0].gj, k.entries[0].cj, k.entries[0].gi, k.entries[0].ci, k.entries[0].value,
                   k.entries[0].imaginary),
            values(1, 1, 2, 3, 4.5, 0));
  EXPECT_EQ(k.entries[1].ci, 0);
  const auto& c = matrices[1];
  EXPECT_TRUE(c.is_complex);
  EXPECT_NEAR(c.entries.at(0).value, 1, 1e-15);
  EXPECT_NEAR(c.entries.at(0).imaginary, std::sqrt(3.0), 1e-15);
}

TEST(DirectMatrices, Selected) {
  const auto d = read_clean(
      "CEND\nSET 5 = 2.*K1,\n  .5*K2\nK2GG = 5\nM2GG = M1, M2 M3\nB2GG = 1.25*B1, -1.0*B2,\n 0.82*B3\nSUPORT1 = 7\n"
      "SUBCASE 1\nSUBCASE 2\nBEGIN BULK\n");
  using List = std::vector<std::pair<double, std::string>>;
  for (const auto& s : d.subcases) {
    EXPECT_EQ(values(s.k2gg, s.m2gg, s.b2gg, s.suport1),
              values((List{{2, "K1"}, {.5, "K2"}}), (List{{1, "M1"}, {1, "M2"}, {1, "M3"}}),
                     (List{{1.25, "B1"}, {-1, "B2"}, {.82, "B3"}}), 7));
  }
  // Nastran takes those of the first subcase for all.
  const auto later = read("CEND\nSUBCASE 1\nK2GG = K1\nSUBCASE 2\nK2GG = K2\nBEGIN BULK\n");
  EXPECT_EQ(values(later.count("deck.case-control-later"), later.deck.subcases[1].k2gg,
                   read("CEND\nK2GG = 2..*K\nBEGIN BULK\n").count("deck.case-control-value")),
            values(1, (List{{1, "K1"}}), 1));
  EXPECT_EQ(values(read("CEND\nK2GG =\nBEGIN BULK\n").count("deck.case-control-value"),
                   read("CEND\nK2GG = 6\nBEGIN BULK\n").count("deck.case-control-value")),
            values(1, 1));
}

TEST(MoreCards, WhatIsWrong) {
  struct Fault {
    const char* text;
    const char* id;
    int number;  ///< of errors with this id; there is no other error
  };
  const Fault faults[] = {
      {"CQUAD8,1,1,1,2,3\n", "deck.missing-field", 1},
      {"CQUAD8,1,1,1,2,3,4\n,,,,,,,,\n,2\n", "deck.field-range", 1},
      {"CQUADR,1,1,1,2,3,4\nCSHEAR,1,1,1,2,3,4\n", "deck.duplicate-id", 1},
      {"PSHEAR,1,1\n", "deck.missing-field", 1},
      {"PSHEAR,1,1,.1,,-1.\n", "deck.field-range", 1},
      {"PSHEAR,1,1,0.\n", "deck.field-range", 1},
      {"CDAMP2,1,2.\n", "deck.missing-field", 1},
      {"CDAMP2,1,2.,1,7\n", "deck.bad-components", 1},
      {"CDAMP4,1,2.\n", "deck.missing-field", 1},
      {"CDAMP2,1,2.,1\nCDAMP4,1,2.,1\n", "deck.duplicate-id", 1},
      {"PDAMP,1,2.,1,3.\n", "deck.duplicate-id", 1},
      {"CVISC,1,1,1\n", "deck.missing-field", 1},
      {"PVISC,1,x\n", "deck.bad-real", 1},
      {"CBUSH1D,1,1,1\n", "deck.missing-field", 1},
      {"PBUSH1D,1,1.\n,SPRING,TABLE,5\n", "none", 0},
      {"PBUSH1D,1,1.\n,SPRONG,TABLE,5\n", "deck.bad-word", 1},
      {"PLOTEL,1,1\n", "deck.missing-field", 1},
      {"RBE1,1,1,12345\n,UM,2,123\n", "deck.field-range", 1},
      {"RBE1,1,1,123456\n", "deck.missing-field", 1},
      {"RBE1,1,1,123456\n,UM,2,129\n", "deck.bad-components", 1},
      {"SUPORT\n", "deck.missing-field", 1},
      {"SUPORT,1,7\n", "deck.bad-components", 1},
      {"SUPORT1,,1,1\n", "deck.missing-field", 1},
      {"SUPORT1,1,1,1,2,2,3,3,4\n", "deck.too-many-fields", 1},
      {"ASET1,123\n", "deck.missing-field", 1},
      {"GRID,1\nASET1,123,2,THRU,5\n", "deck.bad-list", 1},
      {"OMIT,1.\n", "deck.bad-integer", 1},
      {"DMIG\n", "deck.missing-field", 1},
      {"DMIG,1K,0,6,1\n", "deck.bad-word", 1},
      {"DMIG,K,0,3,1\n", "deck.field-range", 1},
      {"DMIG,K,0,6,1\nDMIG,K,0,6,1\n", "deck.duplicate-id", 1},
      {"DMIG,K,1,1,,1,1,2.\n", "deck.missing-header", 1},
      {"DMIG,K,0,6,1\nDMIG,K,1,1\n", "deck.missing-field", 1},
      {"DMIG,K,0,6,1\nDMIG,K,1,1,,2,1,2.\nDMIG,K,2,1,,1,1,2.\n", "deck.duplicate-term", 1},
      {"DMIG,K,0,1,1\nDMIG,K,1,1,,2,1,2.\nDMIG,K,2,1,,1,1,2.\n", "none", 0},
      {"DMIG,K,0,1,1\nDMIG,K,1,1,,2,1,2.\n,2,1,3.\n", "deck.duplicate-term", 1},
  };
  for (const auto& fault : faults) {
    const auto r = read(fault.text);
    EXPECT_EQ(values(r.diagnostics.num_errors(), r.count(fault.id)), values(fault.number, fault.number))
        << fault.text << r.get_messages();
  }
  EXPECT_EQ(read("PBUSH1D,1,1.\n,SPRING,TABLE,5\n,DAMPER,EQUAT,6\n").count("deck.nonlinear-part"), 2);
}

TEST(OldDecks, BlanksInsideNumbers) {
  const auto r = read(
      "MAT1    1       10.4  +64.   +6                                                 \n"
      "SPC1    1       12 456  1041\n"
      "GRID    1041\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  EXPECT_EQ(r.count("deck.blank-inside"), 3);
  ASSERT_EQ(r.deck.mat1.size(), 1u);
  EXPECT_EQ(r.deck.mat1[0].E, 10.4e6);
  EXPECT_EQ(r.deck.mat1[0].G, 4.0e6);
  ASSERT_EQ(r.deck.spc.size(), 1u);
  EXPECT_EQ(r.deck.spc[0].c, 0b111011u);
  // Two numbers in one field are two numbers, and columns that are off.
  EXPECT_EQ(read("GRID    1               1.0 2.0\n").count("deck.bad-real"), 1);
}

TEST(OldDecks, HintsAndSwitchesAreNoErrors) {
  const auto r = read("GRID,1\nDEBUG   192     2\nPARVEC  A       13      3\nCNGRNT  1       2       THRU    40\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  EXPECT_EQ(read("CUSERIN,1,2,3\n").count("deck.unsupported-card"), 1);
}

TEST(OldDecks, RigidElements) {
  const auto deck =
      read_clean("GRID,1\nGRID,2\nGRID,3\nGRID,4\nCRIGD1,7,1,2,THRU,4\nCRIGD2,8,1,2,123,3,46\nCRIGDR,9,1,4,2\n");
  ASSERT_EQ(deck.rbe2.size(), 1u);
  EXPECT_EQ(values(deck.rbe2[0].gn, deck.rbe2[0].cm, deck.rbe2[0].gm), values(1, 63u, (std::vector<int>{2, 3, 4})));
  ASSERT_EQ(deck.rbe1.size(), 1u);
  EXPECT_EQ(deck.rbe1[0].independent[0].g, 1);
  EXPECT_EQ(deck.rbe1[0].independent[0].c, 63u);
  ASSERT_EQ(deck.rbe1[0].dependent.size(), 2u);
  EXPECT_EQ(deck.rbe1[0].dependent[1].c, 0b101000u);
  ASSERT_EQ(deck.rrod.size(), 1u);
  EXPECT_EQ(values(deck.rrod[0].gb, deck.rrod[0].cmb, read("CRIGD1,7,1\n").count("deck.missing-field")),
            values(4, 2, 1));
  EXPECT_EQ(
      values(read("CRIGD2,7,1\n").count("deck.missing-field"), read("CRIGDR,7,1,2,4\n").count("deck.field-range")),
      values(1, 1));
}

TEST(OldDecks, TableOfBucklingRoots) {
  const auto deck = read_clean(
      "EIGB    300     UDET    .10     2.5     4       4       0       1.5E-05 +EIGB300\n+EIGB300MAX\n"
      "EIGB,301,INV,,,2\n");
  ASSERT_EQ(deck.eigen_methods.size(), 2u);
  EXPECT_EQ(values(deck.eigen_methods[0].sid, deck.eigen_methods[0].f1, deck.eigen_methods[0].f2,
                   deck.eigen_methods[0].num_modes),
            values(300, 0.1, 2.5, 4));
  EXPECT_EQ(deck.eigen_methods[1].num_modes, 6);
}

}  // namespace
}  // namespace bough::nastran
