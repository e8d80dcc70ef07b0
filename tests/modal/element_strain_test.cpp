/// Soft parts beside stiff ones, past what the sums in K can hold: closed forms, limits, and Jacobi's rotations.
#include <gtest/gtest.h>

#include <cmath>

#include "formats/nastran/reader.hpp"
#include "modal/element_strain.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

modal::EigenPairs solve_deck(const std::string& bulk, int number, Diagnostics& diagnostics) {
  const auto deck =
      nastran::read_deck_text("SOL 103\nCEND\nBEGIN BULK\n" + bulk + "ENDDATA\n", "deck.bdf", {}, diagnostics);
  const auto model = fe::build_model(deck, {}, diagnostics);
  modal::EigenOptions options;
  options.num_modes = number;
  return calc_normal_modes(model, options, diagnostics);
}

std::string write_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1E", value);
  return text;
}

/// Unit masses on a chain of springs from ground.
std::string make_chain(const std::vector<double>& stiffness) {
  std::string bulk = "SPOINT,1,THRU," + std::to_string(stiffness.size()) + "\n";
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    const auto id = std::to_string(i + 1);
    bulk += "CELAS4," + id + "," + write_number(stiffness[i]) + "," + std::to_string(i) + "," + id + "\n";
    bulk += "CMASS4," + std::to_string(i + 101) + ",1.," + id + "\n";
  }
  return bulk;
}

// Ground - 1 - m - k - m: λ² - (1 + 2 k) λ + k = 0. From 1e16 on 1 + k is k.
TEST(ElementStrain, TwoSpringsInLine) {
  for (const double k : {1e8, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16}) {
    Diagnostics d;
    const auto pairs = solve_deck(make_chain({1, k}), 2, d);
    ASSERT_EQ(pairs.lambda.size(), 2) << k;
    const double high = (1 + 2 * k + std::sqrt(1 + 4 * k * k)) / 2;
    EXPECT_EQ(pairs.num_rigid, 0) << k;
    // Below 1e-6 the roundoff of K is left as it is; it depends on the number of ranks.
    EXPECT_NEAR(pairs.lambda(0) / (k / high), 1, d.has("modal.lost-digits") ? 1e-10 : 1e-6) << k;
    EXPECT_NEAR(pairs.lambda(1) / high, 1, 1e-10) << k;
    EXPECT_TRUE(k < 1e13 || d.has("modal.lost-digits")) << k;
  }
}

// A stiff spring among soft ones is a rigid link but for 1e-14: one asked for, or all.
TEST(ElementStrain, AsManySoftModesAsItTakes) {
  Diagnostics d;
  const auto chain = make_chain({1, 2, 1e14, 1, 3, 1});
  // Masses 2 and 3 in one.
  const auto rigid = solve_deck(
      "SPOINT,1,THRU,5\nCELAS4,1,1.,0,1\nCELAS4,2,2.,1,2\nCELAS4,3,1.,2,3\nCELAS4,4,3.,3,4\nCELAS4,5,1.,4,5\n"
      "CMASS4,11,1.,1\nCMASS4,12,2.,2\nCMASS4,13,1.,3\nCMASS4,14,1.,4\nCMASS4,15,1.,5\n",
      5, d);
  ASSERT_EQ(rigid.lambda.size(), 5);
  EXPECT_FALSE(d.has("modal.lost-digits"));
  for (const int number : {1, 2, 3, 6}) {
    Diagnostics said;
    const auto pairs = solve_deck(chain, number, said);
    ASSERT_EQ(pairs.lambda.size(), number);
    for (int j = 0; j < std::min(number, 5); ++j)
      EXPECT_NEAR(pairs.lambda(j) / rigid.lambda(j), 1, 1e-9) << number << " " << j;
    EXPECT_LT(pairs.residual.maxCoeff(), 1e-5);
    EXPECT_NEAR((pairs.Phi.transpose() * pairs.Phi - MatrixXd::Identity(number, number)).cwiseAbs().maxCoeff(), 0,
                1e-9);
  }
}

// A bar at the tip of ten others, as stiff as one likes: the modes go to those of a rigid one.
TEST(ElementStrain, StiffBarAtTheTip) {
  const auto make = [](const std::string& E) {
    std::string bulk = "SPC1,1,123456,1\nMAT1,1,7.+10,,.3,2700.\nPBAR,1,1,1.-3,1.-6,1.-6,1.-6\n";
    for (int i = 1; i <= 11; ++i)
      bulk += "GRID," + std::to_string(i) + ",," + std::to_string(0.1 * (i - 1)) + ",0.,0.,," +
              (i == 1 ? "123456" : "") + "\n";
    for (int i = 1; i <= 10; ++i)
      bulk += "CBAR," + std::to_string(i) + ",1," + std::to_string(i) + "," + std::to_string(i + 1) + ",0.,0.,1.\n";
    return bulk + "GRID,50,,1.23,.11,-.14\nCONM2,90,50,,1.7\n,.02,.001,.03,-.002,.0015,.04\nMAT1,9," + E +
           ",,.3,0.\nPBAR,9,9,1.,.1,.1,.2\nCBAR,91,9,11,50,1.,0.,0.\n";
  };
  Diagnostics d;
  const auto rigid = solve_deck(make("7.+10").substr(0, make("7.+10").find("MAT1,9")) + "RBE2,91,11,123456,50\n", 5, d);
  for (const auto* E : {"7.+14", "7.+15", "7.+16", "7.+17"}) {
    Diagnostics said;
    const auto pairs = solve_deck(make(E), 5, said);
    ASSERT_EQ(pairs.lambda.size(), 5) << E;
    for (int j = 0; j < 5; ++j) EXPECT_NEAR(pairs.lambda(j) / rigid.lambda(j), 1, 1e-8) << E << " " << j;
  }
}

// A free chain keeps its 0 Hz mode next to a soft mode whose stiffness is round-off in K.
TEST(ElementStrain, ZerosStayZeros) {
  Diagnostics d;
  const auto pairs = solve_deck(
      "SPOINT,1,THRU,3\nCELAS4,1,1.,1,2\nCELAS4,2,1.+15,2,3\nCMASS4,11,1.,1\nCMASS4,12,1.,2\nCMASS4,13,1.,3\n", 3, d);
  ASSERT_EQ(pairs.lambda.size(), 3);
  EXPECT_EQ(pairs.num_rigid, 1);
  EXPECT_EQ(pairs.lambda(0), 0);
  EXPECT_NEAR(pairs.lambda(1), 1.5, 1e-9);  // 1 (1 / m + 1 / 2 m)
}

// diag(s) A diag(s): the product of the eigenvalues is the determinant, each follows its own scale.
TEST(ElementStrain, GradedEigenvalues) {
  MatrixXd A(3, 3);
  A << 2, 1, 0.5, 1, 3, 1, 0.5, 1, 4;
  const VectorXd s = VectorXd::Map(std::array<double, 3>{1e-9, 1, 1e8}.data(), 3);
  MatrixXd V;
  const VectorXd lambda = modal::detail::calc_graded_eigenvalues(s.asDiagonal() * A * s.asDiagonal(), V);
  // Ascending Schur complements, right to (s_i / s_k)².
  const double last = 4 * 1e16, middle = 3 - 1.0 / 4, first = A.determinant() / (3 * 4 - 1) * 1e-18;
  EXPECT_NEAR(lambda(2) / last, 1, 1e-14);
  EXPECT_NEAR(lambda(1) / middle, 1, 1e-14);
  EXPECT_NEAR(lambda(0) / first, 1, 1e-14);
  EXPECT_NEAR((V.transpose() * V - MatrixXd::Identity(3, 3)).cwiseAbs().maxCoeff(), 0, 1e-14);
}

}  // namespace
}  // namespace bough
