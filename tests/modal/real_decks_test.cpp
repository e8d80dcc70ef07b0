/// Decks that nobody here wrote, against the frequencies that came with them (first ten, 1e-4), and a column of 420
/// beams against Engesser's formula and MYSTRAN's load factors.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "fe/loads/loads.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/statics.hpp"
#include "formats/nastran/reader.hpp"
#include "modal/eigen.hpp"
#include "tests/support/paths.hpp"

namespace bough {
namespace {

struct RealDeck {
  const char* path;
  std::vector<double> hz;
};

void PrintTo(const RealDeck& deck, std::ostream* out) { *out << deck.path; }

std::string find_deck(const std::string& path) { return std::string(BOUGH_SHARED_DIR) + "/models/" + path; }

class RealDecks : public ::testing::TestWithParam<RealDeck> {};

TEST_P(RealDecks, FrequenciesOfTheVendor) {
  const auto path = find_deck(GetParam().path);
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck(path, {}, diagnostics);
  diagnostics.throw_if_errors();
  const auto model = fe::build_model(deck, {}, diagnostics);
  modal::EigenOptions options;
  options.num_modes = 10;
  const auto pairs = calc_normal_modes(model, options, diagnostics);
  ASSERT_EQ(pairs.lambda.size(), 10);
  for (int i = 0; i < 10; ++i) {
    const double hz = std::sqrt(pairs.lambda(i)) / (2 * std::numbers::pi);
    EXPECT_NEAR(hz / GetParam().hz[i], 1, 1e-4) << "mode " << i + 1 << ": " << hz;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shipped, RealDecks,
    ::testing::Values(
        RealDeck{"beam_modes/beam_modes.dat",
                 {456.6603, 456.6603, 2674.588, 2674.588, 3554.923, 4507.487, 6626.104, 6626.104, 11111.59, 11111.59}},
        RealDeck{"svanberg_beam/modes.dat",
                 {46.4644, 146.9333, 279.0229, 752.9903, 815.3514, 882.3479, 1405.45, 1507.328, 2059.242, 2366.242}},
        RealDeck{
            "three_element_types/noReduction-000.dat",
            {0.1987976, 0.3974492, 0.7054771, 0.8603456, 1.717969, 1.98085, 2.199863, 3.712462, 4.380781, 4.407542}},
        RealDeck{"truss72/modes.dat",
                 {25.4557, 25.4557, 38.94089, 68.55535, 73.7052, 73.7052, 111.0227, 127.6247, 136.6591, 136.6591}},
        RealDeck{"pt145/pt145.bdf",
                 {39.96147, 236.4137, 250.4423, 701.4011, 703.4198, 1153.105, 1375.426, 1574.398, 1956.923, 2277.239}}),
    [](const auto& param) {
      const std::string path = param.param.path;
      return path.substr(0, path.find('/'));
    });

TEST(RealDecks, ColumnBucklingOf420Beams) {
  const auto path = find_deck("euler_column_105/euler_column_linear_buckling.bdf");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck(path, {}, diagnostics);
  diagnostics.throw_if_errors();
  const auto model = fe::build_model(deck, {}, diagnostics);
  const auto K = fe::assemble_stiffness(model, fe::DofSet::Free);
  const fe::StaticSolver solver(model, K);
  const auto load = calc_applied_load(model, deck, deck.subcases.front().load, diagnostics);
  const auto u = solver.solve(load.F);
  modal::EigenOptions options;
  options.num_modes = 5;
  const auto pairs = calc_buckling_modes(model, load, u.col(0), options, diagnostics);
  ASSERT_EQ(pairs.lambda.size(), 5);
  // Engesser's column with the circle's shear factor 0.9; MYSTRAN's figures are of a deck converted with factor 1.
  const double mystran[] = {90632.44, 358617.4, 792554.8, 1374530.0, 2081608.0};
  const double E = 207000, GA = E / 2.6 * std::numbers::pi * 100, I = std::numbers::pi * 1e4 / 4;
  for (int i = 0; i < 5; ++i) {
    const double euler = std::pow((i + 1) * std::numbers::pi / 420, 2) * E * I;
    EXPECT_NEAR(pairs.lambda(i) / (euler / (1 + euler / (0.9 * GA))), 1, 1e-4) << i;
    EXPECT_NEAR(pairs.lambda(i) / mystran[i] * (1 + euler / (0.9 * GA)) / (1 + euler / GA), 1, 2e-3) << i;
  }
}

}  // namespace
}  // namespace bough
