#include "base/platform.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>

#include "base/temporary_folder.hpp"

namespace bough::platform {
namespace {

void expect_as_from_chars(const std::string& text) {
  double expected = -7, found = -7;
  const auto a = std::from_chars(text.data(), text.data() + text.size(), expected);
  const auto b = read_number_of_c(text.data(), text.data() + text.size(), found);
  EXPECT_EQ(a.ec, b.ec) << text;
  EXPECT_EQ(a.ptr - text.data(), b.ptr - text.data()) << text;
  EXPECT_EQ(0, std::memcmp(&expected, &found, sizeof found)) << text << ": " << expected << ", " << found;
}

TEST(Platform, ReadsNumbersAsTheStandardLibrary) {
  for (const char* text : {"1",
                           "-1",
                           "+1",
                           "--1",
                           "-+1",
                           "",
                           "-",
                           ".",
                           ".5",
                           "5.",
                           "1.e5",
                           "1e",
                           "1e+",
                           "1e-3x",
                           "1d5",
                           "0x10",
                           "-0x1p3",
                           "0X",
                           " 1",
                           "\t2",
                           "1 2",
                           "1,5",
                           "inf",
                           "-inf",
                           "infinity",
                           "nan",
                           "-nan",
                           "1e400",
                           "-1e400",
                           "1e-400",
                           "4.9e-324",
                           "0",
                           "2.2250738585072011e-308",
                           "1.7976931348623157e308",
                           "123456789012345678901234567890",
                           "-0",
                           "0.1",
                           "e5",
                           "abc"})
    expect_as_from_chars(text);
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::uint64_t> bits;
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t pattern = bits(random);
    double value = 0;
    std::memcpy(&value, &pattern, sizeof value);
    if (!std::isfinite(value)) continue;
    char text[40];
    std::snprintf(text, sizeof text, i % 2 == 0 ? "%.17g" : "%.20e", value);
    expect_as_from_chars(text);
  }
}

TEST(Platform, NoProgramInheritsPipesAndSockets) {
  int pipe[2], sockets[2];
  ASSERT_TRUE(open_pipe(pipe));
  ASSERT_TRUE(open_socket_pair(sockets));
  for (const int end : {pipe[0], pipe[1], sockets[0], sockets[1]})
    EXPECT_EQ(FD_CLOEXEC, ::fcntl(end, F_GETFD) & FD_CLOEXEC);
  ::close(sockets[1]);
  EXPECT_EQ(-1, send_quietly(sockets[0], "x", 1));  // SIGPIPE would end the test
  EXPECT_EQ(EPIPE, errno);
  for (const int end : {pipe[0], pipe[1], sockets[0]}) ::close(end);
}

TEST(Platform, FindsTheProgramItsLibrariesAndItsEnvironment) {
  std::error_code failed;
  const auto program = find_executable(failed);
  EXPECT_FALSE(failed);
  EXPECT_TRUE(std::filesystem::equivalent(program, get_executable()));
  EXPECT_EQ(0, ::access(get_executable().c_str(), X_OK));
  EXPECT_FALSE(list_libraries().empty());
  ::setenv("BOUGH_PLATFORM_TEST", "here", 1);
  bool is_there = false;
  for (char** entry = get_environment(); *entry != nullptr; ++entry)
    is_there = is_there || std::strcmp(*entry, "BOUGH_PLATFORM_TEST=here") == 0;
  EXPECT_TRUE(is_there);
}

TEST(Platform, EndsAProcessWithoutTheLibrary) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::atexit([] { ::_exit(1); });
    end_process(7);
  }
  int status = 0;
  ASSERT_EQ(child, ::waitpid(child, &status, 0));
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7);
}

TEST(Platform, MeasuresMemory) {
  constexpr std::size_t kSize = std::size_t{32} << 20;
  void* const room = ::mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(MAP_FAILED, room);
  const double before = get_resident_bytes();
  std::memset(room, 1, kSize);
  const double full = get_resident_bytes();
  EXPECT_GT(full - before, 0.9 * kSize);
  EXPECT_GE(get_address_space_bytes(), full);
  discard_pages(room, static_cast<char*>(room) + kSize);
  EXPECT_LT(get_resident_bytes(), full - 0.5 * kSize);
  ::munmap(room, kSize);
  EXPECT_GT(calc_free_bytes(), 0);
}

TEST(Platform, LocksAByteAndReservesSpace) {
  const TemporaryFolder folder("bough-platform", "the test");
  const std::string path = folder.path() + "/file";
  const int a = ::open(path.c_str(), O_RDWR | O_CREAT, 0600), b = ::open(path.c_str(), O_RDWR);
  ASSERT_TRUE(a >= 0 && b >= 0);
  EXPECT_FALSE(is_byte_locked(b, 5));
  ASSERT_TRUE(lock_byte(a, 5));
  EXPECT_TRUE(is_byte_locked(b, 5));
  EXPECT_FALSE(is_byte_locked(b, 6));
  EXPECT_FALSE(lock_byte(b, 5));
  EXPECT_TRUE(errno == EAGAIN || errno == EACCES);
  ::close(a);
  EXPECT_TRUE(lock_byte(b, 5));
  EXPECT_TRUE(reserve_space(b, 10000) || errno == EOPNOTSUPP);
  struct stat state {};
  ASSERT_EQ(0, ::fstat(b, &state));
  EXPECT_EQ(0, state.st_size);
  EXPECT_EQ(3, ::write(b, "abc", 3));
  start_sync(b);
  EXPECT_TRUE(sync_data(b) || errno == EINVAL);
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  ASSERT_EQ(0, ::fstat(b, &state));
  EXPECT_LE(get_change_time(state).tv_sec, now.tv_sec);
  EXPECT_GE(get_change_time(state).tv_sec, state.st_ctime - 1);
  ::close(b);
}

TEST(Platform, OpensAFileWithoutAName) {
  const int file = open_nameless_file();
  ASSERT_GE(file, 0);
  struct stat state {};
  ASSERT_EQ(0, ::fstat(file, &state));
  EXPECT_EQ(0U, state.st_nlink);
  char text[4] = {};
  EXPECT_EQ(3, ::pwrite(file, "abc", 3, 0));
  EXPECT_EQ(3, ::pread(file, text, 3, 0));
  EXPECT_STREQ("abc", text);
  ::close(file);
}

}  // namespace
}  // namespace bough::platform
