// Eigenvectors of Nastran: files written by tests/oracle/nastran_modes_writer.py.
#include "formats/matrices/mode_table.hpp"

#include <cmath>
#include <fstream>
#include <random>

#include "tests/formats/matrices/matrix_cases.hpp"

namespace bough {
namespace {

using matrices::ModeTable;
using namespace test;

/// The writer's own formula.
double calc_shape(int node, int component, int mode) {
  return node == 3 && component > 0 ? 0 : ((7 * node + 3 * component + 5 * mode + 1) % 13 - 6) / 16.0;
}

void expect_modes(const ModeTable& table, int subcase, double factor) {
  EXPECT_EQ(table.subcase, subcase);
  EXPECT_EQ(table.mode, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(table.node_id, (std::vector<int>{11, 12, 40, 77}));
  EXPECT_EQ(table.is_scalar, (std::vector<bool>{false, false, false, true}));
  for (int j = 0; j < 3; ++j) {
    const double lambda = factor * 100 * std::pow(4.0, j);
    EXPECT_DOUBLE_EQ(table.eigenvalue(j), lambda);
    EXPECT_NEAR(table.frequency_hz(j), std::sqrt(lambda) / (2 * M_PI), 1e-6);
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < 6; ++c) EXPECT_EQ(table.phi[static_cast<std::size_t>(k)](c, j), calc_shape(k, c, j));
  }
}

std::string make(const TempFolder& folder, const std::string& kind, const std::string& options = {}) {
  const auto path = folder.at("modes");
  run_oracle("nastran_modes_writer.py " + kind + " " + path + " " + options);
  return path;
}

TEST(ModeTables, Op2OfBothOrdersAndWords) {
  const TempFolder folder;
  for (const char* options : {"", "-big", "-wide", "-big -wide", "-post2", "-nolama"}) {
    SCOPED_TRACE(options);
    const auto tables = matrices::read_mode_tables(make(folder, "op2", options));
    ASSERT_EQ(tables.size(), 1u);
    expect_modes(tables[0], 1, 1.0);
    EXPECT_FALSE(tables[0].is_basic);
    if (std::string(options) == "-nolama") {
      EXPECT_EQ(tables[0].generalized_mass.size(), 0);
    } else {
      EXPECT_EQ(tables[0].generalized_mass, Eigen::Vector3d(1, 2, 3));
    }
  }
  EXPECT_TRUE(matrices::read_mode_tables(make(folder, "op2", "-basic")).at(0).is_basic);
}

TEST(ModeTables, PunchOfTwoSubcases) {
  const TempFolder folder;
  const auto tables = matrices::read_mode_tables(make(folder, "punch"));
  ASSERT_EQ(tables.size(), 2u);
  expect_modes(tables[0], 1, 1.0);
  expect_modes(tables[1], 2, 2.0);
}

TEST(ModeTables, EachFaultHasItsError) {
  const TempFolder folder;
  const auto error = [](const std::string& path) { return find_error([&] { matrices::read_mode_tables(path); }); };
  EXPECT_EQ(error(make(folder, "op2", "-complex")), "matrices.op2");
  EXPECT_EQ(error(make(folder, "op2", "-sort2")), "matrices.op2");
  EXPECT_EQ(error(folder.write("x", std::string(20, '\0'))), "matrices.op2");
  EXPECT_EQ(error(folder.write("x", "$TITLE = nothing\n")), "matrices.no-modes");
  const std::string head = "$REAL OUTPUT\n$SUBCASE ID = 1\n$EIGENVALUE = 1.0E+01  MODE = 1\n",
                    row = "        11       G      1.0E+00  2.0E+00  3.0E+00\n";
  EXPECT_EQ(error(folder.write("x", head + row)), "matrices.truncated");
  EXPECT_EQ(error(folder.write("x", head + row + "-CONT-  1.0 2.0\n")), "matrices.bad-number");
  EXPECT_EQ(error(folder.write("x", head + "eleven G 1.0 2.0 3.0\n")), "matrices.bad-number");
  EXPECT_EQ(error(folder.write("x", head + row + "-CONT- 1. 2. 3.\n$EIGENVALUE = 2.0 MODE = 2\n")), "matrices.punch");
  EXPECT_EQ(error(folder.write("x", "$REAL-IMAGINARY OUTPUT\n$EIGENVALUE = 1.0 MODE = 1\n")), "matrices.punch");
}

TEST(ModeTables, DamagedOp2IsRefused) {
  const TempFolder folder;
  const auto path = make(folder, "op2");
  const auto whole = read_bytes(path);
  std::mt19937 random(11);
  for (int i = 0; i < 600; ++i) {
    auto damaged = whole;
    if (i % 3 == 0) {
      damaged.resize(random() % whole.size());
    } else {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    std::ofstream(path, std::ios::binary) << damaged;
    const auto id = find_error([&] { matrices::read_mode_tables(path); });
    EXPECT_TRUE(id.empty() || id.rfind("matrices.", 0) == 0) << id;
    EXPECT_TRUE(i % 3 != 0 || !id.empty()) << "cut at " << damaged.size() << " of " << whole.size();
  }
}

}  // namespace
}  // namespace bough
