/// \file Lines as real decks write them: tags, commas and blanks, equations, INCLUDE by symbol, statements that are no
/// cards.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

const Eigen::Vector3d kOffset(0, 0, .1);

TEST(Tags, MarksOfTheirOwnAndBothCases) {
  // The continuation repeats "+000001" behind its own mark; "+c1" continues "+C1".
  for (const char* tags :
       {"+000001 ++000001", "+000001 +000001 ", "+AB     +ab     ", "+ab     +AB     ", "AB      +B      "}) {
    const std::string parent(tags, 7), child(std::string(tags).substr(8, 8));
    std::string text = "CBAR    1       1       1       2       0.      1.      0.              " + parent + "\n";
    text += child + "                0.      0.      .1\n";
    const auto deck = read_clean(text);
    ASSERT_EQ(deck.beams.size(), 1u) << text;
    EXPECT_EQ(deck.beams[0].wa, kOffset) << text;
  }
}

TEST(Tags, SortedApartFromTheirCards) {
  const auto deck = read_clean(
      "+c1                     0.      0.      .1\n"
      "CBAR    1       1       1       2       0.      1.      0.              +C1\n"
      "CBAR    2       1       2       3       0.      1.      0.              +c2\n"
      "GRID    3               3.      1.      .5\n"
      "++C2                    0.      0.      .1\n");
  ASSERT_EQ(deck.beams.size(), 2u);
  EXPECT_EQ(deck.beams[0].wa, kOffset);
  EXPECT_EQ(deck.beams[1].wa, kOffset);
}

TEST(Tags, EqualToTheLetterGoesFirst) {
  // "+A" and "++A" are two tags here, each with its own continuation.
  const auto deck = read_clean(
      "CBAR    1       1       1       2       0.      1.      0.              +A\n"
      "CBAR    2       1       1       2       0.      1.      0.              ++A\n"
      "GRID    1\n"
      "++A                     0.      0.      2.\n"
      "+A                      0.      0.      1.\n");
  ASSERT_EQ(deck.beams.size(), 2u);
  EXPECT_EQ(deck.beams[0].wa.z(), 1.0);
  EXPECT_EQ(deck.beams[1].wa.z(), 2.0);
}

TEST(FreeField, BlanksAndNamesInTheirColumns) {
  for (const char* text : {"CBAR,2,1,2,3,0.,1.,0.\n", "CBAR, 2 1 2 3 0. 1. 0.\n", "CBAR    2,1,2,3,0.,1.,0.\n",
                           "CBAR 2 ,1 , 2 3,0.,1.,0.\n", "cbar\t2,1\t2,3,0.,1.,0.\n"}) {
    const auto deck = read_clean(text);
    ASSERT_EQ(deck.beams.size(), 1u) << text;
    const auto& e = deck.beams[0];
    EXPECT_EQ(e.id, 2) << text;
    EXPECT_EQ(e.pid, 1) << text;
    EXPECT_EQ(e.gb, 3) << text;
    EXPECT_EQ(e.v, Eigen::Vector3d(0, 1, 0)) << text;
  }
}

TEST(FreeField, BlankFirstFieldInColumnsOrWithItsComma) {
  for (const char* second : {",,,0.,0.,.1\n", "        ,,,0.,0.,.1\n", "+,,,0.,0.,.1\n", "+       ,,,0.,0.,.1\n"}) {
    const auto deck = read_clean(std::string("CBAR,1,1,1,2,0.,1.,0.\n") + second);
    ASSERT_EQ(deck.beams.size(), 1u) << second;
    EXPECT_EQ(deck.beams[0].wa, kOffset) << second;
  }
  // Eight blank columns are the blank field 1: data begins behind them.
  const auto deck = read_clean("CORD2R,1,,0.,0.,0.,0.,0.,1.\n        1.,2.,3.\n");
  EXPECT_EQ(deck.coord_systems.at(0).c, Eigen::Vector3d(1, 2, 3));
}

TEST(FreeField, LongLinesGoOnInTheNextFields) {
  const auto deck = read_clean("CBAR,1,1,1,2,0.,1.,0.,,,,0.,0.,.1,0.,0.,.2\n");
  ASSERT_EQ(deck.beams.size(), 1u);
  EXPECT_EQ(deck.beams[0].wa, kOffset);
  EXPECT_EQ(deck.beams[0].wb.z(), .2);
  EXPECT_EQ(read_clean("CHEXA,1,1,1,2,3,4,5,6,7,8\n").solids.at(0).corners.back(), 8);
}

TEST(Equations, CommasAndSignsAreTheirText) {
  const auto r = read(
      "DEQATN  5       F(A,B) = A*B + SIN(A)\n"
      "        + 2.*B\n"
      "DEQATN  6       F(A,B) = MAX(A,B);\n"
      "+       G = A = B, 2\n"
      "DEQATN,7,F(A)=A\n"
      "GRID,1,,1.,2.,3.\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  EXPECT_EQ(r.deck.card_counts.at("DEQATN"), 3);
  EXPECT_EQ(r.deck.grids.at(0).x.z(), 3.0);
}

class IncludeBySymbol : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("bough_symbol_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_ / "parts");
    std::ofstream(folder_ / "parts" / "a.inc") << "GRID,7\nINCLUDE 'BOUGH_TEST_PARTS:\nb.inc'\n";
    std::ofstream(folder_ / "parts" / "b.inc") << "GRID,8\n";
    std::ofstream(folder_ / "deck.bdf") << "INCLUDE 'Bough_Test_Parts:a.inc'\n";
  }
  void TearDown() override {
    ::unsetenv("BOUGH_TEST_PARTS");
    std::filesystem::remove_all(folder_);
  }
  Read read_file() const {
    Read r;
    r.deck = read_deck((folder_ / "deck.bdf").string(), {}, r.diagnostics);
    return r;
  }
  std::filesystem::path folder_;
};

TEST_F(IncludeBySymbol, IsTakenFromTheEnvironment) {
  ::setenv("BOUGH_TEST_PARTS", (folder_ / "parts").c_str(), 1);
  const auto r = read_file();
  EXPECT_EQ(r.diagnostics.items().size(), 0u) << r.get_messages();
  ASSERT_EQ(r.deck.grids.size(), 2u);
  EXPECT_EQ(r.deck.grids[1].id, 8);
}

TEST_F(IncludeBySymbol, IsNamedWhenItIsNotSet) {
  const auto r = read_file();
  ASSERT_EQ(r.count("deck.include-missing"), 1) << r.get_messages();
  EXPECT_NE(r.find("deck.include-missing")->advice.find("environment variable Bough_Test_Parts"), std::string::npos);
}

TEST(Statements, SecondBeginBulkAndDeletions) {
  const auto r = read("SOL 101\nCEND\nBEGIN BULK\nGRID,1\nBEGIN BULK\n/ 1,5\nGRID,2\nENDDATA\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  EXPECT_EQ(r.count("deck.second-begin"), 1);
  EXPECT_EQ(r.count("deck.delete-line"), 1);
  EXPECT_EQ(r.deck.grids.size(), 2u);
}

TEST(Statements, DmapBetweenSolAndCend) {
  const auto r = read(
      "ID A,B\nAPP DMAP\nBEGIN $\nGP1 GEOM1,GEOM2,/GPL,EQEXIN/V,N,LUSET $\nEND $\nCEND\nLOAD=3\nBEGIN BULK\nGRID,1\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  EXPECT_EQ(r.deck.subcases.at(0).load, 3);
  EXPECT_EQ(r.deck.grids.size(), 1u);
}

TEST(Statements, DefaultsOfASuperelementAreNotOfTheModel) {
  const auto r = read("GRDSET,,,,,,,345\nGRID,1\nBEGIN SUPER=1\nGRDSET,,,,,,,12\nGRID,1\n");
  EXPECT_EQ(r.count("deck.duplicate-id"), 0) << r.get_messages();
  EXPECT_EQ(r.deck.grids.at(0).ps, 28u);
  EXPECT_EQ(read("GRDSET,,,,,,,345\nGRDSET,,,,,,,345\n").count("deck.repeated-card"), 1);
  EXPECT_EQ(read("GRDSET,,,,,,,345\nGRDSET,,,,,,,12\n").count("deck.duplicate-id"), 1);
}

TEST(Statements, NastranCells) {
  const auto deck = read_clean(
      "NASTRAN barmass = 1, SYSTEM(304)=5 $ cells\nNASTRAN BUFFSIZE=1000,\n  CONFIG=4\nSOL 103\nCEND\nBEGIN BULK\n");
  const std::map<std::string, std::string> expected{
      {"BARMASS", "1"}, {"SYSTEM(304)", "5"}, {"BUFFSIZE", "1000"}, {"CONFIG", "4"}};
  EXPECT_EQ(deck.system_cells, expected);
}

}  // namespace
}  // namespace bough::nastran
