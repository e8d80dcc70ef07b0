/// Normal modes of beams against closed forms and the published NAFEMS tables.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/modal/solve_modes.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

constexpr double kPi = std::numbers::pi;

EigenPairs solve(const records::Deck& deck, int num_modes, Diagnostics& diagnostics) {
  return test::solve_modes(fe::build_model(deck, {}, diagnostics), num_modes, diagnostics);
}

EigenPairs solve(const records::Deck& deck, int num_modes) {
  Diagnostics diagnostics;
  return solve(deck, num_modes, diagnostics);
}

double get_rate(const EigenPairs& pairs, int i) { return std::sqrt(pairs.lambda(i)); }
double get_hz(const EigenPairs& pairs, int i) { return get_rate(pairs, i) / (2 * kPi); }

void expect_hz(const EigenPairs& pairs, int first, const std::vector<double>& expected, double tolerance) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const int j = first + static_cast<int>(i);
    EXPECT_NEAR(get_hz(pairs, j) / expected[i], 1, tolerance) << "mode " << j + 1 << ": " << get_hz(pairs, j);
  }
}

Section make_square(double side) {
  const double I = std::pow(side, 4) / 12;
  return {200e9, 200e9 / 2.6, 8000, side * side, I, I, 0.1406 * std::pow(side, 4)};
}

// NASA-CR-202063, 4.1.4.1.
TEST(BeamModes, ReportCantileverWith40Bars) {
  const auto maker = test::make_cantilever(test::get_report_section(), test::kReportLength, 40);
  const auto pairs = solve(maker.deck, 6);
  ASSERT_EQ(pairs.lambda.size(), 6);
  const double expected[] = {2.91022, 18.2380, 51.067};
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(get_rate(pairs, i) / expected[i / 2], 1, 2e-5) << i;
    EXPECT_LT(pairs.residual(i), 1e-7);
  }
  EXPECT_EQ(pairs.num_rigid, 0);
  EXPECT_EQ(pairs.inertia_count, 6);
}

// The lumped mass of CBAR converges as h²: the error falls fourfold with each halving.
TEST(BeamModes, LumpedMassConvergesAsHSquared) {
  double error[2];
  for (int i = 0; i < 2; ++i) {
    const auto maker = test::make_cantilever(test::get_report_section(), test::kReportLength, 20 << i, true);
    const double w = get_rate(solve(maker.deck, 2), 0);
    const double exact = 3.5160153 / 64 * std::sqrt(6.895e10 * 8.2181e-9 / (2766.67 * 7.2986e-5));
    error[i] = std::abs(w / exact - 1);
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.05);
}

// NAFEMS FV2, pin-ended double cross. Modes 2, 3 and 10, 11 move the centre, so they feel the axial flexibility that
// the table's 17.709 and 57.390 Hz leave out: roots of 4 EA k cot kL + 4 EI w'''(0) = 0 (fixed-turn, pinned arm)
// instead.
TEST(BeamModes, NafemsFv2DoubleCross) {
  DeckMaker maker;
  maker.add_section(1, make_square(0.125));
  maker.add_grid(1, Vector3d::Zero());
  for (int arm = 0; arm < 8; ++arm) {
    const Vector3d end(5 * std::cos(arm * kPi / 4), 5 * std::sin(arm * kPi / 4), 0);
    maker.add_line(1, 100 * (arm + 1), Vector3d::Zero(), end, 12, Vector3d::UnitZ(), 1);
    maker.fix(100 * (arm + 1) + 12, 12);
  }
  maker.fix_all(345);
  const auto pairs = solve(maker.deck, 16);
  expect_hz(pairs, 0, {11.33625}, 1e-4);
  expect_hz(pairs, 1, {17.680766, 17.680766}, 1e-4);
  expect_hz(pairs, 3, {17.70938, 17.70938, 17.70938, 17.70938, 17.70938}, 1e-4);
  expect_hz(pairs, 8, {45.34498}, 2e-4);
  expect_hz(pairs, 9, {57.074562, 57.074562}, 2e-4);
  expect_hz(pairs, 11, {57.38973, 57.38973, 57.38973, 57.38973, 57.38973}, 2e-4);
  EXPECT_EQ(pairs.inertia_count, 16);
}

// NAFEMS FV4, cantilever with off-centre masses; rotary inertia is in the table's values.
TEST(BeamModes, NafemsFv4OffCentreMasses) {
  const double d = 0.5, I = kPi * std::pow(d, 4) / 64;
  const Section round = {200e9, 200e9 / 2.6, 8000, kPi * d * d / 4, I, I, 2 * I};
  DeckMaker maker;
  maker.add_section(1, round, true);
  maker.add_line(1, 1, Vector3d::Zero(), 10 * Vector3d::UnitX(), 40, Vector3d::UnitY());
  maker.fix(1, 123456);
  maker.add_mass(1001, 41, 10000, {0, 2, 0});
  maker.add_mass(1002, 41, 1000, {0, -2, 0});
  const auto pairs = solve(maker.deck, 6);
  expect_hz(pairs, 0, {1.723, 1.727, 7.413, 9.972, 18.155, 26.957}, 3e-4);
}

// NAFEMS FV5, deep simply supported beam: Timoshenko with κ = 5/6 and rotary inertia; torsion of the true square
// section (the published 77.542 Hz takes J for the polar moment).
TEST(BeamModes, NafemsFv5DeepBeam) {
  DeckMaker maker;
  auto section = make_square(2);
  section.shear_factor = 5.0 / 6;
  section.J = 0.140577 * 16;
  maker.add_section(1, section, true);
  maker.add_line(1, 1, Vector3d::Zero(), 10 * Vector3d::UnitX(), 40, Vector3d::UnitY());
  maker.fix(1, 1234);
  maker.fix(41, 23);
  const auto pairs = solve(maker.deck, 9);
  expect_hz(pairs, 0, {42.609, 42.609, 71.20, 125.00, 147.786, 147.786}, 1e-3);
  expect_hz(pairs, 7, {282.36, 282.36}, 1e-3);
}

// Free-free: six rigid modes, exactly zero, then pairs at (βL)².
TEST(BeamModes, FreeFreeBeamHasSixZerosAndThePairs) {
  DeckMaker maker;
  Section section = {70e9, 27e9, 2700, 1e-4, 1e-11, 1e-11, 2e-11};
  maker.add_section(1, section, true);
  maker.add_line(1, 1, {2, 3, 4}, {4, 3, 4}, 60, Vector3d::UnitY());
  Diagnostics diagnostics;
  const auto model = fe::build_model(maker.deck, {}, diagnostics);
  EigenOptions options;
  options.num_modes = 12;
  const auto pairs = calc_normal_modes(model, options, diagnostics);
  ASSERT_EQ(pairs.num_rigid, 6);
  EXPECT_EQ(pairs.num_massless, 0);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(pairs.lambda(i), 0);
    EXPECT_LT(1e-6 * pairs.residual(i), 1e-12);  // of the forces that the diagonal of K would allow
  }
  const double scale = std::sqrt(section.E * section.I1 / (section.rho * section.A)) / 4;
  const double beta_L_squared[] = {22.3732854, 61.6728229, 120.9033916};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(get_rate(pairs, 6 + i) / (beta_L_squared[i / 2] * scale), 1, 1e-4) << i;
  EXPECT_EQ(pairs.inertia_count, 12);
  const MatrixXd gram = pairs.Phi.transpose() * fe::calc_mass_times(model, model.mass_kind(), pairs.Phi);
  EXPECT_LT((gram - MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff(), 1e-9);
}

// One system for several solutions: what is held of a motion without mass is held in a copy, and every number stays.
TEST(System, StaysAsItIs) {
  DeckMaker maker(true);
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-9, 1e-9, 2e-9});
  maker.add_line(1, 1, Vector3d::Zero(), Vector3d::UnitX(), 12, Vector3d::UnitY());
  Diagnostics diagnostics;
  const auto model = fe::build_model(maker.deck, {}, diagnostics);
  const fe::System system(model);
  modal::EigenOptions options;
  options.num_modes = 8;
  const auto own = calc_normal_modes(model, options, diagnostics);
  for (int i = 0; i < 2; ++i) {
    const auto pairs = calc_normal_modes(system, options, diagnostics);
    EXPECT_TRUE(pairs.lambda == own.lambda && pairs.Phi == own.Phi);
  }
  EXPECT_EQ(own.num_massless, 1);
  EXPECT_EQ(linear::get_diagonal(system.K).cwiseAbs(), system.K_diagonal);
  EXPECT_EQ(linear::get_diagonal(system.M), system.M_diagonal);
}

// A straight line of bars has no inertia about itself: five zeros and one massless motion, and the same bending.
TEST(BeamModes, MasslessTurnOfAFreeBarIsReported) {
  DeckMaker maker(true);
  const Section section = {70e9, 27e9, 2700, 1e-4, 1e-11, 1e-11, 2e-11};
  maker.add_section(1, section);
  maker.add_line(1, 1, Vector3d::Zero(), {1, 1, 1}, 60, Vector3d::UnitY());
  Diagnostics diagnostics;
  const auto pairs = solve(maker.deck, 9, diagnostics);
  EXPECT_EQ(pairs.num_rigid, 5);
  EXPECT_EQ(pairs.num_massless, 1);
  EXPECT_TRUE(diagnostics.has("modal.massless-motion"));
  const double scale = std::sqrt(section.E * section.I1 / (section.rho * section.A)) / 3;
  EXPECT_NEAR(get_rate(pairs, 5) / (22.3732854 * scale), 1, 1e-3);
  EXPECT_NEAR(get_rate(pairs, 6) / (22.3732854 * scale), 1, 1e-3);
}

// Share of the mass of each bending mode of a cantilever, and of its moment of inertia about the root.
TEST(BeamModes, EffectiveMassOfTheCantilever) {
  const Section section = {70e9, 27e9, 2700, 1e-4, 1e-9, 2e-9, 2e-9};
  const auto maker = test::make_cantilever(section, 2, 80);
  Diagnostics diagnostics;
  const auto model = fe::build_model(maker.deck, {}, diagnostics);
  EigenOptions options;
  options.num_modes = 14;
  const auto pairs = calc_normal_modes(model, options, diagnostics);
  const MatrixXd effective = modal::calc_effective_mass(model, pairs.Phi);
  const double m = section.rho * section.A * 2;
  const double translation[] = {0.613076, 0.188300, 0.064732, 0.033087, 0.020014};
  const double rotation[] = {0.970688, 0.024716, 0.003152, 0.000821, 0.000300};
  int y = 0, z = 0;
  for (int j = 0; j < 14; ++j) {
    if (y < 5 && effective(j, 1) > 1e-3 * m) {
      EXPECT_NEAR(effective(j, 1) / m, translation[y], 2e-5) << y;
      EXPECT_NEAR(effective(j, 5) / (m * 4 / 3), rotation[y], 2e-5) << y;
      ++y;
    }
    if (z < 5 && effective(j, 2) > 1e-3 * m) {
      EXPECT_NEAR(effective(j, 2) / m, translation[z], 2e-5) << z;
      EXPECT_NEAR(effective(j, 4) / (m * 4 / 3), rotation[z], 2e-5) << z;
      ++z;
    }
  }
  EXPECT_EQ(y, 5);
  EXPECT_EQ(z, 5);
}

}  // namespace
}  // namespace bough
