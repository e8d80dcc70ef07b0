/// \file The same structure in any units of length: translations and rotations scale by a length each, so whether it is
/// held cannot change (K(L) = S K(1) S, S diagonal).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fe/linear/row_kinds.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe {
namespace {

std::string show(double value) { return fmt::format("{:.7e}", value); }

std::string write_grid(int id, double x, double y, double z) {
  return "GRID," + std::to_string(id) + ",," + show(x) + "," + show(y) + "," + show(z) + "\n";
}

/// A warped plate of 4 x 4 CQUAD4, L wide and L/100 thick, held on its side x = 0 by `held`.
std::string make_plate(double L, const std::string& held) {
  std::string text = "SOL 101\nCEND\nSPC=1\nLOAD=2\nBEGIN BULK\nMAT1,1,1.6+11,,.22\n" + held;
  const int n = 4;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) text += write_grid(1 + i + 5 * j, L * i / n, L * j / n, 0.05 * L * i * j / n / n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = 1 + i + 5 * j;
      text += "CQUAD4," + std::to_string(a) + ",1," + std::to_string(a) + "," + std::to_string(a + 1) + "," +
              std::to_string(a + 6) + "," + std::to_string(a + 5) + "\n";
    }
  return text + "PSHELL,1,1," + show(0.01 * L) + ",1,,1\nFORCE,2,25,," + show(1e3 * L * L) + ",1.,2.,3.\nENDDATA\n";
}

/// Six CBAR on a line in space; `pin`: the last lets its end spin.
std::string make_line(double L, const std::string& pin) {
  std::string text = "SOL 101\nCEND\nSPC=1\nLOAD=2\nBEGIN BULK\nMAT1,1,1.6+11,,.22\nSPC1,1,123456,1\n";
  for (int i = 0; i <= 6; ++i) text += write_grid(i + 1, 0.9 * L * i, 0.3 * L * i, 0.1 * L * i);
  for (int i = 1; i <= 6; ++i)
    text += "CBAR," + std::to_string(i) + ",1," + std::to_string(i) + "," + std::to_string(i + 1) + ",0.,0.,1.\n" +
            (i == 6 ? pin : "");
  return text + "PBAR,1,1," + show(.01 * L * L) + "," + show(1e-5 * std::pow(L, 4)) + "," +
         show(2e-5 * std::pow(L, 4)) + "," + show(1.5e-5 * std::pow(L, 4)) + "\nFORCE,2,7,," + show(1e3 * L * L) +
         ",1.,2.,3.\nENDDATA\n";
}

/// Displacements, translations in units of L; empty where the model is told to be a mechanism.
VectorXd solve(const std::string& text, double L) {
  Diagnostics d;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, d);
  d.throw_if_errors();
  ModelOptions options;
  options.autospc = false;
  const Model model = build_model(deck, options, d);
  try {
    const StaticSolver solver(model, assemble_stiffness(model, DofSet::Free));
    VectorXd u = solver.solve(calc_static_load(model, deck, -1, d).F, &d);
    EXPECT_FALSE(d.has("fe.residual")) << L;
    for (Eigen::Index i = 0; i < u.size(); ++i)
      if (i % 6 < 3) u[i] /= L;
    return u;
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().front().id, "fe.mechanism") << error.what();
    return {};
  }
}

constexpr double kSizes[] = {1e-9, 1e-6, 1e-5, 1e-4, 1e-3, 1, 1e3, 1e6, 1e7, 1e8};

TEST(UnitsMpi, SoundStructuresAreSoundInAnyUnits) {
  const std::string clamped = "SPC1,1,123456,1,6,11,16,21\n";
  const VectorXd plate = solve(make_plate(1, clamped), 1), line = solve(make_line(1, ""), 1);
  ASSERT_GT(plate.size(), 0);
  ASSERT_GT(line.size(), 0);
  for (const double L : kSizes) {
    const VectorXd p = solve(make_plate(L, clamped), L), b = solve(make_line(L, ""), L);
    ASSERT_EQ(p.size(), plate.size()) << L;
    ASSERT_EQ(b.size(), line.size()) << L;
    EXPECT_LT((p - plate).cwiseAbs().maxCoeff(), 1e-6 * plate.cwiseAbs().maxCoeff()) << L;
    EXPECT_LT((b - line).cwiseAbs().maxCoeff(), 1e-6 * line.cwiseAbs().maxCoeff()) << L;
  }
}

TEST(UnitsMpi, MechanismsAreMechanismsInAnyUnits) {
  for (const double L : kSizes) {
    if (L < 1e-6) continue;  // rotations of 1e-22 of the translations: MUMPS calls the shifted matrix singular too
    EXPECT_EQ(solve(make_plate(L, "SPC1,1,123,1\nSPC1,1,1,21\n"), L).size(), 0) << L;  // turns about two axes
    EXPECT_EQ(solve(make_plate(L, "SPC1,1,1346,1,6,11,16,21\n"), L).size(), 0) << L;   // slides along the side
    EXPECT_EQ(solve(make_line(L, ",,4\n"), L).size(), 0) << L;                         // the end spins
  }
}

TEST(RowKinds, RowsAreJudgedAmongTheirKind) {
  const auto T = linear::RowKind::Translation, R = linear::RowKind::Rotation, S = linear::RowKind::Scalar;
  const Eigen::VectorXd D = (Eigen::VectorXd(6) << 1e5, 1e-12, -2e5, 1e-12, 1e-30, 0).finished();
  const linear::RowKinds kinds{T, T, T, R, R, S};
  const Eigen::VectorXd filled = (Eigen::VectorXd(6) << 1e5, 2e5, 2e5, 1e-12, 1e-12, 2e5).finished();
  EXPECT_EQ(linear::fill_diagonal(D, kinds), filled);
  EXPECT_EQ(linear::fill_diagonal(Eigen::VectorXd::Zero(2), {}), Eigen::VectorXd::Ones(2));
  const Eigen::VectorXd raised = (Eigen::VectorXd(6) << 1e5, 10, 10, 1e-12, 1e-16, 0).finished();
  EXPECT_TRUE(linear::raise_diagonal(D, kinds, 1e-4).isApprox(raised, 1e-12));
}

}  // namespace
}  // namespace bough::fe
