/// Fortran's list-directed reading, record by record.
#include "formats/flx/list_directed.hpp"

#include <gmock/gmock.h>

namespace bough::flx {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Reading {
  explicit Reading(std::string text) : reader(std::move(text), "in.dat", diagnostics) {}
  std::vector<double> read(std::size_t count, const std::string& item = "item 1 of 1: numbers") {
    std::vector<double> values(count);
    ok = reader.read(item, values);
    return values;
  }
  Diagnostics diagnostics;
  ListReader reader;
  bool ok = true;
};

TEST(ListDirected, BlanksCommasTabsAndLineEndsSeparate) {
  Reading in("1 2,3\t4 , 5\n\n  6\r\n,7\n");
  EXPECT_THAT(in.read(7), ElementsAre(1, 2, 3, 4, 5, 6, 7));
  EXPECT_TRUE(in.ok);
}

TEST(ListDirected, EveryFormOfARealNumber) {
  Reading in("1 -1. +.5 1D-3 2.5d+2 1e2 1.5E-2 1.5+3 2-1 1Q2 1E-999");
  EXPECT_THAT(in.read(11), ElementsAre(1, -1, 0.5, 1e-3, 250, 100, 0.015, 1500, 0.2, 100, 0));
  EXPECT_EQ(in.diagnostics.num_errors(), 0);
}

TEST(ListDirected, RepeatCounts) {
  Reading in("3*0.5, 2*-1D0 7");
  EXPECT_THAT(in.read(6), ElementsAre(0.5, 0.5, 0.5, -1, -1, 7));
}

TEST(ListDirected, NullValuesStayZero) {
  Reading in(",2,,4, ,6 2* 9\n1,,\n2");
  EXPECT_THAT(in.read(9), ElementsAre(0, 2, 0, 4, 0, 6, 0, 0, 9));
  EXPECT_THAT(in.read(3), ElementsAre(1, 0, 2));
}

TEST(ListDirected, SlashEndsTheReadAndTheRecord) {
  Reading in("1 2 / 3 4\n5/6\n");
  EXPECT_THAT(in.read(4), ElementsAre(1, 2, 0, 0));
  EXPECT_THAT(in.read(2), ElementsAre(5, 0));
  EXPECT_TRUE(in.diagnostics.items().empty());
}

TEST(ListDirected, EachReadStartsOnANewLineAndTakesMoreWhereItMust) {
  Reading in("1 2 words behind\n3\n4\n5 6\n");
  EXPECT_THAT(in.read(2), ElementsAre(1, 2));
  EXPECT_THAT(in.read(2), ElementsAre(3, 4));
  EXPECT_THAT(in.read(1), ElementsAre(5));
}

TEST(ListDirected, CommentsAreAnExtension) {
  Reading in("! a\n# b\ncc Read model size\nC\n* c\n % d\n $ e\n1 ! 9 9\n2\n");
  EXPECT_THAT(in.read(2), ElementsAre(1, 2));
}

TEST(ListDirected, IntegersTakeNoPoint) {
  Reading in("3 4.0\n");
  std::vector<int> values(2);
  EXPECT_TRUE(in.reader.read("item 7 of 12: number of modes", values));
  ASSERT_EQ(in.diagnostics.num_errors(), 1);
  const auto& error = in.diagnostics.items()[0];
  EXPECT_EQ(error.id, "flx.bad-number");
  EXPECT_EQ(error.where.line, 1);
  EXPECT_THAT(error.what, HasSubstr("item 7 of 12: number of modes: value 2 of 2 is not an integer, found \"4.0\""));
}

TEST(ListDirected, WordsAndInfinitiesAreNoNumbers) {
  for (const char* text : {"x", "1x", "1e", "--1", "1e5e5", ".", "Inf", "nan", "1E999", "0*1", "-", "'1'", "2*x"}) {
    Reading in(std::string("1\n") + text + " 2\n");
    in.read(1);
    in.read(2);
    ASSERT_GE(in.diagnostics.num_errors(), 1) << text;
    EXPECT_EQ(in.diagnostics.items()[0].id, "flx.bad-number") << text;
    EXPECT_EQ(in.diagnostics.items()[0].where.line, 2) << text;
  }
}

TEST(ListDirected, NumbersLeftOnTheLineAreReportedOnceAnItem) {
  Reading in("1 2 3\n1 2 3\n4*1\n1 2 /\n");
  in.read(2, "item 1 of 2: mass matrix, row 1 of 2");
  in.read(2, "item 1 of 2: mass matrix, row 2 of 2");
  EXPECT_EQ(in.diagnostics.num_warnings(), 1);
  EXPECT_TRUE(in.diagnostics.has("flx.extra-values"));
  in.read(2, "item 2 of 2: stiffness matrix, row 1 of 1");
  EXPECT_EQ(in.diagnostics.num_warnings(), 2) << "a repeat count that gives too many";
  in.reader.check_end();
  EXPECT_TRUE(in.diagnostics.has("flx.trailing-data"));
}

// A value left out shifts all that follows: the message at the end of the file points to the row.
TEST(ListDirected, AShortFileNamesTheRowThatTookMoreLines) {
  Reading in("1 2 3\n1 2\n1 2 3\n");
  in.read(3, "item 1 of 1: matrix, row 1 of 3");
  in.read(3, "item 1 of 1: matrix, row 2 of 3");
  EXPECT_TRUE(in.ok);
  in.read(3, "item 1 of 1: matrix, row 3 of 3");
  EXPECT_FALSE(in.ok);
  const auto& error = in.diagnostics.items().back();
  EXPECT_EQ(error.id, "flx.short-file");
  EXPECT_THAT(error.what, HasSubstr("row 3 of 3: the file ends after 0 of 3 values"));
  EXPECT_THAT(error.advice, HasSubstr("row 2 of 3 took 2 lines from line 2 on"));
}

TEST(ListDirected, AnEmptyFileIsShort) {
  for (const char* text : {"", "\n\n", "! only a remark"}) {
    Reading in(text);
    in.read(1);
    EXPECT_FALSE(in.ok) << text;
  }
}

}  // namespace
}  // namespace bough::flx
