/// \file Modes of one plate in several units of length: residuals are free of units by definition.
#include <gtest/gtest.h>

#include <cstdio>

#include "fe/statics/build_model.hpp"
#include "formats/nastran/reader.hpp"
#include "modal/eigen.hpp"
#include "tests/support/threads.hpp"

namespace bough {
namespace {

/// A cantilever of 60 x 60 square CQUAD4 (21,600 free dofs) of side h.
std::string make_plate(double h, double E, double rho) {
  constexpr int n = 60;
  char text[160];
  std::snprintf(text, sizeof text, "SOL 103\nCEND\nSPC=1\nBEGIN BULK\nMAT1,1,%.6e,,.3,%.6e\nPSHELL,1,1,%.6e,1,,1\n", E,
                rho, 0.2 * h);
  std::string deck = text;
  for (int k = 0; k < (n + 1) * (n + 1); ++k) {
    std::snprintf(text, sizeof text, "GRID,%d,,%.9e,%.9e,0.\n", k + 1, k % (n + 1) * h, k / (n + 1) * h);
    deck += text;
    if (k % (n + 1) == 0) deck += "SPC1,1,123456," + std::to_string(k + 1) + "\n";
    if (k % (n + 1) == n || k / (n + 1) == n) continue;
    std::snprintf(text, sizeof text, "CQUAD4,%d,1,%d,%d,%d,%d\n", k + 1, k + 1, k + 2, k + n + 3, k + n + 2);
    deck += text;
  }
  return deck + "ENDDATA\n";
}

// Elements of a micrometre in metres and in micrometres (MPa, kg), of a tenth of it, and of a metre in millimetres.
TEST(Units, ResidualsOfOnePlateAreSmallInAnyUnit) {
  double first = 0;
  for (const auto& [h, E, rho] : {std::tuple(1.0, 1.6e5, 2.33e-15), std::tuple(1e-6, 1.6e11, 2330.0),
                                  std::tuple(1e-7, 1.6e11, 2330.0), std::tuple(1e3, 1.6e5, 2.33e-9)}) {
    Diagnostics diagnostics;
    const auto deck = nastran::read_deck_text(make_plate(h, E, rho), "plate.bdf", {}, diagnostics);
    const auto model = fe::build_model(deck, {}, diagnostics);
    for (const int num : {1, 2}) {
      const test::Threads threads(num);
      modal::EigenOptions options;
      options.num_modes = 4;
      const auto pairs = calc_normal_modes(model, options, diagnostics);
      EXPECT_LT(pairs.residual.maxCoeff(), 1e-8) << h << ", " << num << " threads";
      const double scaled = pairs.lambda(0) * rho * h * h / E;  // free of units
      if (first == 0) first = scaled;
      EXPECT_NEAR(scaled / first, 1, 1e-6) << h << ", " << num << " threads";
    }
    EXPECT_FALSE(diagnostics.has("fe.residual")) << h;
  }
}

}  // namespace
}  // namespace bough
