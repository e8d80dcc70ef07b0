/// Formats of numbers: C's as printf, Fortran's as its standard writes them.
#include "formats/flx/number_format.hpp"

#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <random>

namespace bough::flx {
namespace {

std::string print(const std::string& format, double value) {
  const auto parsed = NumberFormat::parse(format);
  if (!parsed) return "bad format";
  return parsed->print(value).value_or("too wide");
}

struct Printed {
  const char* format;
  double value;
  const char* text;
};
void expect_prints(const std::vector<Printed>& cases) {
  for (const auto& [format, value, text] : cases) EXPECT_EQ(print(format, value), text) << format;
}

TEST(NumberFormat, Fortran) {
  expect_prints({
      {"E16.8", 1234.5, "  0.12345000E+04"},
      {"5E16.8", -0.001, " -0.10000000E-02"},
      {"E16.8", 0, "  0.00000000E+00"},
      {"1PE16.8", 1234.5, "  1.23450000E+03"},
      {"1P5E16.8", 1234.5, "  1.23450000E+03"},
      {"1P,5E16.8", 1234.5, "  1.23450000E+03"},
      {"es12.3", 9.9996, "   1.000E+01"},
      {"D24.16", 0.1, "  0.1000000000000000D+00"},
      {"1PD10.2", -2e-120, " -2.00-120"},
      {"E10.2", 1e100, "  0.10+101"},
      {"F8.3", -1.5, "  -1.500"},
      {"E14.8", 1, "0.10000000E+01"},
      {"E13.8", 1, ".10000000E+01"},
      {"E13.8", -1, "too wide"},
      {"F5.1", 12345, "too wide"},
      {"E16.8", -0.0, "  0.00000000E+00"},
  });
}

TEST(NumberFormat, C) {
  expect_prints({
      {"%16.8E", 1234.5, "  1.23450000E+03"},
      {"%-12.3e", 1, "1.000e+00   "},
      {"%+.3f", 1, "+1.000"},
      {"%g", 0.1, "0.1"},
      {"%.17g", 0.1, "0.10000000000000001"},
      {"%8.3E", 1, "too wide"},
  });
}

/// Digit for digit, from the least number to the greatest, halves that are rounded to even among them.
TEST(NumberFormat, PrintsAsPrintf) {
  std::mt19937_64 random(7);
  std::vector<double> values{5e-324, 1.7976931348623157e308, 0.5, 1.5, 2.5, 0.125, 9.9999995, 1e100, 1e-100};
  for (int i = 0; i < 2000; ++i) {
    const double x = std::bit_cast<double>(random());
    if (std::isfinite(x)) values.push_back(x);
  }
  for (const char* format : {"%17.8E", "%e", "%.0e", "%.16E", "%40.25e", "%+17.8E", "%.3f"})
    for (const double x : values) {
      std::array<char, 512> expected;
      std::snprintf(expected.data(), expected.size(), format, x);
      ASSERT_EQ(print(format, x), expected.data()) << format;
    }
}

TEST(NumberFormat, Integers) {
  EXPECT_EQ(NumberFormat::parse("I5")->print_integer(42), "   42");
  EXPECT_EQ(NumberFormat::parse("%05d")->print_integer(42), "00042");
  EXPECT_EQ(NumberFormat::parse("%d")->print_integer(42), "42");
  EXPECT_EQ(NumberFormat::parse("10I5")->per_line(), 10);
  EXPECT_FALSE(NumberFormat::parse("I2")->print_integer(123));
  EXPECT_EQ(NumberFormat::parse("5E16.8")->per_line(), 5);
}

TEST(NumberFormat, RefusesWhatItCannotPrint) {
  for (const char* text : {"", "%s", "%n", "%*d", "%16.8E%d", "E16", "E16.", "I5.2x", "0E16.8", "3PE16.8", "E99.8",
                           "A8", "%999d", "%.99f", "E16.0", "%ld", "E0.0"})
    EXPECT_FALSE(NumberFormat::parse(text)) << text;
}

}  // namespace
}  // namespace bough::flx
