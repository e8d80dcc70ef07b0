#include "base/part_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace bough {
namespace {

namespace fs = std::filesystem;

class PartFiles : public testing::Test {
 protected:
  PartFiles() {
    std::string pattern = (fs::temp_directory_path() / "bough-parts-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~PartFiles() override { fs::remove_all(folder_); }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return at(name);
  }
  static std::string read(const std::string& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  int count() const { return static_cast<int>(std::distance(fs::directory_iterator(folder_), {})); }

  fs::path folder_;
};

TEST_F(PartFiles, AppearsWholeOrNotAtAll) {
  write("a", "old");
  {
    PartFile part(at("a"));
    ASSERT_FALSE(part.error());
    EXPECT_TRUE(part.write("new", 3));
    EXPECT_EQ(read(at("a")), "old");
  }
  EXPECT_EQ(count(), 1);
  PartFile part(at("a"));
  EXPECT_TRUE(part.write("new", 3) && part.commit());
  EXPECT_EQ(read(at("a")), "new");
  EXPECT_EQ(count(), 1);
}

TEST_F(PartFiles, FollowsLinksAlsoToWhatIsNotThere) {
  fs::create_directory(folder_ / "far");
  fs::create_symlink("far/b", folder_ / "a");
  fs::create_symlink("a", folder_ / "c");
  std::error_code failed;
  EXPECT_EQ(fs::path(find_target(at("c"), failed)).lexically_normal(), folder_ / "far/b");
  PartFile part(at("c"));
  EXPECT_TRUE(part.write("x", 1) && part.commit());
  EXPECT_EQ(read(at("far/b")), "x");
  EXPECT_TRUE(fs::is_symlink(folder_ / "a") && fs::is_symlink(folder_ / "c"));
  fs::create_symlink("round", folder_ / "round");
  EXPECT_TRUE(PartFile(at("round")).error());
}

TEST_F(PartFiles, NoFileOrLinkInItsWayIsUsed) {
  write("victim", "mine");
  fs::create_symlink("victim", folder_ / ("a.bough-part-" + std::to_string(::getpid())));
  PartFile part(at("a"));
  EXPECT_TRUE(part.write("x", 1) && part.commit());
  EXPECT_EQ(read(at("a")), "x");
  EXPECT_EQ(read(at("victim")), "mine");
}

TEST_F(PartFiles, PartsOfTheDeadGoThoseOfTheLivingStay) {
  write("a.bough-part-77777777", "cut");
  write("a.bough-part-", "mine");
  PartFile first(at("a"));
  PartFile second(at("a"));  // of the same process
  EXPECT_FALSE(second.error());
  EXPECT_FALSE(fs::exists(at("a.bough-part-77777777")));
  EXPECT_TRUE(fs::exists(first.get_name()) && fs::exists(second.get_name()));
  EXPECT_NE(first.get_name(), second.get_name());
  remove_parts();
  EXPECT_FALSE(fs::exists(first.get_name()) || fs::exists(second.get_name()));
  EXPECT_TRUE(fs::exists(at("a.bough-part-")));
}

TEST_F(PartFiles, LongestNameOfAFileHasRoomForItsPart) {
  const std::string name(255, 'n');
  PartFile part(at(name));
  ASSERT_FALSE(part.error()) << part.error().message();
  EXPECT_TRUE(part.write("x", 1) && part.commit());
  EXPECT_EQ(read(at(name)), "x");
}

TEST_F(PartFiles, LockIsSeenByAnotherProcess) {
  const auto path = write("a", "x");
  const int held = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(lock_file(held), LockState::Held);
  const auto ask = [&] {
    const pid_t child = ::fork();
    if (child == 0) {
      const int other = ::open(path.c_str(), O_RDWR);
      ::_exit((is_file_locked(path) ? 1 : 0) + (lock_file(other) == LockState::Busy ? 2 : 0));
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WEXITSTATUS(status);
  };
  EXPECT_EQ(ask(), 3);
  ::close(held);
  EXPECT_EQ(ask(), 0);
}

}  // namespace
}  // namespace bough
