/// A file that this process wrote itself is read without a look through it; one that has changed since is looked at.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "base/isolated.hpp"
#include "formats/hdf5/table_file.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::hdf5 {
namespace {

int g_looks = 0;

IsolatedResult count_look(const std::string&, IsolatedTask, const IsolationLimits&, const std::string&) {
  ++g_looks;
  return {};
}

TEST(TrustedFile, IsLookedAtOnlyAfterItChanged) {
  const IsolatedRunner before = set_isolated_runner(count_look);
  const test::TempFolder folder;
  const std::string path = folder.at("outcomes.h5"), copy = folder.at("copy.h5");
  OutcomeTable table;
  table.name = "study";
  table.cases = {1, 2};
  write_outcomes(table, path);
  const auto count_looks = [&](const std::string& file) {
    g_looks = 0;
    EXPECT_EQ(read_outcomes(file).cases, table.cases);
    return g_looks;
  };
  EXPECT_EQ(count_looks(path), 0) << "written by this process";

  std::filesystem::copy_file(path, copy);
  EXPECT_GT(count_looks(copy), 0) << "a copy was not";
  EXPECT_GT(count_looks(copy), 0) << "so new that a change would not show";
  using namespace std::chrono_literals;
  std::filesystem::last_write_time(copy, std::filesystem::file_time_type::clock::now() - 1h);
  EXPECT_EQ(count_looks(copy), 1) << "changed since";
  EXPECT_EQ(count_looks(copy), 0) << "seen, and not changed since";

  std::filesystem::rename(copy, path);
  EXPECT_EQ(count_looks(path), 0) << "the same file by another name";
  std::ofstream(path, std::ios::app | std::ios::binary) << "more";
  EXPECT_GT(count_looks(path), 0) << "bytes put after it";
  set_isolated_runner(before);
}

}  // namespace
}  // namespace bough::hdf5
