/// \file Errors of decks: which error, where, and that all are reported.
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

/// The text must give exactly one error, with this id on this line.
void expect_error(const std::string& id, int line, std::string_view text) {
  const auto r = read(text);
  EXPECT_EQ(r.diagnostics.num_errors(), 1) << text << r.get_messages();
  const auto* d = r.find(id);
  ASSERT_NE(d, nullptr) << text << r.get_messages();
  EXPECT_EQ(d->where.file, "deck.bdf");
  EXPECT_EQ(d->where.line, line) << text;
}

TEST(Errors, FieldsOfTheWrongType) {
  expect_error("deck.bad-integer", 2, "$\nGRID,1.0\n");
  expect_error("deck.bad-integer", 1, "CBAR,1,1,2.,3,0.,1.,0.\n");
  expect_error("deck.bad-real", 1, "GRID,1,,abc\n");
  expect_error("deck.bad-real", 2, "CORD2R,1,,0.,0.,0.,0.,0.,1.\n,1.,0.,x\n");
  expect_error("deck.bad-components", 1, "GRID,1,,,,,,7\n");
  expect_error("deck.bad-components", 1, "CELAS2,1,1.,1,12\n");
  expect_error("deck.bad-word", 1, "CBAR,1,1,1,2,0.,1.,0.,GXG\n");
  expect_error("deck.bad-word", 1, "PBUSH,1,KK,1.\n");
  expect_error("deck.bad-word", 1, "EIGRL,1,,,5,,,,MASSS\n");
  expect_error("deck.bad-word", 1, "PBARL,1,1,USER,ROD\n,1.\n");
  expect_error("deck.bad-keyword", 2, "EIGRL,1,,,5\n,NORN=MAX\n");
  expect_error("deck.bad-keyword", 2, "EIGRL,1,,,5\n,V2=x\n");
  expect_error("deck.unknown-shape", 1, "PBARL,1,1,,ROOD\n,1.\n");
}

TEST(Errors, MissingFields) {
  for (const char* text :
       {"GRID\n", "MAT1,1\n", "FORCE,1\n", "LOAD,1,1.\n", "SPC1,1,123\n", "RBE2,1,2,123\n", "CELAS2,1,5.\n",
        "CBAR,1,1,1,2\n", "MPC,1\n", "PARAM\n", "SPCADD,1\n", "PBUSH,1,,3.\n", "CONM2,1\n", "PBEAM,1,1\n"})
    expect_error("deck.missing-field", 1, text);
  expect_error("deck.missing-field", 2, "PBARL,1,1,,BAR\n,1.\n");
  expect_error("deck.missing-field", 2, "EIGR,1,LAN\n,POINT\n");
}

TEST(Errors, FieldsOutOfRange) {
  for (const char* text : {"GRID,0\n", "GRID,1,-3\n", "MAT1,1,-2.,,.3\n", "PROD,1,1,-1.\n", "PTUBE,1,1,1.,.6\n",
                           "PBEAM,1,1,0.\n", "CBAR,1,1,1,2,0.,0.,0.\n", "FORCE,1,1,,2.,0.,0.,0.\n", "LOAD,1,1.,1.,1\n",
                           "RBAR,1,1,2,123,45\n", "EIGRL,1,5.,2.\n", "SPCADD,1,1\n"})
    expect_error("deck.field-range", 1, text);
  for (const char* text : {"PBEAM,1,1,1.,1.,1.\n,YES,1.5\n", "PBEAM,1,1,1.,1.,1.\n,NO,.5\n,NO,.5\n",
                           "CBAR,1,1,1,2,0.,1.,0.\n,123456\n", "CBUSH,1,1,1,2\n,1.5\n"})
    expect_error("deck.field-range", 2, text);
  expect_error("deck.field-range", 3, "PBAR,1,1,1.,1.,1.\n,\n,,,2.\n");
  expect_error("deck.too-many-fields", 2, "PBARL,1,1,,BAR\n,1.,2.,3.,4.\n");
}

TEST(Errors, AllAreReportedNotTheFirst) {
  const auto r = read("GRID,x\nGRID,1,,a,b,c\nCBAR,1,1\nFOO,1\n");
  EXPECT_EQ(r.count("deck.bad-integer"), 1);
  EXPECT_EQ(r.count("deck.bad-real"), 3);
  EXPECT_EQ(r.count("deck.missing-field"), 2);
  EXPECT_EQ(r.count("deck.unknown-card"), 1);
  EXPECT_EQ(r.diagnostics.num_errors(), 7) << r.get_messages();
}

TEST(Errors, DuplicateIds) {
  const auto r = read("GRID,1,,1.\nGRID,2,,1.\nGRID,1,,2.\n");
  ASSERT_EQ(r.diagnostics.num_errors(), 1);
  const auto* d = r.find("deck.duplicate-id");
  ASSERT_NE(d, nullptr);
  EXPECT_EQ(d->where.line, 3);
  EXPECT_NE(d->what.find("deck.bdf:1"), std::string::npos);
  EXPECT_EQ(r.deck.grids.size(), 2u);
  expect_error("deck.duplicate-id", 2, "CBAR,5,1,1,2,0.,1.,0.\nCBEAM,5,1,1,2,0.,1.,0.\n");
  expect_error("deck.duplicate-id", 2, "PBAR,5,1,1.\nPBARL,5,1,,ROD\n,1.\n");
  expect_error("deck.duplicate-id", 1, "PELAS,1,2.,,,1,3.\n");
  expect_error("deck.duplicate-id", 2, "GRDSET,,1\nGRDSET,,2\n");
  expect_error("deck.duplicate-id", 2, "GRID,1\n=,*0,=,*1.,==\n");
}

TEST(Errors, IdenticalCardsAreAWarning) {
  const auto r =
      read("GRID,1,,1.\nGRID    3\nGRID    1               1.00\nGRID,2\nMAT1,1,2.,,.3\nmat1,1,2.,,.3\nGRID,2\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  EXPECT_EQ(r.count("deck.repeated-card"), 3);
  EXPECT_EQ(r.deck.grids.size(), 3u);
  EXPECT_EQ(r.deck.mat1.size(), 1u);
  EXPECT_EQ(r.deck.card_counts.at("GRID"), 5);
}

TEST(Errors, ContradictionsThatAreWarnings) {
  const auto r = read("MAT1,1,2.,3.,.3\nPARAM,POST,-1\nPARAM,POST,0\nPARAM,POST,0\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0);
  EXPECT_EQ(r.count("deck.inconsistent-material"), 1);
  EXPECT_EQ(r.count("deck.repeated-param"), 1);
  EXPECT_EQ(r.deck.find_param("POST")->value, "0");
}

TEST(UnusedCards, WhatCarriesStiffnessMassConstraintIsAnError) {
  const char* text = "GRID,1\nCQUADX,1,1,1,2,3,4\nCQUADX,2,1,1,2,3,4\nCONM3,1\nRSSCON,1\nCBUSH2D,9\n";
  const auto r = read(text);
  EXPECT_EQ(r.count("deck.unsupported-card"), 4) << r.get_messages();
  EXPECT_EQ(r.find("deck.unsupported-card")->where.line, 2);
  ASSERT_EQ(r.deck.unused.size(), 4u);
  EXPECT_EQ(r.deck.unused[0].name, "CQUADX");
  EXPECT_EQ(r.deck.unused[0].count, 2);
  EXPECT_EQ(r.deck.unused[0].first.line, 2);
  EXPECT_EQ(r.deck.unused[0].effect, records::CardEffect::Stiffness);
  EXPECT_EQ(r.deck.unused[1].effect, records::CardEffect::Mass);
  EXPECT_EQ(r.deck.unused[2].effect, records::CardEffect::Constraint);
  EXPECT_EQ(r.deck.unused[3].effect, records::CardEffect::Stiffness);
  const auto ignored = read(text, {{"cquadx", "CONM3", "RSSCON", "CBUSH2D"}});
  EXPECT_EQ(ignored.diagnostics.num_errors(), 0) << ignored.get_messages();
  EXPECT_EQ(ignored.count("deck.ignored-card"), 4);
  EXPECT_EQ(ignored.deck.unused.size(), 4u);
}

TEST(UnusedCards, WhatCarriesALoadOrNothingIsAWarning) {
  const auto r = read("PLOADX1,1,2,3.\nPLOADX1,1,3,3.\nMAT10,1,2.,3.\nAERO,,1.\nCDAMP5,1,3,2\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  EXPECT_EQ(r.count("deck.unused-card"), 4);
  ASSERT_EQ(r.deck.unused.size(), 4u);
  EXPECT_EQ(r.deck.unused[0].effect, records::CardEffect::Load);
  EXPECT_EQ(r.deck.unused[1].effect, records::CardEffect::None);
  EXPECT_EQ(r.deck.unused[3].effect, records::CardEffect::Damping);
}

TEST(UnusedCards, SetsOfComponentModesSayWhatIsLost) {
  const auto r = read("BSET,1,123\nBSET1,123,2\nCSET1,123,3\nQSET,51,0\nUSET1,U1,123,4\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  ASSERT_EQ(r.count("deck.unused-card"), 5);
  EXPECT_NE(r.diagnostics.items()[1].advice.find("hold in component modes"), std::string::npos);
  EXPECT_NE(r.diagnostics.items()[3].advice.find("amplitudes of component modes"), std::string::npos);
  EXPECT_NE(r.diagnostics.items()[4].advice.find("the set that it names"), std::string::npos);
}

TEST(UnusedCards, CardsThatAreReadCanBeIgnoredToo) {
  const auto r = read("CONM2,1,2,,3.\nGRID,2\n", {{"CONM2"}});
  EXPECT_EQ(r.diagnostics.num_errors(), 0);
  EXPECT_EQ(r.deck.conm2.size(), 0u);
  EXPECT_EQ(r.deck.unused[0].effect, records::CardEffect::Mass);
}

TEST(UnusedCards, UnknownNames) {
  const auto r = read("CBARR,1\nCBARR,2\n");
  ASSERT_EQ(r.count("deck.unknown-card"), 1);
  EXPECT_NE(r.find("deck.unknown-card")->advice.find("did you mean CBAR;"), std::string::npos);
  EXPECT_EQ(read("CBARR,1\n", {{"CBARR"}}).diagnostics.num_errors(), 0);
}

TEST(UnusedCards, LinesThatAreNoCards) {
  expect_error("deck.unreadable-line", 2, "GRID,1\n1234\n");
  expect_error("deck.unreadable-line", 1, "GRID 1 0.0 0.0\n");
  std::string junk;
  for (int i = 0; i < 1000; ++i) junk += "%%%\n";
  EXPECT_LT(read(junk).diagnostics.num_errors(), 25);
}

}  // namespace
}  // namespace bough::nastran
