/// The search for roots against lists that are known: copies at the cut, roots that the solver passes over, and an
/// inertia that counts too few, which normal modes and those of a held interface tell as "modal.uncertain-count".
#include "modal/roots.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/diagnostic.hpp"

namespace bough::modal::detail {
namespace {

/// Solves for the roots of a diagonal matrix, the lowest that are not known yet; `hidden` comes in later calls only.
struct Diagonal {
  VectorXd all;
  int hidden = -1;
  int lie = 0;  ///< added to what the inertia counts
  int num_solves = 0;

  RootSearch make_search(int wanted) {
    RootSearch search;
    search.requested = wanted;
    search.num_available = static_cast<int>(all.size());
    search.solve = [this](Roots& roots, int number) {
      ++num_solves;
      for (int i = 0; i < all.size() && number > 0; ++i) {
        if (i == hidden && num_solves == 1) continue;
        if (roots.size() > 0 && roots.X.row(i).cwiseAbs().maxCoeff() > 0) continue;
        roots.add(all.segment(i, 1), MatrixXd::Identity(all.size(), all.size()).col(i));
        --number;
      }
    };
    search.closeness = [](const Roots&, int) { return 1e-8; };
    search.roundoff = [](const Roots&, int) { return 1e-12; };
    search.count = [this](double mu) { return static_cast<int>((all.array() < mu).count()) + lie; };
    return search;
  }
};

Roots make_empty(const Diagonal& diagonal) { return {VectorXd(0), MatrixXd(diagonal.all.size(), 0)}; }

TEST(Roots, CopiesAtTheCutAreCompleted) {
  Diagonal diagonal{VectorXd{{1, 2, 2, 2, 5, 9}}};
  Roots roots = make_empty(diagonal);
  const auto result = search_roots(diagonal.make_search(2), roots);
  EXPECT_EQ(result.cut, 4);
  EXPECT_EQ(result.count, 4);
  EXPECT_FALSE(result.is_missing);
}

/// Hundreds of parts alike: the inertia tells how many, and they come by blocks instead of a few at a time.
TEST(Roots, HundredsOfCopiesTakeFewSolutions) {
  VectorXd all(403);
  all << 1, VectorXd::Constant(400, 2), 5, 9;
  Diagonal diagonal{all};
  Roots roots = make_empty(diagonal);
  const auto result = search_roots(diagonal.make_search(3), roots);
  EXPECT_EQ(result.cut, 401);
  EXPECT_EQ(result.count, 401);
  EXPECT_LE(diagonal.num_solves, 14);
  // Without a count there is no other way to the gap.
  Roots again = make_empty(diagonal);
  RootSearch search = diagonal.make_search(3);
  search.counts = false;
  EXPECT_EQ(search_roots(search, again).cut, 401);
}

TEST(Roots, TheInertiaFindsWhatTheSolverPassedOver) {
  Diagonal diagonal{VectorXd{{1, 2, 3, 4, 5, 9}}, 1};
  Roots roots = make_empty(diagonal);
  const auto result = search_roots(diagonal.make_search(3), roots);
  EXPECT_GE(diagonal.num_solves, 2);
  EXPECT_GE(result.cut, 3);
  EXPECT_EQ(roots.value[1], 2);
  EXPECT_EQ(result.count, result.cut);
}

TEST(Roots, AnInertiaBelowWhatWasFoundIsDoubtful) {
  Diagonal diagonal{VectorXd{{1, 2, 3, 4, 5, 9}}};
  diagonal.lie = -1;
  Roots roots = make_empty(diagonal);
  const auto result = search_roots(diagonal.make_search(3), roots);
  EXPECT_EQ(result.cut, 3);
  EXPECT_EQ(result.count, -1);
  EXPECT_EQ(result.doubtful, 2);
  EXPECT_FALSE(result.is_missing);
}

TEST(Roots, AnInertiaAboveAllThatCanBeFoundIsAMiss) {
  Diagonal diagonal{VectorXd{{1, 2, 3}}};
  diagonal.lie = 1;
  Roots roots = make_empty(diagonal);
  RootSearch search = diagonal.make_search(3);
  search.num_available = 4;  // as far as anyone knows
  EXPECT_TRUE(search_roots(search, roots).is_missing);
  // Where there cannot be more, the inertia is wrong.
  roots = make_empty(diagonal);
  EXPECT_FALSE(search_roots(diagonal.make_search(3), roots).is_missing);
}

TEST(Roots, RootsAreKeptWhereTheMemoryIsTooSmallToCountThem) {
  Diagonal diagonal{VectorXd{{1, 2, 2, 4, 5, 9}}};
  Roots roots = make_empty(diagonal);
  RootSearch search = diagonal.make_search(2);
  search.count = [](double) -> int { throw ComputationError("fe.out-of-memory", {}, "31 GB"); };
  const auto result = search_roots(search, roots);
  EXPECT_EQ(result.cut, 3);
  EXPECT_EQ(result.count, -1);
  EXPECT_EQ(roots.value[2], 2);
  Diagnostics told;
  report_count(result, 0, "modes", true, told);
  ASSERT_EQ(told.items().size(), 1u);
  EXPECT_EQ(told.items()[0].id, "modal.not-counted");
  EXPECT_EQ(told.items()[0].what, "3 modes were found, each with its own residual, but not counted: 31 GB");

  search.count = [](double) -> int { throw ComputationError("fe.factorization", {}, "pivots"); };
  roots = make_empty(diagonal);
  EXPECT_THROW(search_roots(search, roots), ComputationError);
}

}  // namespace
}  // namespace bough::modal::detail
