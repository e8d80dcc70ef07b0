/// Load factors of heated structures against the classical results.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/reader.hpp"
#include "modal/eigen.hpp"

namespace bough {
namespace {

constexpr double kPi = std::numbers::pi;

double calc_factor(const std::string& text) {
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  const auto model = fe::build_model(deck, {}, diagnostics);
  const auto load = fe::calc_static_load(model, deck, -1, diagnostics);
  diagnostics.throw_if_errors();
  const fe::StaticSolver solver(model, fe::assemble_stiffness(model, fe::DofSet::Free));
  const auto u = fe::solve_static_case(model, solver, load).displacement;
  modal::EigenOptions options;
  options.num_modes = 1;
  return modal::calc_buckling_modes(model, load, u, options, diagnostics, &load.initial).lambda[0];
}

TEST(ThermalBuckling, ColumnBetweenWalls) {
  // α ΔT = π² I / (A L²), ends pinned (S. Timoshenko & J. Gere, "Theory of elastic stability", 2nd ed., 2.1).
  std::string text =
      "SPC = 1\nTEMP(LOAD) = 5\nBEGIN BULK\nMAT1,1,7.+10,,.3,,1.2-5,20.\nPBAR,1,1,1.-4,1.-8,5.-9,1.-8\n"
      "TEMPD,5,21.\nSPC1,1,246,1,THRU,17\nSPC1,1,13,1,17\n";
  for (int i = 1; i <= 17; ++i) {
    text += "GRID," + std::to_string(i) + ",," + std::to_string(0.125 * (i - 1)) + ",0.,0.\n";
    if (i > 1)
      text += "CBAR," + std::to_string(i) + ",1," + std::to_string(i - 1) + "," + std::to_string(i) + ",0.,1.,0.\n";
  }
  EXPECT_NEAR(calc_factor(text), kPi * kPi * 5e-9 / (1e-4 * 4 * 1.2e-5), 1e-3);
}

TEST(ThermalBuckling, PlateBetweenWalls) {
  // Simply supported square, its edges held in the plane: N = -E α t ΔT / (1 - ν) both ways, critical at 2 π² D / a²:
  // α ΔT = π² t² / (6 (1 + ν) a²) (B. Boley & J. Weiner, "Theory of thermal stresses", 13.5).
  const int n = 12;
  std::string text =
      "SPC = 1\nTEMP(LOAD) = 5\nBEGIN BULK\nMAT1,1,7.+10,,.3,,1.2-5,20.\nPSHELL,1,1,.01,1\nTEMPD,5,21.\n"
      "SPC1,1,126,1,THRU,169\n";
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const int id = 1 + j + (n + 1) * i;
      text += "GRID," + std::to_string(id) + ",," + std::to_string(double(j) / n) + "," +
              std::to_string(double(i) / n) + ",0.\n";
      if (i == 0 || j == 0 || i == n || j == n) text += "SPC1,1,3," + std::to_string(id) + "\n";
      if (i < n && j < n)
        text += "CQUAD4," + std::to_string(id) + ",1," + std::to_string(id) + "," + std::to_string(id + 1) + "," +
                std::to_string(id + n + 2) + "," + std::to_string(id + n + 1) + "\n";
    }
  const double expected = kPi * kPi * 1e-4 / (6 * 1.3 * 1.2e-5);
  EXPECT_NEAR(calc_factor(text) / expected, 1, 0.01);
}

}  // namespace
}  // namespace bough
