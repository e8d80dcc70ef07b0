#include <filesystem>

#include <gtest/gtest.h>

#include "fe/matrices/assembly.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/statics.hpp"
#include "formats/nastran/reader.hpp"
#include "tests/support/paths.hpp"

namespace bough::fe {
namespace {

/// Mass and centre of mass that other programs give for decks nobody here wrote (shared folder, models/reference.json).
struct RealDeck {
  const char* file;
  double mass;
  Vector3d cg;
  bool has_cg;
  int num_fdofs;  ///< counted by hand from the deck: 0 = not checked
};

void PrintTo(const RealDeck& deck, std::ostream* out) { *out << deck.file; }

class RealDecks : public ::testing::TestWithParam<RealDeck> {};

TEST_P(RealDecks, mass_and_centre) {
  const std::string path = std::string(BOUGH_SHARED_DIR) + "/models/" + GetParam().file;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared decks here: " << path;
  Diagnostics d;
  const auto deck = nastran::read_deck(path, {}, d);
  for (const auto& item : d.items())
    if (item.severity == Severity::Error) ADD_FAILURE() << format(item);
  const Model model = build_model(deck, {}, d);
  const auto properties = calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  EXPECT_NEAR(properties.mass / GetParam().mass, 1, 1e-6);
  if (GetParam().has_cg) {
    EXPECT_LT((properties.cg - GetParam().cg).norm(), 1e-6 * GetParam().cg.norm());
  }
  if (GetParam().num_fdofs) {
    EXPECT_EQ(model.num_fdofs(), GetParam().num_fdofs);
  }
  EXPECT_LT(calc_ground_check(model).maxCoeff(), 1e-12);
  // Fixed models: the stiffness left after AUTOSPC is not singular.
  EXPECT_NO_THROW(StaticSolver(model, assemble_stiffness(model, DofSet::Free)));
}

INSTANTIATE_TEST_SUITE_P(
    Shared, RealDecks,
    ::testing::Values(
        // 11 grids on the beam, one clamped; grid 12 hangs on nothing.
        RealDeck{"beam_modes/beam_modes.dat", 0.02610513597, {5.496070952, 0, 0}, true, 60},
        RealDeck{"svanberg_beam/modes.dat", 402809.1073, {2.5, 0, 0}, true, 30},
        RealDeck{"three_element_types/noReduction-000.dat", 6635.253692, {1860.574497, -180, 0}, true, 0},
        // 20 grids, four of them held; rods give no rotations.
        RealDeck{"truss72/modes.dat", 1.104750943, {60, 60, 131.5262636}, true, 48},
        RealDeck{"pt145/pt145.bdf", 0.0001071170442, {0.7402220602, 2.762547962, 0}, true, 30},
        RealDeck{"euler_column_105/euler_column_linear_buckling.bdf", 102.918575332, Vector3d::Zero(), false, 0}));

}  // namespace
}  // namespace bough::fe
