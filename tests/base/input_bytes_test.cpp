/// Input files are read once in a call, and again when they have changed.
#include "base/input_bytes.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/diagnostic.hpp"
#include "base/file_roles.hpp"

namespace bough {
namespace {

namespace fs = std::filesystem;

class InputBytes : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("bough-inputs-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    write("the text");
    opened_ = count_opened_inputs();
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& text) const { std::ofstream(path()) << text; }
  std::string path() const { return (folder_ / "a").string(); }
  std::size_t count() const { return count_opened_inputs() - opened_; }

  fs::path folder_;
  std::size_t opened_ = 0;
};

TEST_F(InputBytes, AreReadOnce) {
  const FileRoles roles;
  EXPECT_EQ(find_input(path()), nullptr);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(*read_input(path()), "the text");
  EXPECT_EQ(*read_input((folder_ / "." / "a").string()), "the text");
  EXPECT_EQ(*find_input(path()), "the text");
  EXPECT_EQ(count(), 1u);
}

TEST_F(InputBytes, AreReadAgainWhenTheFileHasChanged) {
  const FileRoles roles;
  const auto first = read_input(path());
  write("another text");
  EXPECT_EQ(find_input(path()), nullptr);
  EXPECT_EQ(*read_input(path()), "another text");
  EXPECT_EQ(*first, "the text");
  EXPECT_EQ(count(), 2u);
}

/// A session of Python has one FileRoles for each call.
TEST_F(InputBytes, AreKeptForOneCall) {
  {
    const FileRoles roles;
    read_input(path());
    const FileRoles inner;
    EXPECT_EQ(*find_input(path()), "the text");
  }
  EXPECT_EQ(find_input(path()), nullptr);
  EXPECT_EQ(*read_input(path()), "the text");
  EXPECT_EQ(*read_input(path()), "the text");
  EXPECT_EQ(count(), 3u);
}

/// The kind of a file is found first, by its first bytes: those of a text are read with the rest.
TEST_F(InputBytes, OfATextAreReadWithItsHead) {
  const FileRoles roles;
  EXPECT_EQ(read_input_head(path(), 3), "the");
  EXPECT_EQ(read_input_head(path(), 100), "the text");
  EXPECT_EQ(*read_input(path()), "the text");
  EXPECT_EQ(count(), 1u);
}

TEST_F(InputBytes, OfABinaryFileAreNotKept) {
  write(std::string(10'000, '\0'));
  const FileRoles roles;
  EXPECT_EQ(read_input_head(path(), 3).size(), 3u);
  EXPECT_EQ(find_input(path()), nullptr);
  EXPECT_EQ(read_input(path())->size(), 10'000u);
}

TEST_F(InputBytes, WithoutACallAreReadEachTime) {
  write(std::string(10'000, 'a'));
  EXPECT_EQ(read_input_head(path(), 5'000).size(), 5'000u);
  EXPECT_EQ(read_input(path())->size(), 10'000u);
  EXPECT_EQ(find_input(path()), nullptr);
  EXPECT_EQ(count(), 2u);
}

TEST_F(InputBytes, AreNoneOfFoldersAndMissingFiles) {
  EXPECT_EQ(read_input(folder_.string()), nullptr);
  EXPECT_EQ(read_input((folder_ / "b").string()), nullptr);
  EXPECT_EQ(read_input_head(folder_.string(), 8), "");
}

TEST_F(InputBytes, AreNoOutputToo) {
  const FileRoles roles;
  read_input(path());
  EXPECT_THROW(note_output(path()), InputError);
}

}  // namespace
}  // namespace bough
