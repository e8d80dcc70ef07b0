/// \file Formats of a line, continuations, replication: one card written in many ways must read the same.
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

/// GRID 7, CP 2, x = (1.5, -2e-3, 30), CD 3, PS 126.
void expect_grid(const records::Deck& deck) {
  ASSERT_EQ(deck.grids.size(), 1u);
  const auto& g = deck.grids[0];
  EXPECT_EQ(g.id, 7);
  EXPECT_EQ(g.cp, 2);
  EXPECT_EQ(g.x, Eigen::Vector3d(1.5, -2e-3, 30.0));
  EXPECT_EQ(g.cd, 3);
  EXPECT_EQ(g.ps, 0b100011u);
}

TEST(Fields, GridInEveryFormat) {
  const char* spellings[] = {
      // small field
      "GRID    7       2       1.5     -2.-3   30.     3       126\n",
      "GRID           7       2     1.5   -2.-3     30.       3     126\n",
      // lower case, not in column 1, comment after data
      "grid    7       2       1.5     -2.-3   30.     3       126 $ node\n",
      "  GRID  7       2       1.5     -2.-3   30.     3       126\n",
      // free field, blanks around, tabs, trailing commas
      "GRID,7,2,1.5,-2.-3,30.,3,126\n",
      "  grid , 7,2 , 1.5,\t-2.D-3,3.e1,3,126,,\n",
      // tabs to the 8-column stops
      "GRID\t7\t2\t1.5\t-2.-3\t30.\t3\t126\n",
      // large field: tagged, anonymous, tab, free
      "GRID*   7               2               1.5             -2.-3           *A1\n*A1     30.             3          "
      "     "
      "126\n",
      "GRID*   7               2               1.5             -2.-3\n*       30.             3               126\n",
      "GRID*,7,2,1.5,-2.-3,*B\n*B,30.,3,126\n",
      "GRID*,7,2,1.5,-2.-3\n*,30.,3,126\n",
      // carriage returns, no end of line at the end
      "GRID    7       2       1.5     -2.-3   30.     3       126\r\n",
      "$ first\n\n   \nGRID,7,2,1.5,-2.-3,30.,3,126\nENDDATA",
  };
  for (const char* text : spellings) {
    SCOPED_TRACE(text);
    expect_grid(read_clean(text));
  }
}

/// CORD2R 4 with A = (1,2,3), B = (1,2,4), C = (2,2,3).
void expect_system(const records::Deck& deck) {
  ASSERT_GE(deck.coord_systems.size(), 1u);
  for (const auto& s : deck.coord_systems) {
    if (s.id != 4) continue;
    EXPECT_EQ(s.a, Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(s.b, Eigen::Vector3d(1, 2, 4));
    EXPECT_EQ(s.c, Eigen::Vector3d(2, 2, 3));
    return;
  }
  FAIL() << "no system 4";
}

TEST(Fields, ContinuationsOfEveryKind) {
  const char* spellings[] = {
      "CORD2R  4       0       1.      2.      3.      1.      2.      4.      +C1\n+C1     2.      2.      3.\n",
      "CORD2R  4       0       1.      2.      3.      1.      2.      4.      +\n+       2.      2.      3.\n",
      "CORD2R  4       0       1.      2.      3.      1.      2.      4.\n+       2.      2.      3.\n",
      "CORD2R  4       0       1.      2.      3.      1.      2.      4.\n        2.      2.      3.\n",
      // the first letter of the parent's tag does not count
      "CORD2R  4       0       1.      2.      3.      1.      2.      4.      KC1\n+C1     2.      2.      3.\n",
      // a tag on the continuation alone
      "CORD2R  4       0       1.      2.      3.      1.      2.      4.\n+C1     2.      2.      3.\n",
      "CORD2R,4,0,1.,2.,3.,1.,2.,4.,+C1\n+C1,2.,2.,3.\n",
      "CORD2R,4,0,1.,2.,3.,1.,2.,4.,\n,2.,2.,3.\n",
      "CORD2R,4,0,1.,2.,3.,1.,2.,4.\n+,2.,2.,3.\n",
      "CORD2R,4,,1.,2.,3.,1.,2.,4.,+,+,2.,2.,3.\n",
      // comment and blank lines between
      "CORD2R,4,0,1.,2.,3.,1.,2.,4.\n$ now C\n\n,2.,2.,3.\n",
      // small parent, free continuation and the reverse
      "CORD2R  4       0       1.      2.      3.      1.      2.      4.\n,2.,2.,3.\n",
      "CORD2R,4,0,1.,2.,3.,1.,2.,4.\n        2.      2.      3.\n",
      // large with a small last line
      "CORD2R* 4               0               1.              2.\n"
      "*       3.              1.              2.              4.\n+       2.      2.      3.\n",
      "CORD2R* 4               0               1.              2.              *A\n"
      "*A      3.              1.              2.              4.              *B\n"
      "*B      2.              2.              3.\n",
  };
  for (const char* text : spellings) {
    SCOPED_TRACE(text);
    expect_system(read_clean(text));
  }
}

TEST(Fields, TagsAreMatchedOutOfOrder) {
  const auto deck = read_clean(
      "+C1     2.      2.      3.\n"
      "CORD2R  5       0       0.      0.      0.      0.      0.      1.      +C2\n"
      "CORD2R  4       0       1.      2.      3.      1.      2.      4.      +C1\n"
      "GRID    1\n"
      "+C2     7.      0.      0.\n");
  expect_system(deck);
  ASSERT_EQ(deck.coord_systems.size(), 2u);
  EXPECT_EQ(deck.coord_systems[0].c, Eigen::Vector3d(7, 0, 0));
}

TEST(Fields, TagsMayBeUsedAgainForTheNextCard) {
  const auto deck = read_clean(
      "CORD2R  4       0       1.      2.      3.      1.      2.      4.      +0\n+0      2.      2.      3.\n"
      "CORD2R  5       0       1.      2.      3.      1.      2.      4.      +0\n+0      8.      2.      3.\n");
  expect_system(deck);
  EXPECT_EQ(deck.coord_systems[1].c.x(), 8.0);
}

TEST(Fields, OrphanContinuation) {
  const auto r = read("GRID,1,,0.,0.,0.,,,,+A\n+B,1.,2.\nGRID,2\n");
  ASSERT_EQ(r.count("deck.orphan-continuation"), 1);
  EXPECT_EQ(r.find("deck.orphan-continuation")->where.line, 2);
  EXPECT_EQ(r.deck.grids.size(), 2u);
  EXPECT_EQ(read("+A,1,2\n+B,3\n").count("deck.orphan-continuation"), 2);
}

// Eight blank fields written as an empty line: the readers of decks skip it, and K1, K2 of a PBEAM become stress
// points.
TEST(Fields, EmptyLineBeforeAContinuation) {
  const std::string head = "PBEAM   7       7       1.      1.      1.              1.\n";
  const auto r = read(head + "\n        0.      0.\nGRID,1\n\n$\nGRID,2\n");
  ASSERT_EQ(r.count("deck.empty-line"), 1);
  EXPECT_EQ(r.find("deck.empty-line")->where.line, 3);
  EXPECT_EQ(read(head + "+\n        0.      0.\n").count("deck.empty-line"), 0);
  EXPECT_EQ(read("PBEAM,7,7,1.,1.,1.,,1.\n\n,0.,0.\n").count("deck.empty-line"), 0);
  EXPECT_EQ(read(head + "$ a comment is none\n        0.      0.\n").count("deck.empty-line"), 0);
}

TEST(Fields, DataBeyondFieldNineGoesOn) {
  // A number alone in field 10 is a mark to Nastran, which drops it: a warning, unless a line continues it.
  const auto r = read("SPC1,1,123456,1,2,3,4,5,6,7\n");
  ASSERT_NE(r.find("deck.too-many-fields"), nullptr);
  EXPECT_EQ(r.find("deck.too-many-fields")->severity, Severity::Warning);
  EXPECT_EQ(r.deck.spc.size(), 6u);
  const auto strong = read("MAT1,1,7.+10,,.3,2700.,1.-5,20.,.01,3.+8\n");
  EXPECT_EQ(strong.count("deck.too-many-fields"), 1);
  EXPECT_EQ(strong.deck.mat1.at(0).ge, .01);
  EXPECT_EQ(read_clean("SPC1,1,123456,1,2,3,4,5,6,7\n+7,8\n").spc.size(), 7u);
  EXPECT_NE(read("SPC1,1,123456,1,2,3,4,5,6,+A,8\n").find("deck.too-many-fields"), nullptr);
  EXPECT_EQ(read_clean("SPC1,1,123456,1,2,3,4,5,6,7,8,9\n").spc.size(), 9u);
  EXPECT_EQ(read_clean("SPC1,1,123456,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16\n").spc.size(), 16u);
  EXPECT_EQ(read_clean("SPC1,1,123456,1,2,3,4,5,6,+A\n+A,7\n").spc.size(), 7u);
  // Once a line has more than ten fields its field 10 is data, and so is a last number that starts another eight.
  for (const std::size_t num : {14u, 15u, 22u, 23u, 30u}) {
    std::string line = "SPC1,1,123456";
    for (std::size_t g = 1; g <= num; ++g) line.append(",").append(std::to_string(g));
    EXPECT_EQ(read_clean(line + "\n").spc.size(), num) << line;
  }
}

TEST(Replication, CopiesAndIncrements) {
  // The Quick Reference Guide's own scheme: field 2 counts up, field 4 steps, the rest is copied.
  for (const char* text : {"GRID,101,17,1.0,10.5,,17,345\n=,*1,=,*0.2,==\n=(3)\n",
                           "GRID,101,17,1.0,10.5,,17,345\n=,*(1),=,*(0.2),==\n=3\n",
                           "GRID    101     17      1.0     10.5            17      345\n"
                           "=       *(1)    =       *(0.2)  ==\n=(3)\n"}) {
    const auto deck = read_clean(text);
    ASSERT_EQ(deck.grids.size(), 5u) << text;
    for (int i = 0; i < 5; ++i) {
      const auto& g = deck.grids[static_cast<std::size_t>(i)];
      EXPECT_EQ(g.id, 101 + i);
      EXPECT_EQ(g.cp, 17);
      EXPECT_NEAR(g.x.x(), 1.0 + 0.2 * i, 1e-14);
      EXPECT_EQ(g.x.y(), 10.5);
      EXPECT_EQ(g.cd, 17);
      EXPECT_EQ(g.ps, 0b011100u);
    }
    EXPECT_EQ(deck.card_counts.at("GRID"), 5);
  }
}

TEST(Replication, BlankFieldsStayBlankAndContinuationsFollow) {
  const auto deck = read_clean(
      "CBAR,1,1,1,2,0.,1.,0.,GGG\n,5,6,1.,2.,3.\n"
      "=,*1,=,*1,*1,==\n"
      "=,*1,=,*1,*1,=,=,=,\n,,,=,==\n");
  ASSERT_EQ(deck.beams.size(), 3u);
  EXPECT_EQ(deck.beams[1].ga, 2);
  EXPECT_EQ(deck.beams[1].wa, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(deck.beams[1].pin_a, 16u);
  EXPECT_EQ(deck.beams[2].gb, 4);
  EXPECT_EQ(deck.beams[2].pin_a, 0u);
  EXPECT_EQ(deck.beams[2].wa, Eigen::Vector3d(1, 2, 3));
}

TEST(Replication, WhatCannotBeReplicated) {
  EXPECT_NE(read("=,*1,==\n").find("deck.bad-replication"), nullptr);
  EXPECT_NE(read("GRID,1,,0.\n=,*x,==\n").find("deck.bad-replication"), nullptr);
  EXPECT_NE(read("GRID,1,,0.\n=,*1.5,==\n").find("deck.bad-replication"), nullptr);
  EXPECT_NE(read("GRID,1,,0.\n=,*1,==\n=(99999999)\n").find("deck.bad-replication"), nullptr);
  EXPECT_NE(read("=(3)\n").find("deck.bad-replication"), nullptr);
  EXPECT_NE(read("GRID,1,,0.\nCBAR,=,1\n").find("deck.bad-replication"), nullptr);
}

TEST(Lists, ThruByExcept) {
  const auto grids = [](int n) {
    std::string text;
    for (int i = 1; i <= n; ++i) text += "GRID," + std::to_string(i) + "\n";
    return text;
  };
  const auto list = [&](const std::string& card) {
    std::string ids;
    for (const auto& spc : read_clean(grids(12) + card).spc)
      ids += std::to_string(spc.g) + (spc.skip_if_missing ? "t " : " ");
    return ids;
  };
  for (const auto& [card, ids] : std::vector<std::pair<std::string, std::string>>{
           {"SPC1,1,123,5,3,99\n", "5 3 99 "},
           {"SPC1,1,123,10,THRU,13\n", "10t 11t 12t "},
           {"SPC1,1,123,10,thru,999999999\n", "10t 11t 12t "},
           {"SPC1,1,123,1,THRU,9,BY,4\n", "1t 5t 9t "},
           {"SPC1,1,123,1,THRU,5,EXCEPT,2,4\n,12\n", "12 1t 3t 5t "},
           {"SPC1,1,123,1,,3\n,THRU,4\n", "1 3t 4t "},
       })
    EXPECT_EQ(list(card), ids) << card;
}

TEST(Lists, WrongLists) {
  for (const char* text : {"SPC1,1,123,THRU,5\n", "SPC1,1,123,5,THRU\n", "SPC1,1,123,5,THRU,3\n", "SPC1,1,123,5,BY,3\n",
                           "SPC1,1,123,5,THRU,9,BY,0\n", "SPC1,1,123,5,EXCEPT,3\n", "SPC1,1,123,1,THRU,5,THRU,9\n",
                           "RBE2,1,1,123,2,THRU,90000000\n"})
    EXPECT_NE(read(text).find("deck.bad-list"), nullptr) << text;
}

}  // namespace
}  // namespace bough::nastran
