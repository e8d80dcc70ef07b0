/// Motions without strain that are none of the whole, with mass, with next to none, with none; ends of ranges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "formats/nastran/reader.hpp"
#include "modal/extraction.hpp"
#include "modal/mode_range.hpp"
#include "modal/null_motions.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

using modal::detail::ModeRange;

fe::Model build(const std::string& text) {
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  return fe::build_model(deck, {}, diagnostics);
}

EigenPairs solve(const std::string& text, const EigenOptions& options, Diagnostics& diagnostics) {
  const auto model = build(text);
  return calc_normal_modes(model, options, diagnostics);
}

EigenPairs solve(const std::string& text, int number) {
  EigenOptions options;
  options.num_modes = number;
  Diagnostics diagnostics;
  return solve(text, options, diagnostics);
}

/// A free tetrahedron of rods. One of them has torsion: AUTOSPC leaves a rotation at each of its ends, and it spins.
std::string make_truss(const std::string& more, const std::string& control = "") {
  std::string text = "SOL 103\nCEND\n" + control +
                     "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,.2,.1\nGRID,3,,.3,1.1,-.2\nGRID,4,,.4,.3,.9\n"
                     "MAT1,1,7.+10,,.3,2700.\nPROD,1,1,1.-3\nPROD,2,1,1.-3,1.-6\nCROD,1,2,1,2\n";
  int id = 1;
  for (const char* ends : {"1,3", "1,4", "2,3", "2,4", "3,4"})
    text += "CROD," + std::to_string(++id) + ",1," + ends + "\n";
  return text + more + "ENDDATA\n";
}

/// The six modes with strain of the truss without that rotation at all.
VectorXd calc_strained(const std::string& more) {
  const auto pairs = solve(make_truss("PARAM,AUTOSPC,NO\nSPC1,1,456,1,2,3,4\n" + more, "SPC=1\n"), 12);
  EXPECT_EQ(pairs.num_rigid, 6);
  return pairs.lambda.tail(6);
}

TEST(NullMotions, ARodSpinsWithoutMass) {
  const auto pairs = solve(make_truss(""), 12);
  ASSERT_EQ(pairs.lambda.size(), 12);
  EXPECT_EQ(pairs.num_rigid, 6);
  EXPECT_LT(pairs.residual.maxCoeff(), 1e-8);
  const VectorXd expected = calc_strained("");
  for (int j = 0; j < 6; ++j) EXPECT_NEAR(pairs.lambda(6 + j) / expected(j), 1, 1e-9) << j;
}

// Nothing but the spin is free: all that has no strain has no mass either.
TEST(NullMotions, ARodSpinsInAHeldTruss) {
  const auto with = [](const std::string& more) {
    return solve(make_truss("SPC1,1,123,1,2,3\n" + more, "SPC=1\n"), 5);
  };
  const auto pairs = with(""), expected = with("SPC1,1,456,1,2,3,4\n");
  ASSERT_EQ(pairs.lambda.size(), 3);
  ASSERT_EQ(expected.lambda.size(), 3);
  EXPECT_EQ(pairs.num_rigid, 0);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(pairs.lambda(j) / expected.lambda(j), 1, 1e-9) << j;
}

TEST(NullMotions, ARodSpinsWithNextToNoMass) {
  for (const char* inertia : {"1.-9", "1.-12", "1.-15"}) {
    const std::string i = inertia, mass = "CONM2,9,1,,.5\n,";
    const auto pairs = solve(make_truss(mass + i + ",," + i + ",,," + i + "\n"), 13);
    ASSERT_EQ(pairs.lambda.size(), 13) << i;
    EXPECT_EQ(pairs.num_rigid, 7) << i;
    EXPECT_LT(pairs.residual.maxCoeff(), 1e-8) << i;
    const VectorXd expected = calc_strained("CONM2,9,1,,.5\n");
    for (int j = 0; j < 6; ++j) EXPECT_NEAR(pairs.lambda(7 + j) / expected(j), 1, 1e-8) << i << " mode " << j;
  }
}

// So little that 0 Hz of the spin would be vague by more than the other modes: not among them.
TEST(NullMotions, MassInRoundoffIsNone) {
  const auto pairs = solve(make_truss("CONM2,9,1,,.5\n,1.-21,,1.-21,,,1.-21\n"), 12);
  ASSERT_EQ(pairs.lambda.size(), 12);
  EXPECT_EQ(pairs.num_rigid, 6);
  const VectorXd expected = calc_strained("CONM2,9,1,,.5\n");
  for (int j = 0; j < 6; ++j) EXPECT_NEAR(pairs.lambda(6 + j) / expected(j), 1, 1e-8) << j;
}

TEST(NullMotions, BasisAndSupports) {
  modal::detail::initialize_slepc();
  const auto model =
      build(make_truss("CONM2,9,1,,.5\n,1.-12,,1.-12,,,1.-12\nSPOINT,50,51\nCMASS4,60,3.,50\n"
                       "CELAS4,61,7.+7,50,51\n"));
  const fe::System system(model);
  const modal::detail::Pencil pencil(system);
  const auto found = modal::detail::find_null_motions(pencil);
  ASSERT_EQ(found.modes.cols(), 8);  // six, the spin, the scalar points
  EXPECT_EQ(found.massless.cols(), 0);
  const MatrixXd G = found.modes.transpose() * pencil.calc_M_times(found.modes);
  EXPECT_LT((G - MatrixXd::Identity(8, 8)).cwiseAbs().maxCoeff(), 1e-10);
  const VectorXd root = pencil.K_diagonal.cwiseSqrt();
  const MatrixXd force = root.cwiseInverse().asDiagonal() * pencil.calc_K_times(found.modes);
  for (int j = 0; j < 8; ++j)
    EXPECT_LT(force.col(j).norm(), 1e-13 * (root.asDiagonal() * found.modes.col(j)).norm()) << j;
  // The six of the whole come first, as they are without the others.
  const auto whole = modal::detail::find_rigid_motions(pencil);
  ASSERT_EQ(whole.modes.cols(), 6);
  EXPECT_LT((whole.modes - found.modes.leftCols(6)).cwiseAbs().maxCoeff(), 1e-6 * whole.modes.cwiseAbs().maxCoeff());
  ASSERT_EQ(found.supports.size(), 8u);
  MatrixXd at_supports = found.modes(found.supports, Eigen::all);
  const VectorXd norms = at_supports.colwise().norm().transpose();
  at_supports *= norms.cwiseInverse().asDiagonal();
  EXPECT_GT(Eigen::JacobiSVD<MatrixXd>(at_supports).singularValues().minCoeff(), 1e-3);
}

/// A line of free bars with lumped masses: it spins about itself without mass.
std::string make_line(int first, int num, double x, double y, double z, double length) {
  std::string text;
  for (int i = 0; i < num; ++i)
    text += "GRID," + std::to_string(first + i) + ",," + std::to_string(x + i * length) + "," + std::to_string(y) +
            "," + std::to_string(z) + "\n";
  for (int i = 0; i + 1 < num; ++i)
    text += "CBAR," + std::to_string(first + i) + ",1," + std::to_string(first + i) + "," +
            std::to_string(first + i + 1) + ",.3,.2,1.\n";
  return text;
}

TEST(NullMotions, TwoLinesSpinEachByItself) {
  const std::string head = "SOL 103\nCEND\nBEGIN BULK\nPBAR,1,1,1.-4,1.-8,2.-8,2.-8\nMAT1,1,7.+10,,.3,2700.\n";
  const auto first = make_line(1, 5, -2.838848, -2.263246, -1.077986, 1.062292);
  const auto second = make_line(101, 4, 1.128933, -1.763154, -1.406437, 1.256237);
  std::vector<double> expected(10, 0.0);
  for (const auto& line : {first, second}) {
    const auto alone = solve(head + line + "ENDDATA\n", 9);
    ASSERT_EQ(alone.num_rigid, 5);
    for (Eigen::Index j = 5; j < alone.lambda.size(); ++j) expected.push_back(alone.lambda[j]);
  }
  std::sort(expected.begin(), expected.end());
  for (const int number : {11, 13, 16}) {
    const auto both = solve(head + first + second + "ENDDATA\n", number);
    ASSERT_EQ(both.lambda.size(), number);
    EXPECT_EQ(both.num_rigid, 10);
    EXPECT_EQ(both.num_massless, 2);
    for (int j = 10; j < number; ++j) EXPECT_NEAR(both.lambda[j] / expected[static_cast<std::size_t>(j)], 1, 1e-9) << j;
  }
}

// A free bar along an oblique line, far from the origin, with next to no inertia about itself: its motions are
// orthonormal to the last digits all the same.
TEST(NullMotions, ZeroModesAreOrthonormal) {
  modal::detail::initialize_slepc();
  const auto model = build(
      "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,31.3,-17.1,12.7\nGRID,2,,32.1,-16.4,13.9\nGRID,3,,32.9,-15.7,15.1\n"
      "MAT1,1,7.+10,,.3\nPBAR,1,1,1.-4,1.-8,1.-8,2.-8\nCBAR,1,1,1,2,0.,1.,0.\nCBAR,2,1,2,3,0.,1.,0.\n"
      "CONM2,4,1,,2.\n,1.-11,,1.-11,,,1.-11\nCONM2,5,2,,3.\n,1.-11,,1.-11,,,1.-11\nCONM2,6,3,,1.\n"
      ",1.-11,,1.-11,,,1.-11\nENDDATA\n");
  const fe::System system(model);
  const modal::detail::Pencil pencil(system);
  for (const auto& found : {modal::detail::find_rigid_motions(pencil), modal::detail::find_null_motions(pencil)}) {
    const auto num = found.modes.cols();
    ASSERT_GE(num, 5);  // the spin about itself may be next to nothing
    const MatrixXd G = found.modes.transpose() * pencil.calc_M_times(found.modes);
    EXPECT_LT((G - MatrixXd::Identity(num, num)).cwiseAbs().maxCoeff(), 1e-11);
  }
}

// Point masses on a massless cantilever, one of them on a spring a hundred million times as soft: M of low rank, and
// the stiff modes keep their digits beside the soft one.
TEST(LowRank, KeepsTheDigitsOfHighModes) {
  const auto make = [](const std::string& k) {
    return "SOL 103\nCEND\nBEGIN BULK\nSPOINT,1,2,3,4\nCELAS4,1,1.+9,0,1\nCELAS4,2,1.+9,1,2\nCELAS4,3," + k +
           ",2,3\nCELAS4,4,1.+9,3,4\nCMASS4,11,1.,1\nCMASS4,12,1.,2\nCMASS4,13,1.,3\nCMASS4,14,1.,4\nENDDATA\n";
  };
  for (const double k : {1e-1, 1e-3}) {
    const auto pairs = solve(make(k == 1e-1 ? ".1" : ".001"), 4);
    ASSERT_EQ(pairs.lambda.size(), 4);
    // To first order in k: two masses on a soft spring; then two springs in a row to ground, and the free pair.
    EXPECT_NEAR(pairs.lambda(0) / (k / 2), 1, 1e-6 / k) << k;  // K has roundoff of 1e-7
    EXPECT_NEAR(pairs.lambda(1) / (1e9 * (3 - std::sqrt(5)) / 2), 1, 1e-9) << k;
    EXPECT_NEAR(pairs.lambda(2) / 2e9, 1, 1e-9) << k;
    EXPECT_NEAR(pairs.lambda(3) / (1e9 * (3 + std::sqrt(5)) / 2), 1, 1e-9) << k;
    EXPECT_LT(pairs.residual.maxCoeff(), 1e-8) << k;
  }
}

VectorXd make_lambda(std::initializer_list<double> hz) {
  VectorXd lambda(static_cast<Eigen::Index>(hz.size()));
  int i = 0;
  for (const double f : hz) lambda(i++) = modal::detail::calc_lambda(f);
  return lambda;
}

TEST(ModeRange, TheRootsDecideNotTheGuess) {
  const VectorXd lambda = make_lambda({0, 0, 3, 5, 8, 13});
  EigenOptions options;
  options.num_modes = 0;
  options.min_hz = 2;
  options.max_hz = 10;
  ModeRange range{4, 9};  // the inertia counted two too many
  EXPECT_FALSE(range.fit(options, lambda, 6, 20));
  EXPECT_EQ(range.first, 2);
  EXPECT_EQ(range.last, 5);
  // Complete up to 5 Hz only, and the next one is inside: more of them have to be found.
  EXPECT_TRUE(range.fit(options, lambda, 4, 20));
  EXPECT_GT(range.last, 4);
  // A number of modes from V1 on, more than the list holds.
  options = {};
  options.num_modes = 4;
  options.min_hz = 4;
  range = {};
  EXPECT_TRUE(range.fit(options, lambda, 6, 20));
  EXPECT_EQ(range.first, 3);
  EXPECT_EQ(range.last, 7);
  // No more than six exist.
  EXPECT_FALSE(range.fit(options, lambda, 6, 6));
  EXPECT_EQ(range.last, 6);
  // Nothing inside.
  options.num_modes = 0;
  options.min_hz = 9;
  options.max_hz = 10;
  EXPECT_FALSE(range.fit(options, lambda, 6, 20));
  EXPECT_TRUE(range.is_empty());
  // Without limits it stays what it was.
  range = {0, 3};
  EXPECT_FALSE(range.fit(EigenOptions{}, lambda, 6, 20));
  EXPECT_EQ(range.last, 3);
}

// The spin with next to no mass makes the inertia of K - λM vague; the ends of the range do not care.
TEST(ModeRange, OfATrussWithASpinningRod) {
  const VectorXd expected = calc_strained("CONM2,9,1,,.5\n");
  EigenOptions options;
  options.num_modes = 0;
  const auto hz = [&](int j) { return std::sqrt(expected(j)) / 6.283185307179586; };
  options.min_hz = 0.5 * (hz(0) + hz(1));
  options.max_hz = 0.5 * (hz(3) + hz(4));
  Diagnostics diagnostics;
  const auto pairs = solve(make_truss("CONM2,9,1,,.5\n,1.-15,,1.-15,,,1.-15\n"), options, diagnostics);
  ASSERT_EQ(pairs.lambda.size(), 3);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(pairs.lambda(j) / expected(1 + j), 1, 1e-8) << j;
}

}  // namespace
}  // namespace bough
