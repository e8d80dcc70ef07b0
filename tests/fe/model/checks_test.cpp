/// \file Coincident and unused grids, shapes of elements, grounds of the sets.
#include <gtest/gtest.h>

#include <cmath>

#include "fe/matrices/checks.hpp"
#include "fe/matrices/connected_parts.hpp"
#include "fe/matrices/grid_point_weight.hpp"
#include "text_model.hpp"

namespace bough::fe {
namespace {

TEST(ElementQuality, KnownShapes) {
  const auto square = calc_quality("quad4", {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
  EXPECT_NEAR(square.aspect, 2, 1e-15);
  EXPECT_NEAR(square.warp_deg, 0, 1e-12);
  EXPECT_NEAR(square.jacobian, 1, 1e-15);
  // One corner of a unit square raised by h: the corner across keeps its normal, the mean is (-h, -h, 2).
  const double h = 0.1;
  const auto warped = calc_quality("quad4", {{0, 0, 0}, {1, 0, 0}, {1, 1, h}, {0, 1, 0}});
  const Vector3d mean(-h, -h, 2), flat(0, 0, 1);
  EXPECT_NEAR(warped.warp_deg, std::acos(flat.dot(mean) / mean.norm()) * 180 / M_PI, 1e-9);
  // A trapezoid: corner areas in the ratio of its parallel sides.
  EXPECT_NEAR(calc_quality("quad4", {{0, 0, 0}, {2, 0, 0}, {1.5, 1, 0}, {.5, 1, 0}}).jacobian, 0.5, 1e-15);
  EXPECT_LT(calc_quality("quad4", {{0, 0, 0}, {2, 0, 0}, {.2, .2, 0}, {0, 2, 0}}).jacobian, 0);
  EXPECT_NEAR(calc_quality("tri3", {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}).aspect, 5.0 / 3, 1e-15);
  const std::vector<Vector3d> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  EXPECT_NEAR(calc_quality("hexa8", cube).jacobian, 1, 1e-15);
  auto folded = cube;
  folded[6] = {.2, .2, .2};
  EXPECT_LT(calc_quality("hexa8", folded).jacobian, 0);
  EXPECT_NEAR(calc_quality("penta6", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}}).jacobian, 1,
              1e-15);
  EXPECT_LT(calc_quality("tetra4", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}}).jacobian, 0);
}

/// Quadratic shells and shear panels are judged by their corners.
TEST(Checks, QualityOfCurvedShellsAndShearPanels) {
  const test::TextModel m(
      "GRID,1,,0.,0.,0.\nGRID,2,,4.,0.,0.\nGRID,3,,4.,2.,0.\nGRID,4,,0.,2.,0.\nGRID,5,,2.,0.,0.\nGRID,6,,4.,1.,0.\n"
      "GRID,7,,2.,2.,0.\nGRID,8,,0.,1.,0.\nCQUAD8,1,1,1,2,3,4,5,6\n,7,8\nCTRIA6,2,1,1,2,3,5,6\nCSHEAR,3,2,1,2,3,4\n"
      "PSHELL,1,1,.1,1,,1\nPSHEAR,2,1,.1\nMAT1,1,7.+10,,.3\n");
  const auto worst = find_worst_quality(m.model);
  ASSERT_EQ(worst.size(), 3u);
  EXPECT_EQ(worst[0].card, "CQUAD8");
  EXPECT_NEAR(worst[0].worst.aspect, 2, 1e-15);
  EXPECT_EQ(worst[1].card, "CSHEAR");
  EXPECT_EQ(worst[2].card, "CTRIA6");
  EXPECT_NEAR(worst[2].worst.aspect, std::sqrt(20.0) / 2, 1e-15);
}

TEST(Checks, GridsAndGrounds) {
  const test::TextModel m(
      "SPC = 1\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,0.,0.\nGRID,4,,1.,1.,0.\nGRID,5,,9.,1.,0.\n"
      "GRID,6,,0.,5.,0.\nCBAR,1,1,1,2,6\nPBAR,1,1,1.-3,1.-8,1.-8,1.-8\nMAT1,1,7.+10,,.3\nRBE2,7,2,123456,4\n"
      "CELAS2,8,1.+3,2,1,3,1\nSPC1,1,123456,1\n");
  const Model& model = m.model;
  EXPECT_EQ(find_coincident_grids(model, choose_coincidence(model)), (std::vector<std::array<int, 2>>{{2, 3}}));
  EXPECT_EQ(find_unused_grids(model, m.deck), std::vector<int>{5});
  EXPECT_LT(calc_ground_check(model, GroundSet::Global).maxCoeff(), 1e-12);
  EXPECT_LT(calc_ground_check(model, GroundSet::Independent).maxCoeff(), 1e-12);
  // Moving all but the clamp along x stretches the bar.
  EXPECT_GT(calc_ground_check(model, GroundSet::Free)[0], 0.1);
}

TEST(Checks, GridsOfRbe1AndRsplineAreUsed) {
  const test::TextModel m(
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,9.,1.,0.\nCBAR,1,1,1,3,0.,1.,0."
      "\n"
      "PBAR,1,1,1.,1.,1.,1.\nMAT1,1,1.+7,,.3\nRSPLINE,7,.1,1,2,123456,3\nRBE1,8,1,123456,,,,,,+\n+,UM,4,123\n");
  EXPECT_EQ(m.diagnostics.num_errors(), 0);
  EXPECT_EQ(find_unused_grids(m.model, m.deck), std::vector<int>{5});
}

TEST(GridPointWeight, MassesThatActInOneDirectionEach) {
  // 2 along (1, 1, 0)/√2 and 4 along (-1, 1, 0)/√2, both at (3, 0, 0), and 1 along z at (0, 0, 5): S is turned by 45°.
  const double r = std::sqrt(0.5);
  const Vector3d axes[] = {{r, r, 0}, {-r, r, 0}, {0, 0, 1}}, places[] = {{3, 0, 0}, {3, 0, 0}, {0, 0, 5}};
  const double masses[] = {2, 4, 1};
  Eigen::Matrix<double, 6, 6> MO = Eigen::Matrix<double, 6, 6>::Zero();
  for (int i = 0; i < 3; ++i) {
    Eigen::Matrix<double, 6, 1> g;
    g << axes[i], places[i].cross(axes[i]);
    MO += masses[i] * g * g.transpose();
  }
  const auto w = calc_grid_point_weight(MO);
  EXPECT_NEAR((w.S - (Matrix3d() << r, -r, 0, r, r, 0, 0, 0, 1).finished()).norm(), 0, 1e-12);
  EXPECT_NEAR((w.mass - Vector3d(2, 4, 1)).norm(), 0, 1e-12);
  // The first acts along X at Y = -3 r, the second along Y at X = 3 r of the axes S.
  EXPECT_NEAR(w.cg(0, 1), -3 * r, 1e-12);
  EXPECT_NEAR(w.cg(1, 0), 3 * r, 1e-12);
  // About its own centre no mass is left to turn.
  EXPECT_NEAR(w.I_S.norm(), 0, 1e-12);
}

TEST(GridPointWeight, OneBodyHasItsTensor) {
  Matrix3d I;
  I << 5, -.3, .2, -.3, 6, -.7, .2, -.7, 7;
  const double m = 3;
  const Vector3d c(.5, -1, 2);
  Matrix3d C;
  C << 0, -c.z(), c.y(), c.z(), 0, -c.x(), -c.y(), c.x(), 0;
  Eigen::Matrix<double, 6, 6> MO;
  MO << m * Matrix3d::Identity(), -m * C, m * C, I - m * C * C;
  const auto w = calc_grid_point_weight(MO);
  EXPECT_TRUE(w.S.isIdentity(0));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(w.cg(i, j), i == j ? 0 : c[j], 1e-12);
      EXPECT_NEAR(w.I_S(i, j), i == j ? I(i, j) : -I(i, j), 1e-12);
    }
  EXPECT_NEAR((w.Q * w.I_Q.asDiagonal() * w.Q.transpose() - I).norm(), 0, 1e-12);
  EXPECT_NEAR(w.Q.determinant(), 1, 1e-12);
}

TEST(Checks, AnMpcThatGroundsIsFoundOnTheNSet) {
  const test::TextModel m(
      "MPC = 3\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\n"
      "CBAR,2,1,2,3,0.,1.,0.\nPBAR,1,1,1.-3,1.-8,1.-8,1.-8\nMAT1,1,7.+10,,.3\nMPC,3,2,2,1.,1,2,-.5\n");
  EXPECT_LT(calc_ground_check(m.model, GroundSet::Global).maxCoeff(), 1e-12);
  EXPECT_GT(calc_ground_check(m.model, GroundSet::Independent)[1], 1e-3);
}

/// Bars 1-2-3 and 4-5-6 along x, grid 4 on grid 3, grid 1 clamped.
Model build_two_bars(const std::string& more, Diagnostics& d, bool is_free = false) {
  std::string text =
      "SOL 103\nCEND\nSPC=1\nMPC=1\nBEGIN "
      "BULK\nSPC1,1,123456,1\nPBAR,1,1,1.-4,1.-8,1.-8,2.-8\nMAT1,1,7.+10,,.3,2700.\n";
  const double x[] = {0, 1, 2, 2, 3, 4};
  for (int i = 0; i < 6; ++i) text += "GRID," + std::to_string(i + 1) + ",," + std::to_string(x[i]) + ",0.,0.\n";
  for (const int a : {1, 2, 4, 5})
    text += "CBAR," + std::to_string(a) + ",1," + std::to_string(a) + "," + std::to_string(a + 1) + ",0.,1.,0.\n";
  if (more.find("MPC,") == std::string::npos) text.replace(text.find("MPC=1\n"), 6, "");
  const auto deck = nastran::read_deck_text(text + more + "ENDDATA\n", "bars.bdf", {}, d);
  ModelOptions options;
  options.ignore_spc = is_free;
  return build_model(deck, options, d);
}

TEST(ConnectedParts, PartsThatWereNeverMergedAreNamed) {
  for (const bool is_free : {false, true}) {
    Diagnostics d;
    const Model model = build_two_bars("", d, is_free);
    const auto parts = find_connected_parts(model);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].nodes, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(parts[1].nodes, (std::vector<int>{3, 4, 5}));
    EXPECT_EQ(parts[0].num_elements, 2);
    EXPECT_EQ(parts[0].is_held, !is_free);
    EXPECT_FALSE(parts[1].is_held);
    EXPECT_EQ(
        describe_loose_parts(model).what,
        "2 parts; part 2: 3 grids, 2 elements, grids 4 to 6, touches nothing; its grid 4 lies on grid 3 of part 1");
    EXPECT_EQ(count_held_motions(model), is_free ? 0 : 6);
  }
}

// Coincident grids that something joins are no finding, nor are parts that stand on their own supports.
TEST(ConnectedParts, JoinedOrHeldPartsAreNone) {
  for (const char* more :
       {"RBE2,9,3,123456,4\n", "RBE3,9,,4,123456,1.,123456,3\n", "RBAR,9,3,4,123456\n", "MPC,1,3,2,1.,4,2,-1.\n",
        "CELAS2,9,1.+3,3,2,4,2\n", "CBUSH,9,9,3,4,,,,0\nPBUSH,9,K,1.,1.,1.,1.,1.,1.\n"}) {
    Diagnostics d;
    const Model model = build_two_bars(more, d);
    EXPECT_EQ(find_connected_parts(model).size(), 1u) << more;
    EXPECT_EQ(describe_loose_parts(model).what, "") << more;
  }
  for (const char* more : {"SPC1,1,123456,6\n", "CELAS2,9,1.+3,6,2\n"}) {
    Diagnostics d;
    const Model model = build_two_bars(more, d);
    EXPECT_EQ(find_connected_parts(model).size(), 2u) << more;
    EXPECT_EQ(describe_loose_parts(model).what, "") << more;
  }
  Diagnostics d;
  EXPECT_EQ(count_held_motions(build_two_bars("SPC1,1,456,2,THRU,6\n", d, true)), 0);
}

}  // namespace
}  // namespace bough::fe
