/// Normal modes of beams against closed forms and the published NAFEMS tables.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bough/modal/eigen.hpp"
#include "tests/support/beam_decks.hpp"

namespace bough {
namespace {

using modal::EigenOptions;
using modal::EigenPairs;
using test::DeckMaker;
using test::Section;
constexpr double kPi = std::numbers::pi;

EigenPairs solve(const records::Deck& deck, int num_modes, Diagnostics& diagnostics) {
  const auto model = fe::Model::build(deck, {}, diagnostics);
  EigenOptions options;
  options.num_modes = num_modes;
  return calc_normal_modes(model, options, diagnostics);
}

EigenPairs solve(const records::Deck& deck, int num_modes) {
  Diagnostics diagnostics;
  return solve(deck, num_modes, diagnostics);
}

double get_rate(const EigenPairs& pairs, int i) { return std::sqrt(pairs.lambda(i)); }


TEST(BeamModes, ReportCantileverWith40Bars) {
  for (const bool lumped : {false, true}) {
    const auto maker = test::make_cantilever(test::get_report_section(), test::kReportLength, 40, lumped);
    const auto pairs = solve(maker.deck, 6);
    ASSERT_EQ(pairs.lambda.size(), 6);
    const double expected[] = {2.91022, 18.2380, 51.067};
    for (int i = 0; i < 6; ++i) {
      std::printf("lumped %d mode %d: %.6f (%.2e) residual %.1e\n", lumped, i, get_rate(pairs, i), get_rate(pairs, i) / expected[i / 2] - 1, pairs.residual(i));
      EXPECT_NEAR(get_rate(pairs, i) / expected[i / 2], 1, lumped ? 1e-2 : 2e-4) << i;
    }
    EXPECT_EQ(pairs.num_rigid, 0);
    EXPECT_EQ(pairs.inertia_count, 6);
  }
}

}  // namespace
}  // namespace bough
