/// Decks with shells that nobody here wrote: mass and centre of mass to 1e-6, frequencies against what came with them
/// (1 %). Where only MYSTRAN's are known the first mode is held to 3 %; the others are printed: two codes for the same
/// deck differ there by more than that (kobayashi_wing: MYSTRAN and NASTRAN-95 by 5 to 17 % from mode 4 on).
#include <cmath>
#include <filesystem>
#include <numbers>

#include "fe/statics/build_model.hpp"
#include "tests/plates/plate_deck.hpp"
#include "tests/support/paths.hpp"

namespace bough::test {
namespace {

struct RealDeck {
  const char* path;
  double mass;
  std::vector<double> cg, hz;
  double tolerance = 0.03;
  int num_rigid = 0;
  std::size_t num_held = 1;  ///< frequencies that are held to the tolerance
};

void PrintTo(const RealDeck& deck, std::ostream* out) { *out << deck.path; }

class RealShells : public testing::TestWithParam<RealDeck> {};

TEST_P(RealShells, MassAndFrequencies) {
  const auto& c = GetParam();
  const auto path = std::string(BOUGH_SHARED_DIR) + "/models/" + c.path;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck(path, {}, diagnostics);
  for (const auto& d : diagnostics.items())
    if (d.severity == Severity::Error) ADD_FAILURE() << format(d);
  const auto model = fe::build_model(deck, {}, diagnostics);
  const auto mass = fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  EXPECT_NEAR(mass.mass / model.wtmass() / c.mass, 1, 1e-6) << mass.mass;
  for (std::size_t i = 0; i < c.cg.size(); ++i)
    EXPECT_NEAR(mass.cg[static_cast<Eigen::Index>(i)], c.cg[i], 2e-6 * (1 + std::abs(c.cg[i]))) << i;
  modal::EigenOptions options;
  options.num_modes = static_cast<int>(c.hz.size()) + c.num_rigid;
  const auto pairs = calc_normal_modes(model, options, diagnostics);
  EXPECT_EQ(pairs.num_rigid, c.num_rigid);
  const VectorXd hz = pairs.lambda.tail(pairs.lambda.size() - pairs.num_rigid).cwiseSqrt() / (2 * std::numbers::pi);
  report(c.path, hz, c.hz);
  expect_close(c.path, hz, {c.hz.begin(), c.hz.begin() + static_cast<std::ptrdiff_t>(c.num_held)}, c.tolerance);
}

INSTANTIATE_TEST_SUITE_P(
    Shared, RealShells,
    testing::Values(
        RealDeck{"plate_py/plate_py.dat",
                 0.0001832874987,
                 {1.0, 0.5, 0.0},
                 {6333.012, 7495.461, 16238.46, 17161.51},
                 0.01,
                 6,
                 4},
        RealDeck{"wingbox/wingbox_stitched_together-000.bdf",
                 72.56635,
                 {127.0644, 47.99991, 22.59426},
                 {9.662301, 10.47457, 15.05121, 16.22512, 17.01967, 20.09837, 21.60446, 26.2407, 27.80335, 29.8343}},
        RealDeck{"kobayashi_wing/kobayashi_wing.dat",
                 27.63644322,
                 {204.9544594, 125.2430376, 0.0},
                 {2.615102, 11.81295, 14.25596, 26.71715, 30.60165, 33.97427, 35.66823, 35.8951, 37.03493, 39.43581}},
        RealDeck{"isat_launch_rgd/ISat_Launch_Sm_Rgd.dat",
                 1.7746011578,
                 {},
                 {8.469299, 9.681549, 20.93131, 21.81096, 21.89194, 21.90944, 24.54798, 26.47657, 26.70168, 31.64243}}),
    [](const auto& param) {
      const std::string path = param.param.path;
      return path.substr(0, path.find('/'));
    });

}  // namespace
}  // namespace bough::test
