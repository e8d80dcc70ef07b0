/// Outputs do not overwrite the inputs of the call, by whatever name.
#include "base/file_roles.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/diagnostic.hpp"
#include "base/part_file.hpp"

namespace bough {
namespace {

namespace fs = std::filesystem;

class FileRolesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("bough-roles-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    std::ofstream(get("a")) << "text";
    fs::create_symlink("a", folder_ / "link");
    fs::create_hard_link(folder_ / "a", folder_ / "hard");
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string get(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

TEST_F(FileRolesTest, WhatIsReadIsNotWritten) {
  const FileRoles roles;
  note_input(get("a"));
  for (const char* name : {"a", "link", "hard"}) {
    EXPECT_THROW(note_output(get(name)), InputError) << name;
    EXPECT_THROW(PartFile{get(name)}, InputError) << name;
  }
  note_output(get("absent"));
}

TEST_F(FileRolesTest, WhatIsToBeWrittenIsNotRead) {
  const FileRoles roles;
  note_output(get("link"));
  EXPECT_THROW(note_input(get("a")), InputError);
  PartFile part(get("a"));
  ASSERT_TRUE(part.write("new", 3) && part.commit());
  note_input(get("a"));  // another file now, and ours
}

TEST_F(FileRolesTest, SomeAreBoth) {
  const FileRoles roles;
  FileRoles::allow_both(get("a"));
  note_input(get("a"));
  note_output(get("hard"));
}

TEST_F(FileRolesTest, EachCallHasItsOwn) {
  note_input(get("a"));
  note_output(get("a"));
  const FileRoles outer;
  note_input(get("a"));
  {
    const FileRoles inner;
    note_output(get("a"));
  }
  EXPECT_THROW(note_output(get("a")), InputError);
}

TEST_F(FileRolesTest, AFolderConfinesAllFiles) {
  fs::create_directories(folder_ / "inner");
  std::ofstream(get("inner/b")) << "text";
  fs::create_symlink("../a", folder_ / "inner/out");
  fs::create_symlink("../none", folder_ / "inner/dangling");
  confine_files(get("inner"));
  EXPECT_NO_THROW(note_input(get("inner/b")));
  EXPECT_NO_THROW(note_output(get("inner/new")));
  for (const char* name : {"a", "inner/../a", "inner/out", "inner/dangling", "inner/../inner2"}) {
    EXPECT_THROW(note_input(get(name)), InputError) << name;
    EXPECT_THROW(note_output(get(name)), InputError) << name;
  }
  confine_files({});
  EXPECT_NO_THROW(note_input(get("a")));
}

}  // namespace
}  // namespace bough
