/// Modes that are right or refused: loose masses, scalar points, stiff beside soft, the measure of residuals, NORM.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fe/linear/residual.hpp"
#include "formats/nastran/reader.hpp"
#include "modal/normalize.hpp"
#include "modal/roots.hpp"
#include "tests/modal/solve_modes.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

fe::Model build(const std::string& text, Diagnostics& diagnostics) {
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  return fe::build_model(deck, {}, diagnostics);
}

EigenPairs solve(const std::string& text, int number, Diagnostics& diagnostics) {
  return test::solve_modes(build(text, diagnostics), number, diagnostics);
}

EigenPairs solve(const std::string& text, int number) {
  Diagnostics diagnostics;
  return solve(text, number, diagnostics);
}

/// A cantilever of ten bars along x.
std::string make_cantilever(const std::string& more) {
  std::string text =
      "SOL 103\nCEND\nSPC=1\nMETHOD=1\nBEGIN BULK\nSPC1,1,123456,1\nMAT1,1,7.+10,,.3,2700.\n"
      "PBAR,1,1,1.-4,1.-9,2.-9,2.-9\n";
  for (int i = 1; i <= 11; ++i) text += "GRID," + std::to_string(i) + ",," + std::to_string(0.1 * (i - 1)) + ",0.,0.\n";
  for (int i = 1; i <= 10; ++i)
    text += "CBAR," + std::to_string(i) + ",1," + std::to_string(i) + "," + std::to_string(i + 1) + ",0.,1.,0.\n";
  return text + more + "ENDDATA\n";
}

// As Nastran has it: 0 Hz, three times a mass; the modes of the rest stay what they are.
TEST(SoundModes, LooseMassesAreZeroModes) {
  Diagnostics d;
  const auto alone = solve(make_cantilever(""), 4, d);
  const auto pairs = solve(make_cantilever("PARAM,AUTOSPC,NO\nGRID,21,,0.,1.,0.,,456\nGRID,22,,1.,1.,0.,,456\n"
                                           "CONM2,31,21,,1.\nCONM2,32,22,,1.\n"),
                           10, d);
  ASSERT_EQ(pairs.lambda.size(), 10);
  EXPECT_EQ(pairs.num_rigid, 6);
  EXPECT_EQ(pairs.inertia_count, 10);
  EXPECT_EQ(pairs.lambda.head(6).cwiseAbs().maxCoeff(), 0);
  for (int j = 0; j < 4; ++j) EXPECT_NEAR(pairs.lambda(6 + j) / alone.lambda(j), 1, 1e-8);
}

// Its mass comes through an RBE3 to a grid that nothing stiffens: AUTOSPC,NO leaves that free too.
TEST(SoundModes, LooseMassThroughRbe3) {
  const auto pairs = solve(
      "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.,,123456\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.,,456\nGRID,4,,1.,.5,0.\n"
      "CBAR,1,1,1,2,0.,0.,1.\nPBAR,1,1,1.-3,1.-6,1.-6,1.-6\nMAT1,1,7.+10,,.3\nRBE3,9,,4,123,1.,123456,2,3\n"
      "CONM2,11,4,,10.\nPARAM,AUTOSPC,NO\nENDDATA\n",
      10);
  ASSERT_EQ(pairs.lambda.size(), 3);
  EXPECT_EQ(pairs.lambda.cwiseAbs().maxCoeff(), 0);
}

// No grid at all: two masses on two springs to ground, (3 ± √5)/2 k/m; and a chain that nothing holds.
TEST(SoundModes, ScalarPointsAlone) {
  Diagnostics d;
  const auto held = solve(
      "SOL 103\nCEND\nBEGIN BULK\nSPOINT,2,3\nCELAS4,1,100.,0,2\nCELAS4,2,100.,2,3\nCMASS4,12,1.,2\nCMASS4,13,1.,3\n"
      "ENDDATA\n",
      5, d);
  ASSERT_EQ(held.lambda.size(), 2);
  EXPECT_NEAR(held.lambda(0), 50 * (3 - std::sqrt(5)), 1e-10);
  EXPECT_NEAR(held.lambda(1), 50 * (3 + std::sqrt(5)), 1e-10);
  const auto free =
      solve("SOL 103\nCEND\nBEGIN BULK\nCELAS4,2,100.,2,3\nCMASS4,12,1.,2\nCMASS4,13,1.,3\nENDDATA\n", 5, d);
  ASSERT_EQ(free.lambda.size(), 2);
  EXPECT_EQ(free.num_rigid, 1);
  EXPECT_NEAR(free.lambda(1), 200, 1e-9);
  const auto one =
      solve("SOL 103\nCEND\nBEGIN BULK\nCELAS4,1,398000.,1,8\nPMASS,2,11.11\nCMASS1,2,2,1\nENDDATA\n", 5, d);
  ASSERT_EQ(one.lambda.size(), 1);
  EXPECT_EQ(one.lambda(0), 0);
}

// A bar a thousand times as stiff as one that is rigid already, askew at the tip: not a rigid motion, and the modes
// stay within the digits that are left.
TEST(SoundModes, StiffArmAtTheTip) {
  const auto make = [](const std::string& E) {
    return make_cantilever("GRID,50,,1.23,.11,-.14\nCONM2,90,50,,1.7\n,.02,.001,.03,-.002,.0015,.04\nMAT1,9," + E +
                           ",,.3,0.\nPBAR,9,9,1.,.1,.1,.2\nCBAR,91,9,11,50,1.,0.,0.\n");
  };
  Diagnostics d;
  const auto soft = solve(make("7.+10"), 6, d), stiff = solve(make("7.+13"), 6, d);
  ASSERT_EQ(stiff.lambda.size(), 6);
  EXPECT_EQ(stiff.num_rigid, 0);
  for (int j = 0; j < 6; ++j) EXPECT_NEAR(stiff.lambda(j) / soft.lambda(j), 1, 1e-2) << j;
  EXPECT_LT(stiff.residual.maxCoeff(), 1e-8);
}

// A free bar of two grids with lumped mass turns about itself without mass; the other motions have no residual.
TEST(SoundModes, RigidMotionsOfAHeldMasslessTurn) {
  Diagnostics d;
  const auto pairs = solve(
      "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,-29.89,-45.164,1.9658\nGRID,2,,-45.13,-48.497,-1.5894\n"
      "MAT1,1,1.188+7,,.33,.07476\nPBAR,1,1,19.045,8.815,50.79,14.32\nCBAR,1,1,1,2,.1258,-.9557,.2662\n"
      "ENDDATA\n",
      6, d);
  ASSERT_EQ(pairs.lambda.size(), 6);
  EXPECT_EQ(pairs.num_rigid, 5);
  EXPECT_LT(pairs.residual.maxCoeff(), 1e-8);
  // Two half masses on the bar: ω² = EA/L (2/m), m = ρAL/2.
  const double L = Eigen::Vector3d(15.24, 3.333, 3.5552).norm();
  EXPECT_NEAR(pairs.lambda(5), 4 * 1.188e7 / (0.07476 * L * L), 1e-6 * pairs.lambda(5));
}

// diag(1, 4) x = λ x: exact pairs have none, a vector off by δ has δ times how far λ is from the other root.
TEST(Residual, IsThePartOfTheForceThatIsNotBalanced) {
  const VectorXd K = (VectorXd(2) << 1, 4).finished(), M = VectorXd::Ones(2);
  const double delta = 1e-6;
  const MatrixXd X = (MatrixXd(2, 2) << 1, 1, 0, delta).finished();
  const VectorXd lambda = VectorXd::Ones(2);
  const auto r = linear::calc_residuals(linear::calc_residual_scale(K, M, lambda), X, K.asDiagonal() * X,
                                        M.asDiagonal() * X * lambda.asDiagonal());
  EXPECT_EQ(r(0), 0);
  EXPECT_NEAR(r(1), 3 * delta * std::sqrt(2. / 5.), 1e-5 * delta);
  // Units, and a stiff dof beside, change nothing.
  const auto big = linear::calc_residuals(1e9 * linear::calc_residual_scale(K, M, lambda), X,
                                          1e9 * (K.asDiagonal() * X).eval(), 1e9 * (M.asDiagonal() * X).eval());
  EXPECT_NEAR(big(1), r(1), 1e-12);
}

TEST(Residual, WarnsThenRefuses) {
  Diagnostics d;
  linear::check_residuals(VectorXd::Constant(2, 1e-9), "mode", d);
  EXPECT_TRUE(d.items().empty());
  linear::check_residuals((VectorXd(2) << 0, 1e-7).finished(), "mode", d);
  EXPECT_TRUE(d.has("fe.residual"));
  const auto refuses = [&](double value) {
    try {
      linear::check_residuals((VectorXd(2) << value, 0).finished(), "mode", d);
    } catch (const ComputationError& error) {
      return std::string(error.what()).find("mode 1") != std::string::npos && error.exit_code() == 3;
    }
    return false;
  };
  EXPECT_TRUE(refuses(1e-4));
  EXPECT_TRUE(refuses(std::nan("")));
}

/// Roots 1, 2, ... n behind a count that may lie.
struct FakeRoots {
  int size, found_at_once;
  std::function<int(double)> count;

  modal::detail::RootSearchResult run(int wanted, modal::detail::Roots& roots) const {
    modal::detail::RootSearch search;
    search.requested = wanted;
    search.num_available = size;
    search.solve = [this](modal::detail::Roots& known, int number) {
      const int more = std::min({number, found_at_once, size - known.size()});
      known.add(VectorXd::LinSpaced(more, known.size() + 1, known.size() + more), MatrixXd::Zero(1, more));
    };
    search.closeness = [](const modal::detail::Roots&, int) { return 1e-8; };
    search.roundoff = [](const modal::detail::Roots&, int) { return 0.; };
    search.count = count;
    roots = {VectorXd(0), MatrixXd(1, 0)};
    return modal::detail::search_roots(search, roots);
  }
};

TEST(RootSearch, CountsAndDoubts) {
  modal::detail::Roots roots;
  const auto honest = [](double mu) { return static_cast<int>(mu); };
  auto result = FakeRoots{20, 3, honest}.run(7, roots);
  EXPECT_EQ(result.cut, 7);
  EXPECT_EQ(result.count, 7);
  // Asked for more than there are.
  result = FakeRoots{5, 3, [](double mu) { return std::min(5, static_cast<int>(mu)); }}.run(9, roots);
  EXPECT_EQ(result.cut, 5);
  EXPECT_FALSE(result.is_missing);
  // A count short of what was found is wrong; one above it is a root that was missed.
  result = FakeRoots{20, 3, [&](double mu) { return honest(mu) - 1; }}.run(7, roots);
  EXPECT_EQ(result.count, -1);
  EXPECT_EQ(result.doubtful, 6);
  EXPECT_FALSE(result.is_missing);
  result = FakeRoots{20, 3, [&](double mu) { return honest(mu) + 1; }}.run(7, roots);
  EXPECT_TRUE(result.is_missing);
  // More than exist: the count is wrong.
  result = FakeRoots{8, 8, [&](double mu) { return honest(mu) + 2; }}.run(8, roots);
  EXPECT_FALSE(result.is_missing);
  EXPECT_EQ(result.cut, 8);
  EXPECT_EQ(result.doubtful, 10);
  // The count just above the last root is short by roundoff, further up it is right.
  result = FakeRoots{20, 3, [&](double mu) { return mu < 7.05 ? 6 : honest(mu); }}.run(7, roots);
  EXPECT_EQ(result.count, 7);
}

TEST(RootSearch, SaysWhatTheCountIsWorth) {
  Diagnostics d;
  modal::detail::RootSearchResult result;
  result.cut = result.count = 6;
  modal::detail::report_count(result, 2, "modes", true, d);
  EXPECT_TRUE(d.items().empty());
  result.count = -1;
  result.doubtful = 5;
  modal::detail::report_count(result, 2, "modes", false, d);
  EXPECT_TRUE(d.items().empty());
  modal::detail::report_count(result, 2, "modes", true, d);
  ASSERT_TRUE(d.has("modal.uncertain-count"));
  EXPECT_NE(d.items().front().what.find("8 modes were found"), std::string::npos);
  EXPECT_NE(d.items().front().what.find("counts 7"), std::string::npos);
  result.is_missing = true;
  EXPECT_THROW(modal::detail::report_count(result, 2, "modes", true, d), ComputationError);
}

TEST(Normalize, LargestComponentOrOnePointIsOne) {
  Diagnostics d;
  const auto model = build(make_cantilever("SPC1,1,2456,2,THRU,11\n"), d);
  EigenOptions options;
  options.num_modes = 3;
  const auto pairs = calc_normal_modes(model, options, d);
  MatrixXd largest = pairs.Phi, point = pairs.Phi;
  modal::normalize(model, {"MAX", 0, 0}, largest, d);
  modal::normalize(model, {"POINT", 6, 3}, point, d);
  const auto row = model.node(model.find_node(6)).first_gdof + 2;
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(largest.col(j).cwiseAbs().maxCoeff(), 1, 1e-12);
    EXPECT_NEAR(largest.col(j).maxCoeff(), 1, 1e-12);
    EXPECT_NEAR(point(row, j), 1, 1e-12);
  }
  EXPECT_FALSE(d.has("modal.norm-point"));
  modal::normalize(model, {"POINT", 6, 2}, point, d);  // held
  EXPECT_TRUE(d.has("modal.norm-point"));
  MatrixXd mass = pairs.Phi;
  modal::normalize(model, {"MASS", 0, 0}, mass, d);
  EXPECT_EQ(mass, pairs.Phi);
}

}  // namespace
}  // namespace bough
