/// A file that this process wrote itself is read without a look through it; one that has changed since is looked at.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "formats/hdf5/detail/inspect.hpp"
#include "formats/hdf5/table_file.hpp"
#include "tests/formats/files/temp_folder.hpp"

namespace bough::hdf5 {
namespace {

int g_looks = 0;

Look count_look(const std::string&, double) {
  ++g_looks;
  return {};
}

TEST(TrustedFile, IsLookedAtOnlyAfterItChanged) {
  const Looker before = set_looker(count_look);
  g_looks = 0;
  const test::TempFolder folder;
  const std::string path = folder.at("outcomes.h5"), copy = folder.at("copy.h5");
  OutcomeTable table;
  table.name = "study";
  table.cases = {1, 2};
  write_outcomes(table, path);
  EXPECT_EQ(read_outcomes(path).cases, table.cases);
  EXPECT_EQ(g_looks, 0);

  std::filesystem::copy_file(path, copy);
  EXPECT_EQ(read_outcomes(copy).cases, table.cases);
  EXPECT_EQ(g_looks, 1) << "a copy was not written by this process";
  EXPECT_EQ(read_outcomes(copy).cases, table.cases);
  EXPECT_EQ(g_looks, 1) << "seen, and not changed since";

  std::filesystem::rename(copy, path);
  EXPECT_EQ(read_outcomes(path).cases, table.cases);
  EXPECT_EQ(g_looks, 1) << "the same file by another name";
  std::ofstream(path, std::ios::app | std::ios::binary) << "more";
  (void)read_outcomes(path);
  EXPECT_EQ(g_looks, 2) << "bytes put behind it";
  set_looker(before);
}

}  // namespace
}  // namespace bough::hdf5
