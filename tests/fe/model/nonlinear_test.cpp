#include "fe/statics/nonlinear.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/rotation.hpp"
#include "fe/statics/case_solver.hpp"
#include "formats/nastran/reader.hpp"
#include "tests/fe/model/one_process.hpp"

namespace bough::fe {
namespace {

using std::numbers::pi;

using test::kHead;

class LargeDisplacements : public test::OneProcess {};

/// The solution of all subcases of a deck; `messages`: warnings.
std::vector<records::StaticSubcase> solve(const std::string& text, const NonlinearOptions* options,
                                          Diagnostics* messages = nullptr) {
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  CaseSolver solver(deck, {});
  if (options) solver.ask_nonlinear(*options, true);
  const auto subcases = choose_static_subcases(deck, 0);
  std::vector<records::StaticSubcase> results;
  for (std::size_t next = 0; next < subcases.size();)
    for (auto& [result, failure, warnings] : solver.solve_next(std::span(subcases).subspan(next))) {
      if (failure) std::rethrow_exception(failure);
      if (messages)
        for (const auto& item : warnings.items()) messages->add(item);
      results.push_back(std::move(*result));
      ++next;
    }
  return results;
}

std::vector<records::StaticSubcase> solve(const std::string& text, bool is_nonlinear = true, int increments = 10) {
  NonlinearOptions options;
  options.num_increments = increments;
  return solve(text, is_nonlinear ? &options : nullptr);
}

std::vector<records::StaticSubcase> follow_arc(const std::string& text, Diagnostics& messages) {
  NonlinearOptions options;
  options.has_arc_length = true;
  return solve(text, &options, &messages);
}

/// Translations of the grid of row `node` (all grids have six dofs).
Vector3d get_place(const records::StaticSubcase& result, int node) { return result.displacement.segment<3>(6 * node); }

/// Bars from grid 1, held, along points; no shear.
std::string write_bars(const Matrix3Xd& points, const std::string& more, double EA = 1e9, double EI = 1e4) {
  std::string text = fmt::format("{}MAT1,1,{:.9g},,0.\nPBAR,1,1,1.,{:.9g},{:.9g},{:.9g}\nSPC1,1,123456,1\n", kHead, EA,
                                 EI / EA, EI / EA, 2 * EI / EA);
  for (Eigen::Index k = 0; k < points.cols(); ++k)
    text += fmt::format("GRID*   {:<16d}{:16s}{:<16.9g}{:<16.9g}\n*       {:<16.9g}\n", k + 1, "", points(0, k),
                        points(1, k), points(2, k));
  for (Eigen::Index k = 1; k < points.cols(); ++k) text += fmt::format("CBAR,{},1,{},{},.1,.3,1.\n", k, k, k + 1);
  return text + more + "ENDDATA\n";
}

Matrix3Xd make_line(int n, double length) {
  Matrix3Xd points = Matrix3Xd::Zero(3, n + 1);
  points.row(0) = Eigen::RowVectorXd::LinSpaced(n + 1, 0, length);
  return points;
}

/// M L = 2π EI: the beam becomes a circle, the end comes back to the clamp, and turns once.
TEST_F(LargeDisplacements, BeamRollsToACircle) {
  for (const int n : {10, 20}) {
    const auto result =
        solve(write_bars(make_line(n, 10),
                         fmt::format("MOMENT,1,{},,{:.12g},0.,0.,1.\nSPC1,1,345,2,THRU,{}\n", n + 1, 2e3 * pi, n + 1)));
    const double error = (get_place(result[0], n) + Vector3d(10, 0, 0)).norm() / 10;
    EXPECT_LT(error, 1e-11);  // all elements are alike: a polygon that closes
    EXPECT_NEAR(result[0].reaction.segment<3>(3).norm(), 2e3 * pi, 1e-4);
    EXPECT_NEAR(result[0].strain_energy, 0.5 * 1e4 * 4 * pi * pi / 10, 1e-3 * 2e5);
  }
}

/// The elastica by elliptic integrals (Bisshopp and Drucker 1945): P L² / EI = 10.
TEST_F(LargeDisplacements, CantileverUnderAnEndForce) {
  const double alpha = 10;
  double low = std::sqrt(0.5) + 1e-12, high = 1 - 1e-12;
  for (int i = 0; i < 200; ++i) {
    const double k = 0.5 * (low + high), phi = std::asin(1 / (k * std::sqrt(2.0)));
    (std::comp_ellint_1(k) - std::ellint_1(k, phi) < std::sqrt(alpha) ? low : high) = k;
  }
  const double k = low, phi = std::asin(1 / (k * std::sqrt(2.0)));
  const double w = 1 - 2 * (std::comp_ellint_2(k) - std::ellint_2(k, phi)) / std::sqrt(alpha);
  const double x = std::sqrt(2 / alpha) * std::sqrt(2 * k * k - 1);
  EXPECT_NEAR(w, 0.81061, 1e-5);  // Mattiasson, IJNME 17 (1981) 145
  EXPECT_NEAR(1 - x, 0.55500, 1e-5);
  double last = 0;
  for (const int n : {20, 40}) {
    const auto result = solve(write_bars(make_line(n, 1), fmt::format("FORCE,1,{},,100000.,0.,0.,1.\n", n + 1), 1e12));
    const double error = (get_place(result[0], n) - Vector3d(x - 1, 0, w)).norm();
    EXPECT_LT(error, n == 20 ? 2e-6 : 2e-7);
    if (last > 0) EXPECT_GT(last / error, 12);  // of fourth order in the length of an element
    last = error;
    EXPECT_LT((result[0].load_resultant + result[0].reaction_resultant).norm(), 1e-8 * 1e5);
  }
}

/// Bathe and Bolourchi, IJNME 14 (1979) 961: radius 100, square of 1, E = 1e7, nu = 0, 600 across the plane.
TEST_F(LargeDisplacements, FortyFiveDegreeBend) {
  Matrix3Xd points(3, 9);
  for (int k = 0; k <= 8; ++k)
    points.col(k) = 100 * Vector3d(std::sin(pi / 4 * k / 8), 1 - std::cos(pi / 4 * k / 8), 0);
  const auto result = solve(write_bars(points, "FORCE,1,9,,600.,0.,0.,1.\n", 1e7, 1e7 / 12));
  const Vector3d end = points.col(8) + get_place(result[0], 8);
  EXPECT_NEAR(end.x(), 47.2, 0.3);
  EXPECT_NEAR(end.y(), 15.9, 0.3);
  EXPECT_NEAR(end.z(), 53.4, 0.3);
}

/// Turned as a whole, with its loads, a structure bends alike.
TEST_F(LargeDisplacements, DoesNotDependOnAxes) {
  const Matrix3d turn = calc_rotation_exp(Vector3d(0.4, -1.2, 0.9));
  Matrix3Xd points = make_line(6, 2);
  points(1, 4) = 0.3;
  points(2, 5) = -0.2;
  const auto write = [&](const Matrix3d& R) {
    const Vector3d F = R * Vector3d(-500, 4e3, 6e3);
    return write_bars(R * points, fmt::format("FORCE,1,7,,1.,{:.12g},{:.12g},{:.12g}\n", F[0], F[1], F[2]), 1e8);
  };
  const auto one = solve(write(Matrix3d::Identity())), other = solve(write(turn));
  EXPECT_GT(get_place(one[0], 6).norm(), 0.5);
  // The bars' orientation vectors do not turn: the section is the same about both axes.
  EXPECT_LT((turn * get_place(one[0], 6) - get_place(other[0], 6)).norm(), 1e-6);
}

/// Small loads: the linear solution, and the difference is of second order in the load.
TEST_F(LargeDisplacements, SmallLoadsAreLinear) {
  Matrix3Xd points = make_line(4, 2);
  points(2, 2) = 0.4;
  const auto calc = [&](double size) {
    const auto text =
        write_bars(points, fmt::format("FORCE,1,5,,{:.9g},.3,.5,1.\nMOMENT,1,3,,{:.9g},.2,1.,0.\n", size, size));
    return (solve(text)[0].displacement - solve(text, false)[0].displacement).norm() / size;
  };
  const double once = calc(0.1), twice = calc(0.2);
  EXPECT_NEAR(twice / once, 2, 0.05);
}

/// A force on an arm of an RBE2 is one on the end of a bar that hardly bends.
TEST_F(LargeDisplacements, RigidElementsTurn) {
  const auto write = [](bool is_rigid) {
    std::string arm =
        is_rigid ? "RBE2,100,5,123456,6\n" : "PBAR,2,2,1.,.1,.1,.1\nMAT1,2,1.+10,,0.\nCBAR,100,2,5,6,1.,0.,0.\n";
    return write_bars(make_line(4, 2), "GRID,6,,2.,0.,.5\n" + arm + "FORCE,1,6,,5000.,-1.,.5,.8\n");
  };
  const auto rigid = solve(write(true)), stiff = solve(write(false));
  EXPECT_GT(get_place(stiff[0], 5).norm(), 0.5);
  EXPECT_LT((rigid[0].displacement - stiff[0].displacement).norm(), 1e-5);
  EXPECT_LT((rigid[0].reaction.head<6>() - stiff[0].reaction.head<6>()).norm(), 1e-1);
  EXPECT_LT((rigid[0].load_resultant + rigid[0].reaction_resultant).norm(), 1e-4);
  EXPECT_LT(rigid[0].mpc_resultant.norm(), 1e-4);
}

/// An end that SPC moves has the reaction of the force that moves it there.
TEST_F(LargeDisplacements, EnforcedDisplacementsAreReached) {
  const auto forced = solve(write_bars(make_line(8, 1), "FORCE,1,9,,40000.,0.,0.,1.\n"));
  const Vector3d place = get_place(forced[0], 8);
  auto text = write_bars(make_line(8, 1), fmt::format("SPC,1,9,3,{:.10g}\n", place.z()));
  text.replace(text.find("LOAD = 1\n"), 9, "");
  const auto moved = solve(text);
  EXPECT_LT((get_place(moved[0], 8) - place).norm(), 1e-6);
  EXPECT_NEAR(moved[0].reaction[6 * 8 + 2], 40000, 1);
}

std::string write_roof(double EA, double height, double force) {
  return fmt::format(
      "{}MAT1,1,{:.9g},,0.\nPROD,1,1,1.\nGRID,1,,-1.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,0.,{:.9g}\n"
      "CROD,1,1,1,3\nCROD,2,1,2,3\nSPC1,1,123456,1,2\nSPC1,1,2456,3\nFORCE,1,3,,{:.9g},0.,0.,-1.\nENDDATA\n",
      kHead, EA, height, force);
}

/// Two rods as a flat roof (von Mises): no equilibrium near by above the limit load, which a closed form gives.
TEST_F(LargeDisplacements, LimitPointIsNamed) {
  const double EA = 1e6, height = 0.1;
  const double length = std::hypot(1.0, height);
  double limit = 0;
  for (double y = height; y > 0; y -= 1e-6) {
    const double now = std::hypot(1.0, y);
    limit = std::max(limit, 2 * EA * (length - now) / length * y / now);
  }
  const auto write = [&](double force) { return write_roof(EA, height, force); };
  EXPECT_NEAR(solve(write(0.99 * limit))[0].reaction[2] * 2, 0.99 * limit, 1e-6 * limit);
  for (const double more : {1.01, 2.0}) {
    try {
      solve(write(more * limit));
      FAIL() << "jumped through";
    } catch (const ComputationError& error) {
      EXPECT_EQ(error.items()[0].id, "fe.no-equilibrium");
      const std::string text = error.what();
      const double reached = std::stod(text.substr(text.find("beyond ") + 7));
      EXPECT_LE(reached, 100.001 / more);
      EXPECT_GT(reached, 99 / more);
    }
  }
}

/// A roof of two rods beyond its limit load: snapped through, as the closed form has it.
TEST_F(LargeDisplacements, ArcLengthPassesLimitPoints) {
  const double EA = 1e6, height = 0.1, length = std::hypot(1.0, height);
  const auto calc_load = [&](double y) {
    return 2 * EA * (length - std::hypot(1.0, y)) / length * y / std::hypot(1.0, y);
  };
  double limit = 0;
  for (double y = height; y > 0; y -= 1e-5) limit = std::max(limit, calc_load(y));
  for (const double more : {1.01, 2.0, 10.0}) {
    Diagnostics messages;
    const auto result = follow_arc(write_roof(EA, height, more * limit), messages);
    double low = -1, high = -height;  // the load falls as y rises
    while (high - low > 1e-14) (calc_load((low + high) / 2) > more * limit ? low : high) = (low + high) / 2;
    EXPECT_NEAR(get_place(result[0], 2)[2], low - height, 1e-7);  // the held rotations turn the rods' frames a little
    ASSERT_EQ(messages.items().size(), 1u);
    EXPECT_EQ(messages.items()[0].id, "fe.limit-point");
    const std::string text = messages.items()[0].what;
    EXPECT_NE(text.find("passes 2 limit"), std::string::npos) << text;
    const double reached = std::stod(text.substr(text.find("near ") + 5));
    EXPECT_LE(reached, 100.001 / more);
    EXPECT_GT(reached, 80 / more);
  }
}

/// Lee's frame (Lee, Manuel and Rossow 1968), legs of L = 120, EI = 1440: limit load 18.55 EI/L², then a snap back.
TEST_F(LargeDisplacements, ArcLengthPassesTheSnapBackOfLeesFrame) {
  std::string text = fmt::format("{}MAT1,1,720.,,.3\nPBAR,1,1,6.,4.5,2.,4.\n", kHead);
  const int n = 10;
  for (int k = 0; k <= 2 * n; ++k)
    text += fmt::format("GRID,{},,{:.9g},{:.9g},0.\n", k + 1, k <= n ? 0 : 12. * (k - n), k <= n ? 12. * k : 120.);
  for (int k = 1; k <= 2 * n; ++k) text += fmt::format("CBAR,{},1,{},{},0.,0.,1.\n", k, k, k + 1);
  text += fmt::format("SPC1,1,12345,1,{}\nSPC1,1,345,2,THRU,{}\n", 2 * n + 1, 2 * n);
  const auto load = [&](double force) {
    return text + fmt::format("FORCE,1,{},,{},0.,-1.,0.\nENDDATA\n", n + 3, force);
  };
  EXPECT_NO_THROW(solve(load(1.84)));
  EXPECT_THROW(solve(load(1.87)), ComputationError);
  Diagnostics messages;
  const auto result = follow_arc(load(2), messages);
  ASSERT_FALSE(messages.items().empty());
  EXPECT_EQ(messages.items()[0].id, "fe.limit-point");
  EXPECT_EQ(messages.items().size(), 1u);  // stable again
  EXPECT_NEAR(result[0].reaction_resultant[1], 2, 1e-6);
  EXPECT_LT(get_place(result[0], n + 2)[1], -80);
}

/// Arc length ends where load steps do on a path without limit points: dead, following and enforced loads.
TEST_F(LargeDisplacements, ArcLengthEndsWhereLoadStepsDo) {
  const auto line = make_line(8, 1);
  const std::string loads[] = {"FORCE,1,9,,40000.,0.,.2,1.\n", "FORCE1,1,9,30000.,8,9\nMOMENT,1,9,,5000.,0.,1.,0.\n",
                               "SPCD,1,9,3,.5\nSPC1,1,3,9\n"};
  for (const auto& load : loads) {
    const auto text = write_bars(line, load);
    Diagnostics messages;
    const auto arc = follow_arc(text, messages), steps = solve(text);
    EXPECT_LT((arc[0].displacement - steps[0].displacement).norm(), 1e-8) << load;
    EXPECT_LT((arc[0].reaction - steps[0].reaction).norm(), 1e-6 * steps[0].reaction.norm()) << load;
    EXPECT_TRUE(messages.items().empty()) << load;
  }
}

/// A column past Euler's load: the straight branch is unstable, which a warning reports.
TEST_F(LargeDisplacements, UnstableEquilibriumIsNamed) {
  Diagnostics messages;
  follow_arc(write_bars(make_line(8, 1), "FORCE,1,9,,40000.,-1.,0.,0.\n"), messages);
  ASSERT_EQ(messages.items().size(), 1u);
  EXPECT_EQ(messages.items()[0].id, "fe.unstable-equilibrium");
}

/// Subcases of SOL 106 go on from each other, so that the last is reached as by itself.
TEST_F(LargeDisplacements, SubcasesGoOn) {
  auto text = write_bars(make_line(8, 1), "FORCE,1,9,,20000.,0.,0.,1.\nFORCE,2,9,,40000.,0.,0.,1.\n");
  text.replace(text.find("LOAD = 1\n"), 9, "SUBCASE 1\nLOAD = 1\nSUBCASE 2\nLOAD = 2\n");
  const auto both = solve(text);
  ASSERT_EQ(both.size(), 2u);
  const auto alone = solve(write_bars(make_line(8, 1), "FORCE,1,9,,40000.,0.,0.,1.\n"));
  EXPECT_LT((both[1].displacement - alone[0].displacement).norm(), 1e-7);
  EXPECT_GT((both[0].displacement - alone[0].displacement).norm(), 0.1);
}

/// A strip of shells bends as the elastica (nu = 0), and forces in its elements' frames are M and N of a beam.
TEST_F(LargeDisplacements, ShellsBend) {
  const int n = 20;
  const double width = 0.1, thickness = 0.01, E = 1.2e9, EI = E * width * std::pow(thickness, 3) / 12;
  std::string text =
      fmt::format("{}MAT1,1,{:.9g},,0.\nPSHELL,1,1,{:.9g},1,,1\nSPC1,1,123456,1,2\n", kHead, E, thickness);
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j < 2; ++j)
      text += fmt::format("GRID,{},,{:.6g},{:.6g},0.\n", 2 * k + j + 1, double(k) / n, j * width);
  for (int k = 0; k < n; ++k)
    text += fmt::format("CQUAD4,{},1,{},{},{},{}\n", k + 1, 2 * k + 1, 2 * k + 3, 2 * k + 4, 2 * k + 2);
  text +=
      fmt::format("FORCE,1,{},,{:.9g},0.,0.,1.\nFORCE,1,{},,{:.9g},0.,0.,1.\nENDDATA\n", 2 * n + 1, EI, 2 * n + 2, EI);
  const auto result = solve(text);  // P L² / EI = 2: Mattiasson, w = 0.49346, u = 0.16064
  EXPECT_NEAR(get_place(result[0], 2 * n).z(), 0.49346, 2e-3);
  EXPECT_NEAR(-get_place(result[0], 2 * n).x(), 0.16064, 2e-3);
  ASSERT_FALSE(result[0].elements.empty());
  EXPECT_LT((result[0].load_resultant + result[0].reaction_resultant).norm(), 1e-4 * EI);
}

/// Axial forces are the load seen along the chord of each element, though elements bow.
TEST_F(LargeDisplacements, ElementForcesBalanceTheLoad) {
  const int n = 20;
  const double P = 6e4;
  const auto result = solve(write_bars(make_line(n, 1), fmt::format("FORCE,1,{},,{:.9g},0.,0.,1.\n", n + 1, P)));
  ASSERT_EQ(result[0].elements.at(0).card, "CBAR");
  const auto& names = result[0].elements[0].components;
  const auto axial = std::find(names.begin(), names.end(), "axial") - names.begin();
  ASSERT_LT(axial, static_cast<Eigen::Index>(names.size()));
  for (int k = 0; k < n; ++k) {
    const Vector3d chord = Vector3d(1.0 / n, 0, 0) + get_place(result[0], k + 1) - get_place(result[0], k);
    EXPECT_NEAR(result[0].elements[0].force(k, axial), P * chord.normalized().z(), 2e-3 * P) << k;
  }
}

/// The weight of a mass off its grid turns with its arm: the same mass on an RBE2.
TEST_F(LargeDisplacements, WeightsOffTheirGridsTurn) {
  const auto write = [](const std::string& mass) {
    return write_bars(make_line(6, 1), mass + "GRAV,1,,9.81,0.,0.,-1.\n");
  };
  const auto offset = solve(write("CONM2,90,7,,3000.,0.,.3,-.4\n"));
  const auto linked = solve(write("GRID,8,,1.,.3,-.4\nRBE2,91,7,123456,8\nCONM2,90,8,,3000.\n"));
  EXPECT_GT(get_place(offset[0], 6).norm(), 0.3);
  EXPECT_LT((get_place(offset[0], 6) - get_place(linked[0], 6)).norm(), 1e-8);
}

/// A moment about a fixed axis bends a beam that is free in space to an arc: it has no potential there, and no branch.
TEST_F(LargeDisplacements, FixedMomentInSpace) {
  const auto result = solve(write_bars(make_line(20, 10), fmt::format("MOMENT,1,21,,{:.14g},0.,0.,1.\n", 1.2e3 * pi)));
  const double angle = 1.2 * pi;
  EXPECT_LT(
      (get_place(result[0], 20) - 10 * Vector3d(std::sin(angle) / angle - 1, (1 - std::cos(angle)) / angle, 0)).norm(),
      5e-6);
}

TEST_F(LargeDisplacements, NamesWhatItCannotTurn) {
  const auto get_error = [](const std::string& more) -> std::string {
    try {
      solve(write_bars(make_line(4, 2), more));
    } catch (const Failure& failure) {
      return failure.what();
    }
    return {};
  };
  EXPECT_NE(get_error("CELAS2,9,100.,5,5\nFORCE,1,5,,1.,1.,0.,0.\n").find("fe.nonlinear-element"), std::string::npos);
  EXPECT_NE(get_error("RFORCE,1,1,,1.,0.,0.,1.\nCONM2,9,5,,1.\n").find("fe.nonlinear-load"), std::string::npos);
  EXPECT_NE(get_error("PLOAD1,1,2,FY,FR,0.,1.,1.,1.\n").find("fe.nonlinear-load"), std::string::npos);
}

}  // namespace
}  // namespace bough::fe
