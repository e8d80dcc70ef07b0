/// Large displacements: loads that follow the grids, temperatures, and equations that are linear in displacements.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/rotation.hpp"
#include "fe/statics/case_solver.hpp"
#include "formats/nastran/reader.hpp"
#include "tests/fe/model/one_process.hpp"
#include "tests/fe/model/text_model.hpp"

namespace bough::fe {
namespace {

using std::numbers::pi;

using test::kHead;

class LargeDisplacementLoads : public test::OneProcess {};

struct Answer {
  records::StaticSubcase result;
  Diagnostics diagnostics;
};

Answer solve(const std::string& text, int increments = 10) {
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  CaseSolver solver(deck, {});
  solver.ask_nonlinear({increments}, true);
  const auto subcases = choose_static_subcases(deck, 0);
  auto [result, failure, found] = std::move(solver.solve_next(subcases).front());
  if (failure) std::rethrow_exception(failure);
  return {std::move(*result), std::move(found)};
}

/// Share of the load in fe.no-equilibrium, percent.
double find_limit(const std::string& text) {
  try {
    solve(text);
  } catch (const ComputationError& error) {
    const std::string what = error.what();
    return std::stod(what.substr(what.find("beyond ") + 7));
  }
  return 100;
}

Vector3d get_place(const Answer& answer, int node) { return answer.result.displacement.segment<3>(6 * node); }

/// A cantilever along x of n bars from grid 1, held. EI alike in both planes.
std::string write_bars(int n, double length, const std::string& more, double EA = 1e12, double EI = 1e4,
                       const std::string& head = kHead) {
  std::string text = fmt::format("{}MAT1,1,{:.9g},,0.,,1.-5,0.\nPBAR,1,1,1.,{:.9g},{:.9g},{:.9g}\nSPC1,1,123456,1\n",
                                 head, EA, EI / EA, EI / EA, 2 * EI / EA);
  for (int k = 0; k <= n; ++k) text += fmt::format("GRID,{},,{:.7g},0.,0.\n", k + 1, length * k / n);
  for (int k = 1; k <= n; ++k) text += fmt::format("CBAR,{},1,{},{},0.,1.,0.\n", k, k, k + 1);
  return text + more + "ENDDATA\n";
}

/// Planar elastica of unit length from its free end: the loads keep their place in the frame of the end. `force`: at
/// the end, across; `pressure`: along the normal. \return way of the end.
Eigen::Vector2d calc_follower_elastica(double EI, double force, double pressure) {
  // Angle from the end's tangent, place of the end seen from here, forces and moment beyond.
  using State = Eigen::Matrix<double, 6, 1>;
  const auto rate = [&](const State& y) {
    const double c = std::cos(y[0]), s = std::sin(y[0]);
    State d;
    d << -y[5] / EI, c, s, -pressure * s, pressure * c, c * y[4] - s * y[3];
    return d;
  };
  State y = State::Zero();
  y[4] = force;
  const int num = 4000;
  const double h = 1.0 / num;
  for (int i = 0; i < num; ++i) {
    const State a = rate(y), b = rate(y + h / 2 * a), c = rate(y + h / 2 * b), d = rate(y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return Eigen::Rotation2Dd(-y[0]) * Eigen::Vector2d(y[1], y[2]) - Eigen::Vector2d(1, 0);
}

TEST_F(LargeDisplacementLoads, ForceThatFollowsTheEnd) {
  const double P = 6e4;
  const Eigen::Vector2d exact = calc_follower_elastica(1e4, P, 0);
  EXPECT_LT(exact[0], -0.9);  // it comes round
  double last = 0;
  for (const int n : {20, 40}) {
    const std::string arms =
        fmt::format("GRID,91,,1.1,0.,0.\nGRID,92,,1.,.1,0.\nGRID,93,,1.,0.,.1\nRBE2,90,{0},123456,91,92,93\n", n + 1);
    const auto along = solve(write_bars(n, 1, arms + fmt::format("FORCE1,1,{0},{1},{0},93\n", n + 1, P)));
    const auto across = solve(write_bars(n, 1, arms + fmt::format("FORCE2,1,{0},{1},{0},91,{0},92\n", n + 1, P)));
    const Vector3d way = get_place(along, n);
    EXPECT_LT((way - get_place(across, n)).norm(), 1e-7);
    EXPECT_LT(std::abs(way.y()), 1e-9);
    const double error = (Eigen::Vector2d(way.x(), way.z()) - exact).norm();
    EXPECT_LT(error, n == 20 ? 2e-5 : 2e-6);
    if (last > 0) EXPECT_GT(last / error, 10);
    last = error;
    EXPECT_LT((along.result.load_resultant + along.result.reaction_resultant).norm(), 1e-6 * P);
    EXPECT_EQ(along.diagnostics.items().size(), 0u);
  }
  // LGDISP = 2: large displacements, without follower forces.
  const std::string arm = "GRID,93,,1.,0.,.1\nRBE2,90,21,123456,93\nFORCE1,1,21,60000.,21,93\nPARAM,LGDISP,2\n";
  const auto dead = solve(write_bars(20, 1, arm)), plain = solve(write_bars(20, 1, "FORCE,1,21,,60000.,0.,0.,1.\n"));
  EXPECT_LT((get_place(dead, 20) - get_place(plain, 20)).norm(), 1e-8);
}

TEST_F(LargeDisplacementLoads, PressureThatFollowsTheFaces) {
  const double width = 0.1, thickness = 0.01, E = 1.2e9, EI = E * width * std::pow(thickness, 3) / 12;
  const double p = 12 * EI / width;
  const Eigen::Vector2d exact = calc_follower_elastica(EI, 0, p * width);
  EXPECT_GT(exact.norm(), 0.8);
  const auto calc_error = [&](int n, const std::string& card) {
    std::string strip =
        fmt::format("{}MAT1,1,{:.9g},,0.\nPSHELL,1,1,{:.9g},1,,1\nSPC1,1,123456,1,2\n", kHead, E, thickness);
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j < 2; ++j)
        strip += fmt::format("GRID,{},,{:.9f},{:.3f},0.\n", 2 * k + j + 1, double(k) / n, j * width);
    for (int k = 0; k < n; ++k) {
      strip += fmt::format("CQUAD4,{},1,{},{},{},{}\n", k + 1, 2 * k + 1, 2 * k + 3, 2 * k + 4, 2 * k + 2);
      if (card == "PLOAD2") strip += fmt::format("PLOAD2,1,{:.9g},{}\n", p, k + 1);
      if (card == "PLOAD4") strip += fmt::format("PLOAD4,1,{},{:.9g}\n", k + 1, p);
      if (card == "PLOAD")
        strip += fmt::format("PLOAD,1,{:.9g},{},{},{},{}\n", p, 2 * k + 1, 2 * k + 3, 2 * k + 4, 2 * k + 2);
    }
    const auto answer = solve(strip + "ENDDATA\n");
    EXPECT_LT((answer.result.load_resultant + answer.result.reaction_resultant).norm(), 1e-5 * p * width);
    const Vector3d way = get_place(answer, 2 * n);
    return (Eigen::Vector2d(way.x(), way.z()) - exact).norm();
  };
  const double coarse = calc_error(24, "PLOAD4"), fine = calc_error(48, "PLOAD4");
  EXPECT_LT(coarse, 6e-3);
  EXPECT_LT(fine, coarse / 3);  // of second order in the length of an element
  for (const char* card : {"PLOAD", "PLOAD2"}) EXPECT_NEAR(calc_error(24, card), coarse, 1e-8);
}

/// A moment that turns with its grid is a couple of forces that do, in space.
TEST_F(LargeDisplacementLoads, MomentThatFollowsIsACouple) {
  const std::string arms =
      "GRID,91,,1.1,0.,0.\nGRID,92,,1.,.1,0.\nGRID,93,,1.,0.,.1\nGRID,94,,1.,0.,-.1\nRBE2,90,9,123456,91,92,93,94\n"
      "FORCE,1,9,,9000.,.2,1.,.4\n";
  const auto one = solve(write_bars(8, 1, arms + "MOMENT1,1,9,12000.,9,92\n"));
  const auto two = solve(write_bars(8, 1, arms + "MOMENT2,1,9,12000.,9,93,9,91\n"));
  const auto couple = solve(write_bars(8, 1, arms + "FORCE1,1,93,60000.,9,91\nFORCE1,1,94,60000.,91,9\n"));
  EXPECT_GT(get_place(one, 8).norm(), 0.3);
  EXPECT_LT((get_place(one, 8) - get_place(couple, 8)).norm(), 1e-7);
  EXPECT_LT((get_place(one, 8) - get_place(two, 8)).norm(), 1e-7);
}

TEST_F(LargeDisplacementLoads, StiffnessOfFollowersIsTheirDerivative) {
  const Model model = test::build(
      "SOL 101\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,.1,0.\nGRID,3,,1.1,1.,.2\nGRID,4,,0.,1.,.1\n"
      "GRID,5,,.5,0.,.05\nMAT1,1,7.+10,,.3\nPSHELL,1,1,.1,1,,1\nCQUAD4,1,1,1,2,3,4\nCBAR,2,9,1,5,0.,0.,1.\n"
      "PBAR,9,1,1.,1.,1.,1.\n");
  FollowerLoads loads;
  const auto find = [&](int id) { return model.find_node(id); };
  loads.pressures.push_back({{find(1), find(2), find(3), find(4), find(5)}, {1, 0, 0, 0}, {1, 2, -1, 3}});
  loads.forces.push_back({find(2), false, false, 1.5, {find(1), find(3), 0, 0}});
  loads.forces.push_back({find(1), true, true, -0.7, {find(1), find(3), find(2), find(4)}});
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  const int N = model.num_gdofs();
  VectorXd u = VectorXd::NullaryExpr(N, [&] { return uniform(engine); });
  const auto calc = [&] {
    VectorXd F = VectorXd::Zero(N);
    add_follower_forces(model, loads, 1, u, F);
    return F;
  };
  MatrixXd K = MatrixXd::Zero(N, N), differences(N, N);
  visit_follower_stiffness(model, loads, u, [&](const std::vector<int>& gdofs, const MatrixXd& part) {
    for (std::size_t i = 0; i < gdofs.size(); ++i)
      for (std::size_t j = 0; j < gdofs.size(); ++j)
        K(gdofs[i], gdofs[j]) += part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  });
  const double step = 1e-5;
  for (int j = 0; j < N; ++j) {
    u[j] += step;
    const VectorXd after = calc();
    u[j] -= 2 * step;
    differences.col(j) = -(after - calc()) / (2 * step);
    u[j] += step;
  }
  EXPECT_GT(K.norm(), 1);
  EXPECT_LT((K - differences).norm(), 1e-8 * K.norm());
}

/// A ring under external pressure loses its stability at 3 EI/R³ if the pressure follows, at 4 EI/R³ if it does not.
TEST_F(LargeDisplacementLoads, RingUnderPressure) {
  const int n = 24;
  const double E = 7e10, thickness = 0.02, EI = E * std::pow(thickness, 3) / 12;
  const auto write = [&](double p, int lgdisp) {
    std::string text = fmt::format(
        "{}PARAM,LGDISP,{}\nCORD2C,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nMAT1,1,{:.9g},,0.\n"
        "PSHELL,1,1,{},1,,1\nSPC1,1,34,1,THRU,{}\n",
        kHead, lgdisp, E, thickness, 2 * n + 2);
    for (int i = 0; i <= n; ++i)
      for (int k = 0; k < 2; ++k)
        text += fmt::format("GRID,{},5,1.,{:.6f},{},5\n", 2 * i + k + 1, 90.0 * i / n, 0.05 * k);
    for (int i = 0; i < n; ++i)
      text += fmt::format("CQUAD4,{0},1,{1},{2},{3},{4}\nPLOAD2,1,{5:.8g},{0}\n", i + 1, 2 * i + 1, 2 * i + 3,
                          2 * i + 4, 2 * i + 2, -p);
    for (const int i : {0, n}) text += fmt::format("SPC1,1,26,{},{}\n", 2 * i + 1, 2 * i + 2);
    return text + "ENDDATA\n";
  };
  EXPECT_NEAR(find_limit(write(5 * EI, 1)), 60, 0.6);
  EXPECT_NEAR(find_limit(write(5 * EI, 2)), 80, 0.8);
}

/// A difference of temperatures across the height bends a free beam to an arc.
TEST_F(LargeDisplacementLoads, GradientBendsToAnArc) {
  const int n = 20;
  const double angle = 1.2 * pi;
  std::string text = write_bars(n, 1, "", 1e9, 1e4, "SOL 106\nCEND\nSPC = 1\nTEMP(LOAD) = 7\nBEGIN BULK\n");
  text.resize(text.find("ENDDATA"));
  for (int k = 1; k <= n; ++k) text += fmt::format("TEMPRB,7,{},0.,0.,{:.9g},{:.9g}\n", k, angle / 1e-5, angle / 1e-5);
  const auto answer = solve(text + "ENDDATA\n", 20);
  const Vector3d way = get_place(answer, n);
  EXPECT_NEAR(way.x(), std::sin(angle) / angle - 1, 2e-5);
  EXPECT_NEAR(std::abs(way.y()), (1 - std::cos(angle)) / angle, 2e-5);
  EXPECT_LT(std::abs(answer.result.strain_energy), 1e-3 * 1e4 * angle * angle);
  EXPECT_LT(answer.result.reaction.norm(), 1e-2);
}

/// A heated beam between two clamps buckles at EA α T = 4 π² EI/L²; before, it is at rest under that force.
TEST_F(LargeDisplacementLoads, HeatedBeamBuckles) {
  const int n = 16;
  const double EA = 1e7, EI = 1e4 / 100, hot = 4 * pi * pi * EI / (EA * 1e-5);
  const auto write = [&](double T) {
    return write_bars(n, 1, fmt::format("SPC1,1,123456,{}\nTEMPD,7,{:.9g}\n", n + 1, T), EA, EI,
                      "SOL 106\nCEND\nSPC = 1\nTEMP(LOAD) = 7\nBEGIN BULK\n");
  };
  EXPECT_NEAR(find_limit(write(2 * hot)), 50, 0.5);
  const auto answer = solve(write(0.5 * hot));
  EXPECT_NEAR(answer.result.reaction[0], 2 * pi * pi * EI, 1e-6 * EI);
  const auto& forces = answer.result.elements.at(0);
  const auto axial = std::find(forces.components.begin(), forces.components.end(), "axial") - forces.components.begin();
  EXPECT_NEAR(forces.force(3, axial), -2 * pi * pi * EI, 1e-6 * EI);
}

/// The force on the reference grid of an RBE3 is the same forces on its grids, however far they move.
TEST_F(LargeDisplacementLoads, AveragedForceIsDistributed) {
  const std::string fork =
      "GRID,21,,1.,.3,.2\nGRID,22,,1.,-.3,.2\nGRID,23,,1.,.1,-.3\nCBAR,31,1,9,21,1.,0.,0.\nCBAR,32,1,9,22,1.,0.,0.\n"
      "CBAR,33,1,9,23,1.,0.,0.\n";
  // At the mean of its grids: equal shares.
  const auto tied = solve(write_bars(8, 1,
                                     fork + "GRID,40,,1.,.033333333,.033333333\nRBE3,41,,40,123456,1.,123,21,22\n,23\n"
                                            "FORCE,1,40,,36000.,.3,.5,1.\n",
                                     1e9));
  std::string shares;
  for (const int k : {21, 22, 23}) shares += fmt::format("FORCE,1,{},,12000.,.3,.5,1.\n", k);
  const auto shared = solve(write_bars(8, 1, fork + shares, 1e9));
  EXPECT_GT(get_place(shared, 8).norm(), 0.4);
  EXPECT_LT((get_place(tied, 8) - get_place(shared, 8)).norm(), 1e-6);
  EXPECT_TRUE(tied.diagnostics.items().empty());
}

/// Equations of displacements and of rotation vectors: two beams share what one of them is loaded by.
TEST_F(LargeDisplacementLoads, EquationsAreLinear) {
  std::string second;
  for (int k = 0; k <= 10; ++k) second += fmt::format("GRID,{},,{},1.,0.\n", k + 51, k / 10.0);
  for (int k = 1; k <= 10; ++k) second += fmt::format("CBAR,{},1,{},{},0.,1.,0.\n", k + 50, k + 50, k + 51);
  second += "SPC1,1,123456,51\n";
  const std::string head = "SOL 106\nCEND\nSPC = 1\nLOAD = 1\nMPC = 3\nBEGIN BULK\n";
  const auto shared =
      solve(write_bars(10, 1, second + "MPC,3,61,3,1.,11,3,-1.\nFORCE,1,11,,40000.,0.,0.,1.\n", 1e9, 1e4, head));
  const auto alone = solve(write_bars(10, 1, "FORCE,1,11,,20000.,0.,0.,1.\n", 1e9));
  EXPECT_LT((get_place(shared, 10) - get_place(alone, 10)).norm(), 1e-7);
  EXPECT_LT((get_place(shared, 21) - get_place(alone, 10)).norm(), 1e-7);
  // Rotation vectors: beyond half a turn too.
  const auto bent = solve(write_bars(
      10, 1, second + fmt::format("MPC,3,61,5,1.,11,5,-1.\nMOMENT,1,11,,{:.9g},0.,-1.,0.\n", 2 * 1e4 * 1.2 * pi), 1e9,
      1e4, head));
  const auto arc = solve(write_bars(10, 1, fmt::format("MOMENT,1,11,,{:.9g},0.,-1.,0.\n", 1e4 * 1.2 * pi), 1e9));
  EXPECT_LT((get_place(bent, 10) - get_place(arc, 10)).norm(), 1e-6);
  EXPECT_NEAR(bent.result.displacement[6 * 10 + 4], -1.2 * pi, 1e-3);
}

}  // namespace
}  // namespace bough::fe
