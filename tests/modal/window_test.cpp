/// A range high in the spectrum by a shift inside it, against all modes from the lowest up.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/modal.hpp"

namespace bough {
namespace {

double to_hz(double lambda) { return std::sqrt(lambda) / (2 * std::numbers::pi); }

/// What was found, and the most roots that the solver was asked for at once.
struct Seen {
  EigenPairs pairs;
  Diagnostics said;
  int most_wanted = 0;
};

Seen solve(const records::Deck& deck, EigenOptions options) {
  Seen seen;
  options.progress = [&](int, int wanted) { seen.most_wanted = std::max(seen.most_wanted, wanted); };
  seen.pairs = calc_normal_modes(fe::build_model(deck, {}, seen.said), options, seen.said);
  return seen;
}

EigenOptions make_options(int num_modes, double min_hz, double max_hz = 0) {
  EigenOptions options;
  options.num_modes = num_modes;
  if (min_hz > 0) options.min_hz = min_hz;
  if (max_hz > 0) options.max_hz = max_hz;
  return options;
}

DeckMaker make_beam(bool is_free) {
  DeckMaker maker;
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-11, 3e-11, 4e-11});
  maker.add_line(1, 1, Vector3d::Zero(), {1, 0.3, 0.2}, 60, Vector3d::UnitY());
  if (!is_free) maker.fix(1, 123456);
  return maker;
}

class Window : public ::testing::TestWithParam<bool> {
 protected:
  const DeckMaker maker_ = make_beam(GetParam());
  const Seen all_ = solve(maker_.deck, make_options(280, 0));

  /// Between root j - 1 and root j.
  double before(int j) const { return 0.5 * (to_hz(all_.pairs.lambda(j - 1)) + to_hz(all_.pairs.lambda(j))); }
  void expect_same(const Seen& some, int first, int number) const {
    ASSERT_EQ(some.pairs.lambda.size(), number);
    EXPECT_EQ(some.pairs.inertia_count, first + number);
    EXPECT_EQ(some.pairs.num_rigid, 0);
    for (int j = 0; j < number; ++j) EXPECT_NEAR(some.pairs.lambda(j) / all_.pairs.lambda(first + j), 1, 1e-9) << j;
    const MatrixXd difference = some.pairs.Phi - all_.pairs.Phi.middleCols(first, number);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-5 * all_.pairs.Phi.cwiseAbs().maxCoeff());
    EXPECT_LT(some.pairs.residual.maxCoeff(), 1e-8);
  }
};

TEST_P(Window, HasTheModesOfTheRange) {
  const auto some = solve(maker_.deck, make_options(0, before(140), before(151)));
  expect_same(some, 140, 11);
  EXPECT_EQ(some.most_wanted, 15);  // and four beyond
}

TEST_P(Window, HasAsManyAsAreAskedFor) {
  const auto some = solve(maker_.deck, make_options(7, before(120)));
  expect_same(some, 120, 7);
  EXPECT_LT(some.most_wanted, 120);
  expect_same(solve(maker_.deck, make_options(5, before(120), before(170))), 120, 5);
}

TEST_P(Window, IsDividedWhereItHasMany) {
  expect_same(solve(maker_.deck, make_options(81, before(175))), 175, 81);
  expect_same(solve(maker_.deck, make_options(0, before(175), before(258))), 175, 83);
}

TEST_P(Window, EndsWithTheLastMode) {
  const auto all = solve(maker_.deck, make_options(360, 0));
  const auto& lambda = all.pairs.lambda;
  const auto number = static_cast<int>(lambda.size()), first = number - 4;  // torsion may have no mass
  ASSERT_GT(number, 200);
  const double from = 0.5 * (to_hz(lambda(first - 1)) + to_hz(lambda(first)));
  for (const double to : {0.0, 1.01 * to_hz(lambda(number - 1)), 1e9}) {
    const auto some = solve(maker_.deck, make_options(7, from, to));
    ASSERT_EQ(some.pairs.lambda.size(), 4) << to;
    EXPECT_NEAR(some.pairs.lambda(3) / lambda(number - 1), 1, 1e-9);
    EXPECT_EQ(some.said.has("modal.fewer-modes"), to == 0);
    EXPECT_LT(some.most_wanted, 20);
  }
  const auto none = solve(maker_.deck, make_options(5, 1.01 * to_hz(lambda(number - 1))));
  EXPECT_EQ(none.pairs.lambda.size(), 0);
  EXPECT_TRUE(none.said.has("modal.empty-range"));
}

TEST_P(Window, NeedsNoCheck) {
  EigenOptions options = make_options(5, before(120));
  options.check_inertia = false;
  const auto some = solve(maker_.deck, options);
  ASSERT_EQ(some.pairs.lambda.size(), 5);
  EXPECT_EQ(some.pairs.inertia_count, -1);
  EXPECT_NEAR(some.pairs.lambda(4) / all_.pairs.lambda(124), 1, 1e-9);
  EXPECT_LT(some.most_wanted, 50);
}

TEST_P(Window, IsNotForFewBelow) {
  const auto some = solve(maker_.deck, make_options(0, before(30), before(34)));
  expect_same(some, 30, 4);
  EXPECT_GE(some.most_wanted, GetParam() ? 28 : 34);
}

INSTANTIATE_TEST_SUITE_P(Beam, Window, ::testing::Bool(), [](const auto& of) { return of.param ? "Free" : "Held"; });

/// Seven cantilevers alike: roots of seven and more copies, one of them at the end.
TEST(WindowOfCopies, CompletesTheLastRoot) {
  DeckMaker maker;
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-11, 1e-11, 2e-11});
  for (int i = 0; i < 7; ++i) {
    maker.add_line(1, 100 * i + 1, {0, 1.0 * i, 0}, {1, 1.0 * i, 0}, 12, Vector3d::UnitY());
    maker.fix(100 * i + 1, 123456);
  }
  const auto all = solve(maker.deck, make_options(140, 0));
  const auto& lambda = all.pairs.lambda;
  int first = 80;
  while (lambda(first) - lambda(first - 1) < 1e-3 * lambda(first)) ++first;
  int last = first + 1;
  while (lambda(last) - lambda(first) < 1e-6 * lambda(first)) ++last;
  ASSERT_GT(last - first, 4);
  const auto some = solve(maker.deck, make_options(3, 0.5 * (to_hz(lambda(first - 1)) + to_hz(lambda(first)))));
  ASSERT_EQ(some.pairs.lambda.size(), 3);
  EXPECT_NEAR(some.pairs.lambda(2) / lambda(first), 1, 1e-9);
  EXPECT_EQ(some.pairs.inertia_count, last);
  EXPECT_TRUE(some.said.has("modal.cut-root"));
  EXPECT_LT(some.most_wanted, first);
  EXPECT_LT((some.pairs.Phi - all.pairs.Phi.middleCols(first, 3)).cwiseAbs().maxCoeff(),
            1e-5 * all.pairs.Phi.cwiseAbs().maxCoeff());
}

/// A mode on an end of the range is in it, with all its copies; from below and by a window.
TEST(WindowOfCopies, HoldsRootsOnItsEnds) {
  DeckMaker maker;
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-11, 1e-11, 2e-11});
  maker.add_line(1, 1, Vector3d::Zero(), {1, 0, 0}, 60, Vector3d::UnitY());
  maker.fix(1, 123456);
  const auto all = solve(maker.deck, make_options(200, 0));
  const auto& lambda = all.pairs.lambda;
  const auto is_pair = [&](int j) { return lambda(j + 1) - lambda(j) < 1e-9 * lambda(j); };
  for (const int from : {0, 130}) {
    int first = from, last = from + 12;
    while (!is_pair(first)) ++first;
    while (!is_pair(last)) ++last;
    const auto some = solve(maker.deck, make_options(0, to_hz(lambda(first)), to_hz(lambda(last))));
    EXPECT_EQ(some.pairs.lambda.size(), last + 2 - first) << from;
    EXPECT_EQ(some.pairs.inertia_count, last + 2) << from;
    EXPECT_FALSE(some.said.has("modal.cut-root")) << from;
  }
}

}  // namespace
}  // namespace bough
