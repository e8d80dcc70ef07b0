/// Load factors of columns and of lateral-torsional buckling against the classical results.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "fe/loads/loads.hpp"
#include "fe/statics/statics.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

constexpr double kPi = std::numbers::pi;

EigenPairs solve(const records::Deck& deck, int num_modes, Diagnostics& diagnostics, std::optional<double> low = {},
                 std::optional<double> high = {}) {
  const auto model = fe::build_model(deck, {}, diagnostics);
  const auto K = fe::assemble_stiffness(model, fe::DofSet::Free);
  const fe::StaticSolver solver(model, K);
  const auto load = calc_applied_load(model, deck, 10, diagnostics);
  const MatrixXd u = solver.solve(load.F);
  EigenOptions options;
  options.num_modes = num_modes;
  options.min_hz = low;
  options.max_hz = high;
  return calc_buckling_modes(model, load, u.col(0), options, diagnostics);
}

EigenPairs solve(const records::Deck& deck, int num_modes) {
  Diagnostics diagnostics;
  return solve(deck, num_modes, diagnostics);
}

// Bending in z is softer; y is held so that each column has simple roots.
const Section kSection = {70e9, 27e9, 2700, 1e-4, 4e-9, 1e-9, 2e-9};

DeckMaker make_column(int start, int end) {
  DeckMaker maker;
  maker.add_section(1, kSection);
  maker.add_line(1, 1, Vector3d::Zero(), 2 * Vector3d::UnitX(), 20, Vector3d::UnitY());
  maker.fix_all(246);
  maker.fix(1, start);
  if (end) maker.fix(21, end);
  maker.add_load(10, 21, {-1, 0, 0});
  return maker;
}

TEST(Buckling, EulerColumns) {
  const double euler = kPi * kPi * kSection.E * kSection.I2 / 4;
  struct Case {
    int start, end;
    double factor, second;
  };
  for (const auto& c :
       {Case{13, 3, 1, 4}, Case{135, 0, 0.25, 2.25}, Case{135, 35, 4, 8.18293}, Case{135, 3, 2.045752, 6.046838}}) {
    const auto pairs = solve(make_column(c.start, c.end).deck, 2);
    ASSERT_EQ(pairs.lambda.size(), 2);
    EXPECT_NEAR(pairs.lambda(0) / (c.factor * euler), 1, 1e-4) << c.factor;
    EXPECT_NEAR(pairs.lambda(1) / (c.second * euler), 1, 1e-3) << c.factor;
    EXPECT_EQ(pairs.inertia_count, 2);
    EXPECT_LT(pairs.residual.maxCoeff(), 1e-8);
  }
}

// Both planes alike: every load factor twice, both copies found, and φᵀKφ = 1.
TEST(Buckling, RoundColumnHasPairs) {
  DeckMaker maker;
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-9, 1e-9, 2e-9});
  maker.add_line(1, 1, Vector3d::Zero(), 2 * Vector3d::UnitX(), 30, Vector3d::UnitY());
  maker.fix(1, 123456);
  maker.add_load(10, 31, {-1, 0, 0});
  Diagnostics diagnostics;
  const auto pairs = solve(maker.deck, 6, diagnostics);
  const double base = kPi * kPi * 70 / 4 / 4;
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(pairs.lambda(i) / (base * (i / 2 * 2 + 1) * (i / 2 * 2 + 1)), 1, 1e-3) << i;
  EXPECT_EQ(pairs.inertia_count, 6);
  const auto model = fe::build_model(maker.deck, {}, diagnostics);
  const MatrixXd gram = pairs.Phi.transpose() * fe::calc_stiffness_times(model, pairs.Phi);
  EXPECT_LT((gram - MatrixXd::Identity(6, 6)).cwiseAbs().maxCoeff(), 1e-9);
}

// A pull never buckles: its load factors are negative, and found.
TEST(Buckling, SignTellsPushFromPull) {
  auto maker = make_column(13, 3);
  maker.deck.point_loads.front().n *= -1;
  const auto pairs = solve(maker.deck, 1);
  EXPECT_NEAR(pairs.lambda(0) / (-kPi * kPi * kSection.E * kSection.I2 / 4), 1, 1e-4);
}

// A pull with V1 = 0: an answer, and an empty one.
TEST(Buckling, LoadThatOnlyStiffensHasNoPositiveFactor) {
  auto maker = make_column(13, 3);
  maker.deck.point_loads.front().n *= -1;
  Diagnostics diagnostics;
  EXPECT_EQ(solve(maker.deck, 3, diagnostics, 0.0).lambda.size(), 0);
  EXPECT_TRUE(diagnostics.has("modal.empty-range"));
  EXPECT_EQ(solve(maker.deck, 3, diagnostics, std::nullopt, 0.0).lambda.size(), 3);
}

/// A narrow strip of length 1 along x, in 40 elements.
constexpr Section kStrip = {70e9, 27e9, 2700, 1e-4, 1e-6, 1e-10, 4e-10};
DeckMaker make_strip() {
  DeckMaker maker;
  maker.add_section(1, kStrip);
  maker.add_line(1, 1, Vector3d::Zero(), Vector3d::UnitX(), 40, Vector3d::UnitY());
  return maker;
}

// Timoshenko & Gere, Theory of Elastic Stability, 6.3: narrow strip, cantilever under an end load.
TEST(Buckling, LateralTorsionalCantilever) {
  auto maker = make_strip();
  maker.fix(1, 123456);
  maker.add_load(10, 41, {0, -1, 0});
  const auto pairs = solve(maker.deck, 2);
  const double expected = 4.0126 * std::sqrt(kStrip.E * kStrip.I2 * kStrip.G * kStrip.J);
  EXPECT_NEAR(std::abs(pairs.lambda(0)) / expected, 1, 2e-3);
  EXPECT_NEAR(pairs.lambda(0) / pairs.lambda(1), -1, 1e-6);  // up or down alike
  EXPECT_EQ(pairs.inertia_count, 2);

  // One sign alone, and a window that leaves the first out.
  Diagnostics diagnostics;
  const auto all = solve(maker.deck, 6, diagnostics);
  std::vector<double> up;
  for (const double lambda : all.lambda)
    if (lambda > 0) up.push_back(lambda);
  ASSERT_EQ(up.size(), 3);
  const auto positive = solve(maker.deck, 3, diagnostics, 0.0);
  ASSERT_EQ(positive.lambda.size(), 3);
  EXPECT_EQ(positive.inertia_count, 3);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(positive.lambda(j) / up[static_cast<std::size_t>(j)], 1, 1e-8);
  const auto window = solve(maker.deck, 5, diagnostics, 1.1 * up[0], 1.1 * up[1]);
  ASSERT_EQ(window.lambda.size(), 1);
  EXPECT_NEAR(window.lambda(0) / up[1], 1, 1e-8);
}

// Equal end moments on simply supported ends that cannot twist: π √(EI GJ) / L. The moment is bending of the strong
// axis; the end moments keep their directions.
TEST(Buckling, LateralTorsionalPureBending) {
  auto maker = make_strip();
  maker.fix(1, 1234);
  maker.fix(41, 234);
  maker.add_load(10, 1, {0, 0, 1}, true);
  maker.add_load(10, 41, {0, 0, -1}, true);
  const auto pairs = solve(maker.deck, 2);
  const double expected = kPi * std::sqrt(kStrip.E * kStrip.I2 * kStrip.G * kStrip.J);
  EXPECT_NEAR(std::abs(pairs.lambda(0)) / expected, 1, 2e-3);
}

TEST(Buckling, FreeModelIsAnError) {
  DeckMaker maker;
  maker.add_section(1, kSection);
  maker.add_line(1, 1, Vector3d::Zero(), Vector3d::UnitX(), 4, Vector3d::UnitY());
  Diagnostics diagnostics;
  const auto model = fe::build_model(maker.deck, {}, diagnostics);
  try {
    const fe::AppliedLoad load{Eigen::VectorXd::Zero(model.num_gdofs()), fe::Vector12d::Zero(), {}};
    modal::calc_buckling_modes(model, load, load.F, {}, diagnostics);
    FAIL() << "no error";
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().front().id, "modal.buckling-free");
  }
}

}  // namespace
}  // namespace bough
