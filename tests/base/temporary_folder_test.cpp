#include "base/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/diagnostic.hpp"

namespace bough {
namespace {

namespace fs = std::filesystem;

TEST(TemporaryFolder, IsPrivateAndGoesWithAllThatIsInIt) {
  std::string path;
  {
    const TemporaryFolder one("bough-test", "tests"), other("bough-test", "tests");
    path = one.path();
    EXPECT_NE(path, other.path());
    EXPECT_EQ(fs::path(path).parent_path(), fs::temp_directory_path());
    EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
    fs::create_directories(path + "/a/b");
    std::ofstream(path + "/a/b/c") << "text";
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(TemporaryFolder, AFolderThatCannotBeMadeIsReported) {
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  ::setenv("TMPDIR", "/nowhere", 1);
  try {
    const TemporaryFolder folder("bough-test", "the samples");
    ADD_FAILURE() << "no error";
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items()[0].id, "cli.no-temporary-folder");
    EXPECT_NE(error.items()[0].what.find("the samples"), std::string::npos);
  }
  before != nullptr ? ::setenv("TMPDIR", kept.c_str(), 1) : ::unsetenv("TMPDIR");
}

}  // namespace
}  // namespace bough
