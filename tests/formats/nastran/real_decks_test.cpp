/// \file Decks nobody here wrote, where the shared folder is present: counts and the values a person can see in them.
#include <filesystem>

#include "tests/formats/nastran/deck_text.hpp"
#include "tests/support/paths.hpp"

namespace bough::nastran {
namespace {

namespace fs = std::filesystem;

struct RealDeck {
  const char* path;
  std::map<std::string, int> counts;  ///< of reference.json and MANIFEST.md
  std::vector<std::string> unsupported;
};

void PrintTo(const RealDeck& deck, std::ostream* out) { *out << deck.path; }

class RealDecks : public testing::TestWithParam<RealDeck> {
 protected:
  static Read read_path(const std::string& path, const ReadOptions& options) {
    Read r;
    r.deck = read_deck(path, options, r.diagnostics);
    return r;
  }
};

TEST_P(RealDecks, ReadWithTheirCounts) {
  const auto path = fs::path(BOUGH_SHARED_DIR) / "models" / GetParam().path;
  if (!fs::exists(path)) GTEST_SKIP() << "no real decks at " << BOUGH_SHARED_DIR;
  const auto r = read_path(path.string(), {});
  for (const auto& [name, count] : GetParam().counts) {
    const auto found = r.deck.card_counts.find(name);
    ASSERT_NE(found, r.deck.card_counts.end()) << name;
    EXPECT_EQ(found->second, count) << name;
  }
  const auto at_least_zero = [&](const char* name) {
    const auto found = r.deck.card_counts.find(name);
    return static_cast<std::size_t>(found == r.deck.card_counts.end() ? 0 : found->second);
  };
  EXPECT_EQ(r.deck.grids.size(), at_least_zero("GRID"));
  EXPECT_EQ(r.deck.beams.size(), at_least_zero("CBAR") + at_least_zero("CBEAM"));
  EXPECT_EQ(r.deck.crod.size(), at_least_zero("CROD"));
  EXPECT_EQ(r.deck.cbush.size(), at_least_zero("CBUSH"));
  EXPECT_EQ(r.deck.conm2.size(), at_least_zero("CONM2"));
  EXPECT_EQ(r.deck.pbeaml.size(), at_least_zero("PBEAML"));
  EXPECT_EQ(r.deck.shells.size(), at_least_zero("CQUAD4") + at_least_zero("CTRIA3"));
  EXPECT_EQ(r.deck.solids.size(), at_least_zero("CHEXA"));
  EXPECT_EQ(r.deck.pshell.size(), at_least_zero("PSHELL"));
  EXPECT_EQ(r.count("deck.unsupported-card"), static_cast<int>(GetParam().unsupported.size())) << r.get_messages();
  EXPECT_EQ(r.diagnostics.num_errors(), static_cast<int>(GetParam().unsupported.size())) << r.get_messages();
  EXPECT_EQ(read_path(path.string(), {GetParam().unsupported}).diagnostics.num_errors(), 0);
}

INSTANTIATE_TEST_SUITE_P(
    Shared, RealDecks,
    testing::Values(
        RealDeck{"beam_modes/beam_modes.dat",
                 {{"GRID", 12}, {"PBARL", 1}, {"PROD", 1}, {"PBEAML", 1}, {"CBAR", 9}, {"CBEAM", 1}, {"CONM2", 1}},
                 {}},
        RealDeck{"plate_py/plate_py.dat", {{"GRID", 231}, {"PSHELL", 1}, {"CQUAD4", 200}}, {}},
        RealDeck{"svanberg_beam/modes.dat", {{"GRID", 6}, {"PBEAM", 5}, {"CBEAM", 5}}, {}},
        RealDeck{"three_element_types/noReduction-000.dat",
                 {{"GRID", 14}, {"PBEAM", 1}, {"PBAR", 1}, {"PROD", 1}, {"CROD", 6}, {"CBEAM", 4}, {"CBAR", 8}},
                 {}},
        RealDeck{"truss72/modes.dat", {{"GRID", 20}, {"PROD", 16}, {"CROD", 72}, {"SPC1", 20}, {"FORCE", 5}}, {}},
        RealDeck{"pt145/pt145.bdf", {{"GRID", 11}, {"CBAR", 10}, {"CMASS2", 10}, {"CORD2R", 1}, {"PBAR", 1}}, {}},
        RealDeck{"isat_launch_rgd/ISat_Launch_Sm_Rgd.dat",
                 {{"GRID", 5380},
                  {"CBAR", 827},
                  {"CBUSH", 104},
                  {"CORD2R", 75},
                  {"RBE2", 44},
                  {"PBARL", 18},
                  {"CONM2", 15},
                  {"MAT1", 14},
                  {"CQUAD4", 4580}},
                 {}},
        RealDeck{"kobayashi_wing/kobayashi_wing.dat",
                 {{"GRID", 348}, {"CBEAM", 251}, {"PBEAML", 46}, {"LOAD", 3}, {"GRAV", 1}},
                 {}},
        RealDeck{"wingbox/wingbox_stitched_together-000.bdf",
                 {{"GRID", 2675}, {"CQUAD4", 2464}, {"CBUSH", 193}, {"PBUSH", 2}, {"RBE2", 1}},
                 {}},
        RealDeck{"euler_column_105/euler_column_linear_buckling.bdf",
                 {{"GRID", 421}, {"CBEAM", 420}, {"SPCADD", 1}, {"EIGRL", 1}},
                 {}}));

TEST(RealDeckValues, WhatStandsInThem) {
  const auto models = fs::path(BOUGH_SHARED_DIR) / "models";
  if (!fs::exists(models)) GTEST_SKIP() << "no real decks at " << BOUGH_SHARED_DIR;
  const auto get = [&](const char* path) {
    Diagnostics diagnostics;
    return read_deck((models / path).string(), {}, diagnostics);
  };
  const auto beam = get("beam_modes/beam_modes.dat");
  EXPECT_EQ(beam.sol, "SEMODES");
  ASSERT_EQ(beam.files.size(), 2u);
  EXPECT_EQ(beam.eigen_methods[0].norm, "MAX");
  EXPECT_EQ(beam.conm2[0].inertia, (std::array<double, 6>{2.59e-3, 0, 2.59e-3, 0, 0, 2.59e-3}));
  EXPECT_EQ(beam.mat1[0].rho, 7.4851e-4);
  EXPECT_EQ(beam.find_param("K6ROT")->value, "100.0000");

  const auto svanberg = get("svanberg_beam/modes.dat");
  EXPECT_EQ(svanberg.pbeam[0].k1, 0.0);
  EXPECT_EQ(svanberg.pbeam[0].stations[1].J, 25000.0);
  EXPECT_DOUBLE_EQ(svanberg.mat1[0].G, 1440e6 / 2.66);

  const auto three = get("three_element_types/noReduction-000.dat");
  EXPECT_EQ(three.pbeam[0].stations.size(), 2u);
  EXPECT_EQ(three.pbeam[0].k1, .8499302);
  EXPECT_EQ(three.pbar[0].k2, .8507011);

  const auto pt145 = get("pt145/pt145.bdf");
  EXPECT_EQ(pt145.find_param("COUPMASS")->value, "1");
  EXPECT_EQ(pt145.subcases[0].method, 10);
  EXPECT_EQ(pt145.eigen_methods[0].num_modes, 6);
  EXPECT_EQ(pt145.beams[0].v, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(pt145.scalar_masses[9].m, 1.4e-6);

  const auto euler = get("euler_column_105/euler_column_linear_buckling.bdf");
  ASSERT_EQ(euler.subcases.size(), 2u);
  EXPECT_EQ(euler.subcases[0].load, 4);
  EXPECT_EQ(euler.subcases[1].method, 5);
  EXPECT_EQ(euler.subcases[1].spc, 3);
  EXPECT_EQ(euler.grids[100].ps, 0b011100u);
}

}  // namespace
}  // namespace bough::nastran
