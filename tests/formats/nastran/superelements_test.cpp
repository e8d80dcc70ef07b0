// Superelement cards, sections of BEGIN SUPER, ASSIGN INPUTT4, subcases of superelements.
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

constexpr const char* kAssembly =
    "ASSIGN INPUTT4='parts/panel.op4',\n       UNIT=101\nASSIGN OUTPUT2='x.op2',UNIT=12\nSOL 103\nCEND\nMETHOD=1\n"
    "SUBCASE 1\nSUPER=0\nSUBCASE 2\nSUPER=101\nBEGIN BULK\n"
    "SEBULK,101,EXTOP4,,MANUAL,,,101\n"
    "SECONCT,101,0,,NO,,,,,+\n+,3,13,4,14,201,THRU,203,301,+\n+,THRU,303\n"
    "GRID,13\nGRID,14,,1.\nSPOINT,301,THRU,303\n"
    "BEGIN SUPER=101\n"
    "EXTRN,3,123456,4,123456,201,0,202,0,+\n+,203,0\n"
    "GRID,3\nGRID,4,,1.\nASET,3,123456,4,123456\nQSET1,0,201,THRU,203\nSPOINT,201,THRU,203\n"
    "DTI,TUG1,0,6,15,32767,0,7,0,+\n+,PHIP,,7,,,REAL,1,ENDREC\n"
    "DTI,TUG1,2,,,,,,,+\n+,TYPE,ID,COMP,ROW,TYPE,ID,COMP,ROW,+\n+,1,3,6,1,2,202,1,7,+\n+,ENDREC\n"
    "ENDDATA\n";

TEST(Superelements, CardsOfAnAssembly) {
  const auto r = read(kAssembly);
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  EXPECT_EQ(r.diagnostics.num_warnings(), 0) << r.get_messages();
  const auto& super = r.deck.super;
  ASSERT_EQ(super.sebulk.size(), 1u);
  EXPECT_EQ(values(super.sebulk[0].id, super.sebulk[0].type, super.sebulk[0].unit), values(101, "EXTOP4", 101));
  EXPECT_FALSE(super.sebulk[0].is_auto);
  ASSERT_EQ(super.input4.count(101), 1u);
  EXPECT_EQ(super.input4.at(101).path, "parts/panel.op4");
  EXPECT_EQ(super.input4.size(), 1u);
  ASSERT_EQ(super.seconct.size(), 1u);
  const std::vector<std::pair<int, int>> joined{{3, 13}, {4, 14}, {201, 301}, {202, 302}, {203, 303}};
  EXPECT_EQ(super.seconct[0].points, joined);
  EXPECT_EQ(r.deck.grids.size(), 2u);  // those of the section are its own
  EXPECT_EQ(r.deck.scalar_points.size(), 3u);
}

TEST(Superelements, ASectionIsADeckOfItsOwn) {
  const auto deck = read(kAssembly).deck;
  ASSERT_EQ(deck.super.sections.size(), 1u);
  EXPECT_EQ(deck.super.sections[0].id, 101);
  const auto& section = *deck.super.sections[0].deck;
  ASSERT_EQ(section.super.extrn.size(), 5u);
  EXPECT_EQ(values(section.super.extrn[1].c, section.super.extrn[4].id, section.super.extrn[4].c),
            values(63u, 203, 0u));
  EXPECT_EQ(section.grids.size(), 2u);
  ASSERT_EQ(section.super.rows.size(), 1u);
  const auto& rows = section.super.rows[0];
  EXPECT_EQ(rows.name, "TUG1");
  ASSERT_EQ(rows.items.size(), 2u);
  EXPECT_EQ(values(rows.items[1].type, rows.items[1].id, rows.items[1].first_row), values(2, 202, 6));
}

TEST(Superelements, SubcasesOfSuperelementsAreNotTheModels) {
  const auto r = read(kAssembly);
  ASSERT_EQ(r.deck.subcases.size(), 1u);
  EXPECT_EQ(r.deck.subcases[0].id, 1);
  EXPECT_EQ(r.count("deck.superelement-case"), 1);
}

TEST(Superelements, RangesOfSeconctAreOfOneLength) {
  const auto r = read("SECONCT,1,0\n,11,THRU,13,21,THRU,24\n");
  EXPECT_EQ(r.count("deck.bad-list"), 1) << r.get_messages();
}

TEST(Superelements, TablesThatAreNotReadAreNamedOnce) {
  const auto r = read("GRID,1\nDTI,TMAA,1,101,0\nDTI,TMAA,2,101,0\nDTI,TGM,1,0\n");
  EXPECT_EQ(r.count("deck.unused-card"), 2) << r.get_messages();
}

TEST(Superelements, LoadsOfComponents) {
  const auto deck = read_clean(
      "GRID,1\nSELOAD,5,101,1102\nDTI,SELOAD,0,1130\nDTI,SELOAD,1101,1101,1,SE_LOAD_,_1101,ENDREC\n"
      "DTI,SELOAD,1102,1102,2,SE_LOAD_,_1102,ENDREC\n");
  ASSERT_EQ(deck.super.seload.size(), 1u);
  EXPECT_EQ(deck.super.seload[0].set, 5);
  EXPECT_EQ(deck.super.seload[0].load, 1102);
  const std::map<int, int> columns{{1101, 1}, {1102, 2}};
  EXPECT_EQ(deck.super.load_columns, columns);
}

TEST(Superelements, ExtseoutOfTheCaseControl) {
  const auto r =
      read("SOL 103\nCEND\nEXTSEOUT(ASMBULK,EXTBULK,EXTID=7,MATOP4=31)\nBEGIN BULK\nGRID,1\nBSET1,123456,1\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  ASSERT_TRUE(r.deck.super.output.has_value());
  EXPECT_EQ(r.deck.super.output->id, 7);
  EXPECT_EQ(r.deck.super.output->unit, 31);
  ASSERT_EQ(r.deck.bset.size(), 1u);
  EXPECT_EQ(r.deck.bset[0].c, 63u);
  EXPECT_NE(r.get_messages().find("export --to extseout"), std::string::npos);
}

}  // namespace
}  // namespace bough::nastran
