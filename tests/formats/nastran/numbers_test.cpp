#include <gtest/gtest.h>

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

TEST(Numbers, RealsOfEverySpelling) {
  EXPECT_EQ(parse_real("1.0"), 1.0);
  EXPECT_EQ(parse_real(".5"), 0.5);
  EXPECT_EQ(parse_real("-.5"), -0.5);
  EXPECT_EQ(parse_real("+3."), 3.0);
  EXPECT_EQ(parse_real("1.0-3"), 1e-3);
  EXPECT_EQ(parse_real("-2.5+10"), -2.5e10);
  EXPECT_EQ(parse_real("1.D2"), 100.0);
  EXPECT_EQ(parse_real("1.2d-3"), 1.2e-3);
  EXPECT_EQ(parse_real("1.2E+3"), 1200.0);
  EXPECT_EQ(parse_real("1.2e3"), 1200.0);
  EXPECT_EQ(parse_real("1.2D+03"), 1200.0);
  EXPECT_EQ(parse_real("7"), 7.0);
  EXPECT_EQ(parse_real("4.8611-4"), 4.8611e-4);
}

TEST(Numbers, WhatIsNoReal) {
  for (const char* text : {"",     "+",    "-",       ".",     "1.0E", "1.0-",  "abc",     "1.0 2", "inf",  "nan",
                           "-inf", "0x10", "1.0E3-4", "+-1.0", "1.0D", "1e999", "1.0+999", "1,0",   "--1.", "1.0-3.5"})
    EXPECT_FALSE(parse_real(text).has_value()) << text;
}

TEST(Numbers, Integers) {
  EXPECT_EQ(parse_int("12"), 12);
  EXPECT_EQ(parse_int("-12"), -12);
  EXPECT_EQ(parse_int("+12"), 12);
  EXPECT_EQ(parse_int("0012"), 12);
  for (const char* text : {"", "+", "1.0", "1.", "1 2", "99999999999", "1e3", "+-1", "x"})
    EXPECT_FALSE(parse_int(text).has_value()) << text;
}

TEST(Numbers, Components) {
  EXPECT_EQ(parse_components("123456"), 63u);
  EXPECT_EQ(parse_components("0"), 0u);
  EXPECT_EQ(parse_components("26"), 34u);
  for (const char* text : {"", "7", "-1", "1.0", "102", "x"}) EXPECT_FALSE(parse_components(text).has_value()) << text;
}

}  // namespace
}  // namespace bough::nastran::detail
