/// Large displacements of grids that follow the mean of others (RBE3): against rigid elements, stiff bars and rotated
/// structures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/rotation.hpp"
#include "fe/statics/case_solver.hpp"
#include "formats/nastran/reader.hpp"
#include "tests/fe/model/one_process.hpp"
#include "tests/fe/model/text_model.hpp"

namespace bough::fe {
namespace {

using test::kHead;

class LargeDisplacementMeans : public test::OneProcess {};

struct Answer {
  records::StaticSubcase result;
  Diagnostics diagnostics;
};

Answer solve(const std::string& text) {
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  CaseSolver solver(deck, {});
  solver.ask_nonlinear({10}, true);
  const auto subcases = choose_static_subcases(deck, 0);
  auto [result, failure, found] = std::move(solver.solve_next(subcases).front());
  if (failure) std::rethrow_exception(failure);
  return {std::move(*result), std::move(found)};
}

/// Displacement and rotation vector of a node.
Eigen::Matrix<double, 6, 1> get_motion(const Answer& answer, int node) {
  return answer.result.displacement.segment<6>(6 * node);
}

/// A cantilever of 6 bars and unit length along x, with more on its end, grid 7.
std::string write_bars(const std::string& more, const std::string& held = "SPC1,1,123456,1\n") {
  std::string text = std::string(kHead) + "MAT1,1,1.+9,,0.\nPBAR,1,1,1.,1.-5,2.-5,1.5-5\n" + held;
  for (int k = 0; k <= 6; ++k) text += fmt::format("GRID,{},,{:.9g},0.,0.\n", k + 1, k / 6.0);
  for (int k = 1; k <= 6; ++k) text += fmt::format("CBAR,{},1,{},{},0.,1.,.3\n", k, k, k + 1);
  return text + more + "ENDDATA\n";
}

const std::string kForkGrids =
    "GRID,21,,1.1,.3,.2\nGRID,22,,1.,-.3,.2\nGRID,23,,.9,.1,-.3\nGRID,40,,1.2,.25,-.1\nGRID,41,,1.4,.1,.2\n";
/// On the reference grid and on an arm there: forces and a moment about a fixed axis.
const std::string kLoads = "FORCE,1,40,,9000.,.3,.5,1.\nFORCE,1,41,,7000.,-.4,.9,.2\n";
const std::string kMoment = "MOMENT,1,41,,2000.,.2,-.6,.4\n";

/// The mean of grids of one rigid body moves with it: chains of RBE2, RBE3, RBE3 and RBE2, against one RBE2.
TEST_F(LargeDisplacementMeans, OfARigidBodyIsARigidBody) {
  const std::string rigid = kForkGrids + "GRID,50,,1.3,-.2,.1\nRBE2,31,7,123456,21,22,23,40,41\n,50\n";
  const std::string chain = kForkGrids +
                            "GRID,50,,1.3,-.2,.1\nRBE2,31,7,123456,21,22,23\n"
                            "RBE3,32,,50,123456,1.,123456,21,2.\n,123,22,.7,123,23\n"
                            "RBE3,33,,40,123456,1.,123,21,22\n,50\nRBE2,34,40,123456,41\n";
  for (const auto& loads : {kLoads, kLoads + kMoment}) {
    const auto one = solve(write_bars(rigid + loads)), other = solve(write_bars(chain + loads));
    EXPECT_GT(get_motion(one, 6).head<3>().norm(), 0.4);
    EXPECT_GT(get_motion(one, 6).tail<3>().norm(), 0.7);
    for (int k = 0; k < 13; ++k) EXPECT_LT((get_motion(one, k) - get_motion(other, k)).norm(), 1e-9) << k;
    EXPECT_LT((one.result.reaction - other.result.reaction).norm(), 1e-7 * one.result.reaction.norm());
    EXPECT_LT((other.result.load_resultant + other.result.reaction_resultant).norm(), 1e-6 * 1e4);
    EXPECT_LT(other.result.mpc_resultant.norm(), 1e-6 * 1e4);
    EXPECT_TRUE(other.diagnostics.items().empty());
  }
}

/// A reference grid of translations alone turns by itself: a bar on it is hinged.
TEST_F(LargeDisplacementMeans, OfTranslationsAloneIsAHinge) {
  const auto write = [](const std::string& tie) {
    return write_bars(
        "GRID,21,,1.,.3,0.\nGRID,22,,1.,-.3,0.\nGRID,23,,1.,0.,.3\nGRID,40,,1.,0.1,.1\nGRID,41,,1.4,.1,.1\n"
        "GRID,42,,1.8,.1,.1\nCBAR,43,1,40,41,0.,1.,.3\nCBAR,44,1,41,42,0.,1.,.3\nSPC1,1,234,42\n" +
        tie + "FORCE,1,41,,9000.,-.2,.7,.6\nFORCE,1,7,,9000.,.2,.7,.8\n");
  };
  const auto mean = solve(write("RBE2,31,7,123456,21,22,23\nRBE3,33,,40,123,1.,123456,21,22\n,23\n"));
  const auto rigid = solve(write("RBE2,31,7,123456,21,22,23\nRBE2,32,7,123,40\n"));
  EXPECT_GT(get_motion(rigid, 6).tail<3>().norm(), 0.2);
  EXPECT_GT((get_motion(rigid, 6) - get_motion(rigid, 10)).tail<3>().norm(), 0.2);
  for (int k = 0; k < 13; ++k) EXPECT_LT((get_motion(mean, k) - get_motion(rigid, k)).norm(), 1e-9) << k;
}

/// Grids on bars that hardly bend, against a rigid element; the difference in inverse proportion to their stiffness.
TEST_F(LargeDisplacementMeans, OfGridsOnStiffBarsIsARigidElement) {
  const auto rigid = solve(write_bars(kForkGrids + "RBE2,31,7,123456,21,22,23,40,41\n" + kLoads + kMoment));
  double last = 0;
  for (const double stiffness : {1e11, 1e12}) {
    const auto mean =
        solve(write_bars(kForkGrids + fmt::format("PBAR,9,9,1.,1.-4,1.-4,2.-4\nMAT1,9,{:.3g},,0.\n", stiffness) +
                         "CBAR,31,9,7,21,1.,0.,.2\nCBAR,32,9,7,22,1.,0.,.2\nCBAR,33,9,7,23,1.,0.2,0.\n"
                         "RBE3,34,,40,123456,1.,123456,21,2.\n,123,22,.7,123,23\nRBE2,35,40,123456,41\n" +
                         kLoads + kMoment));
    const double error = (get_motion(mean, 10) - get_motion(rigid, 10)).norm();
    if (last > 0) EXPECT_NEAR(last / error, 10, 0.5);
    last = error;
  }
  EXPECT_LT(last, 1e-3);
}

/// The support turns by 1.9 rad, and loads that follow the grids with it: the structure has the shape that it has
/// without. Soft bars to the grids of the mean.
TEST_F(LargeDisplacementMeans, TurnedWithItsSupportAndLoadsIsTheSame) {
  const std::string fork =
      kForkGrids +
      "PBAR,9,9,1.,3.-6,2.-6,2.-6\nMAT1,9,1.+9,,0.\nCBAR,31,9,7,21,1.,0.,.2\nCBAR,32,9,7,22,1.,0.,.2\n"
      "CBAR,33,9,7,23,1.,0.2,0.\nRBE3,34,,40,123456,1.,123456,21,2.\n,123,22,.7,123,23\nRBE2,35,40,123456,41\n"
      "FORCE1,1,40,6000.,7,21\nFORCE2,1,41,5000.,21,22,21,40\nMOMENT1,1,40,900.,1,41\n";
  const double angle = 1.9;
  const auto still = solve(write_bars(fork));
  const auto turned = solve(write_bars(fork + fmt::format("SPC,1,1,6,{:.15g}\n", angle), "SPC1,1,12345,1\n"));
  EXPECT_GT(get_motion(still, 10).head<3>().norm(), 0.3);
  const Matrix3d Q = calc_rotation_exp(Vector3d(0, 0, angle));
  const test::TextModel model(write_bars(fork));
  for (int k = 0; k < 12; ++k) {
    const Vector3d X = model.model.nodes()[static_cast<std::size_t>(k)].x;
    const Vector3d place = X + get_motion(still, k).head<3>(), found = X + get_motion(turned, k).head<3>();
    EXPECT_LT((Q * place - found).norm(), 1e-8) << k;
    const Matrix3d R = Q * calc_rotation_exp(get_motion(still, k).tail<3>());
    EXPECT_LT((R - calc_rotation_exp(get_motion(turned, k).tail<3>())).norm(), 1e-8) << k;
  }
  EXPECT_NEAR(still.result.strain_energy, turned.result.strain_energy, 1e-8 * still.result.strain_energy);
}

/// Arc length ends where load steps do.
TEST_F(LargeDisplacementMeans, ArcLengthEndsWhereLoadStepsDo) {
  const auto text =
      write_bars(kForkGrids +
                 "PBAR,9,9,1.,3.-6,2.-6,2.-6\nMAT1,9,1.+9,,0.\nCBAR,31,9,7,21,1.,0.,.2\nCBAR,32,9,7,22,1.,0.,.2\n"
                 "CBAR,33,9,7,23,1.,0.2,0.\nRBE3,34,,40,123456,1.,123,21,22\n,23\nRBE2,35,40,123456,41\n" +
                 kLoads);
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  CaseSolver solver(deck, {});
  solver.ask_nonlinear({10, 25, true}, true);
  const auto subcases = choose_static_subcases(deck, 0);
  auto [result, failure, found] = std::move(solver.solve_next(subcases).front());
  ASSERT_FALSE(failure);
  const auto steps = solve(text);
  EXPECT_LT((result->displacement - steps.result.displacement).norm(), 1e-8);
  EXPECT_TRUE(found.items().empty());
}

}  // namespace
}  // namespace bough::fe
