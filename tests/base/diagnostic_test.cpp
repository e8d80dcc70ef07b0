#include "base/diagnostic.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace bough {
namespace {

TEST(Failure, OfAMillionDiagnosticsTellsTheFirst) {
  const std::vector<Diagnostic> same(1'000'000, {Severity::Error, "x.same", {}, "again", ""});
  const InputError error(same);
  const std::string text = error.what();
  EXPECT_EQ(error.items().size(), same.size());
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1000);
  EXPECT_EQ(text.substr(text.rfind('\n')), "\n... and 999000 more");
}

TEST(Diagnostics, OfMillionsOfOneKindKeepsSomeAndCountsAll) {
  Diagnostics diagnostics;
  constexpr int n = 300'000;
  for (int i = 0; i < n; ++i) {
    diagnostics.error("deck.bad-integer", {"a.bdf", i}, "wrong");
    diagnostics.error("deck.bad-real", {"a.bdf", i}, "wrong");
  }
  diagnostics.error("fe.no-grids", {"a.bdf"}, "another kind");
  EXPECT_EQ(diagnostics.num_errors(), 2 * n + 1);
  EXPECT_LT(diagnostics.items().size(), 250'000u);
  EXPECT_TRUE(diagnostics.has("fe.no-grids"));
}

TEST(Diagnostic, FormatIsFileLineKindWhatAdviceId) {
  const Diagnostic d{Severity::Error, "deck.missing-grid", {"a.bdf", 12, 0}, "grid 7 does not exist", "add it"};
  EXPECT_EQ(format(d), "a.bdf:12: error: grid 7 does not exist; add it [deck.missing-grid]");
}

TEST(Diagnostic, NamesThatNoTerminalShouldSeeAreWrittenOut) {
  const Diagnostic d{Severity::Error, "x.name", {"f", 1, 0}, std::string("body 'a\0\x1b[2J'\n", 13), "rename it"};
  EXPECT_EQ(format(d), "f:1: error: body 'a\\x00\\x1b[2J'; rename it [x.name]");
}

TEST(Diagnostic, AllErrorsAreThrownTogether) {
  Diagnostics diagnostics;
  diagnostics.warning("w", {}, "odd");
  diagnostics.throw_if_errors();
  diagnostics.error("x.one", {"f", 1, 0}, "first");
  diagnostics.error("x.two", {"f", 2, 0}, "second");
  try {
    diagnostics.throw_if_errors();
    FAIL() << "nothing was thrown";
  } catch (const InputError& e) {
    EXPECT_EQ(e.exit_code(), 1);
    EXPECT_EQ(std::string(e.what()), "warning: odd [w]\nf:1: error: first [x.one]\nf:2: error: second [x.two]");
  }
}

TEST(Diagnostic, NearestWordIsFoundOnlyWhenNear) {
  EXPECT_EQ(find_nearest("integartor", {"duration", "integrator", "gravity"}), "integrator");
  EXPECT_EQ(find_nearest("zzz", {"duration", "integrator"}), "");
  EXPECT_EQ(find_nearest("CBRA", {"CROD", "CBAR", "CBUSH"}), "CBAR");  // swapped letters
  EXPECT_EQ(find_nearest("tip", {"root_force", "tip_deflection"}), "tip_deflection");
  EXPECT_EQ(find_nearest("tip", {"tip_deflection", "tip_rotation"}), "");  // which of them?
  EXPECT_EQ(find_nearest("t", {"tip_deflection"}), "");
}

}  // namespace
}  // namespace bough
