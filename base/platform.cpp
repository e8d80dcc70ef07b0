#include "base/platform.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#ifdef __APPLE__
#include <crt_externs.h>
#include <mach-o/dyld.h>
#include <mach/mach.h>
#include <malloc/malloc.h>
#include <xlocale.h>
#else
#include <link.h>
#include <locale.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif

namespace bough::platform {

namespace fs = std::filesystem;

std::from_chars_result read_number(const char* first, const char* last, double& value) {
#ifdef __cpp_lib_to_chars
  return std::from_chars(first, last, value);
#else
  return read_number_of_c(first, last, value);
#endif
}

std::from_chars_result read_number_of_c(const char* first, const char* last, double& value) {
  const char* digits = first + (first != last && *first == '-' ? 1 : 0);
  if (digits == last || *digits == '+' || *digits == '-' || std::isspace(static_cast<unsigned char>(*digits)) != 0)
    return {first, std::errc::invalid_argument};
  // strtod_l reads hexadecimal digits too, and "nan" with characters in parentheses that are letters or digits.
  if (last - digits > 1 && digits[0] == '0' && (digits[1] == 'x' || digits[1] == 'X')) last = digits + 1;
  const std::string text(first, last);
  static const locale_t c = newlocale(LC_ALL_MASK, "C", nullptr);
  char* end = nullptr;
  const int before = std::exchange(errno, 0);
  const double number = strtod_l(text.c_str(), &end, c);
  const bool is_out_of_range = std::exchange(errno, before) == ERANGE && (number == 0 || std::isinf(number));
  if (end == text.c_str()) return {first, std::errc::invalid_argument};
  const char* const next = first + (end - text.c_str());
  if (is_out_of_range) return {next, std::errc::result_out_of_range};
  value = number;
  return {next, std::errc()};
}

namespace {

[[maybe_unused]] bool set_close_on_exec(int (&ends)[2]) {
  return ::fcntl(ends[0], F_SETFD, FD_CLOEXEC) == 0 && ::fcntl(ends[1], F_SETFD, FD_CLOEXEC) == 0;
}

[[maybe_unused]] constexpr double kUnknown = std::numeric_limits<double>::infinity();

}  // namespace

#ifdef __APPLE__

const char* const kLibrarySuffix = ".dylib";
const char* const kFmi2Platform = "darwin64";
#ifdef __aarch64__
const char* const kFmi3Platform = "aarch64-darwin";
#else
const char* const kFmi3Platform = "x86_64-darwin";
#endif

std::string get_executable() {
  std::error_code failed;
  return find_executable(failed).string();
}

fs::path find_executable(std::error_code& failed) {
  std::uint32_t size = 0;
  _NSGetExecutablePath(nullptr, &size);
  std::string path(size, '\0');
  if (_NSGetExecutablePath(path.data(), &size) != 0) {
    failed = std::make_error_code(std::errc::no_such_file_or_directory);
    return {};
  }
  return fs::canonical(path.c_str(), failed);
}

std::vector<std::string> list_libraries() {
  std::vector<std::string> paths;
  for (std::uint32_t i = 0; i < _dyld_image_count(); ++i)
    if (const char* path = _dyld_get_image_name(i)) paths.emplace_back(path);
  return paths;
}

char** get_environment() { return *_NSGetEnviron(); }

bool open_pipe(int (&ends)[2]) { return ::pipe(ends) == 0 && set_close_on_exec(ends); }

bool open_socket_pair(int (&ends)[2]) {
  constexpr int kOn = 1;
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return false;
  for (const int end : ends) ::setsockopt(end, SOL_SOCKET, SO_NOSIGPIPE, &kOn, sizeof kOn);
  return set_close_on_exec(ends);
}

ssize_t send_quietly(int socket, const char* data, std::size_t size) { return ::send(socket, data, size, 0); }

short close_other_descriptors(posix_spawn_file_actions_t&) { return POSIX_SPAWN_CLOEXEC_DEFAULT; }

void end_with_parent() {}

void end_process(int code) noexcept {
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wdeprecated-declarations"
  while (true) ::syscall(1, code);  // SYS_exit
#pragma clang diagnostic pop
}

namespace {

mach_task_basic_info get_task() {
  mach_task_basic_info info{};
  mach_msg_type_number_t count = MACH_TASK_BASIC_INFO_COUNT;
  if (task_info(mach_task_self(), MACH_TASK_BASIC_INFO, reinterpret_cast<task_info_t>(&info), &count) != KERN_SUCCESS)
    return {};
  return info;
}

}  // namespace

double get_resident_bytes() { return static_cast<double>(get_task().resident_size); }
double get_address_space_bytes() { return static_cast<double>(get_task().virtual_size); }

double calc_free_bytes() {
  vm_statistics64 pages{};
  mach_msg_type_number_t count = HOST_VM_INFO64_COUNT;
  if (host_statistics64(mach_host_self(), HOST_VM_INFO64, reinterpret_cast<host_info64_t>(&pages), &count) !=
      KERN_SUCCESS)
    return kUnknown;
  return (static_cast<double>(pages.free_count) + static_cast<double>(pages.inactive_count)) *
         static_cast<double>(::sysconf(_SC_PAGESIZE));
}

void release_freed_memory() { malloc_zone_pressure_relief(nullptr, 0); }

void discard_pages(void* begin, void* end) {
  ::madvise(begin, static_cast<std::size_t>(static_cast<char*>(end) - static_cast<char*>(begin)), MADV_FREE);
}

void fill_fresh_memory() {}

bool lock_byte(int, off_t) {
  errno = ENOTSUP;
  return false;
}

bool is_byte_locked(int, off_t) { return false; }

bool sync_data(int descriptor) { return ::fcntl(descriptor, F_FULLFSYNC) == 0 || ::fsync(descriptor) == 0; }

void start_sync(int) {}

bool reserve_space(int descriptor, off_t size) {
  struct stat state {};
  if (::fstat(descriptor, &state) != 0) return false;
  fstore_t space{};
  space.fst_flags = F_ALLOCATEALL;
  space.fst_posmode = F_PEOFPOSMODE;
  space.fst_length = size - state.st_size;
  return space.fst_length <= 0 || ::fcntl(descriptor, F_PREALLOCATE, &space) == 0;
}

int open_nameless_file() {
  std::error_code failed;
  std::string path = (fs::temp_directory_path(failed) / "bough-XXXXXX").string();
  const int descriptor = ::mkstemp(path.data());
  if (descriptor < 0) return -1;
  ::unlink(path.c_str());
  ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
  return descriptor;
}

timespec get_change_time(const struct stat& state) { return state.st_mtimespec; }

#else

const char* const kLibrarySuffix = ".so";
#ifdef __aarch64__
const char* const kFmi2Platform = "linuxaarch64";
const char* const kFmi3Platform = "aarch64-linux";
#else
const char* const kFmi2Platform = "linux64";
const char* const kFmi3Platform = "x86_64-linux";
#endif

std::string get_executable() { return "/proc/self/exe"; }

fs::path find_executable(std::error_code& failed) { return fs::read_symlink("/proc/self/exe", failed); }

std::vector<std::string> list_libraries() {
  std::vector<std::string> paths;
  ::dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data) {
        static_cast<std::vector<std::string>*>(data)->emplace_back(info->dlpi_name);
        return 0;
      },
      &paths);
  return paths;
}

char** get_environment() { return ::environ; }

bool open_pipe(int (&ends)[2]) { return ::pipe2(ends, O_CLOEXEC) == 0; }

bool open_socket_pair(int (&ends)[2]) { return ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0; }

ssize_t send_quietly(int socket, const char* data, std::size_t size) {
  return ::send(socket, data, size, MSG_NOSIGNAL);
}

short close_other_descriptors(posix_spawn_file_actions_t& actions) {
  ::posix_spawn_file_actions_addclosefrom_np(&actions, 3);
  return 0;
}

void end_with_parent() { ::prctl(PR_SET_PDEATHSIG, SIGKILL); }

void end_process(int code) noexcept {
  while (true) ::syscall(SYS_exit_group, code);
}

namespace {

/// The number after `key` in a file of such lines; `otherwise` if there is none ("max" of a control group).
double read_number(const std::string& path, const std::string& key, double otherwise) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    double number = 0;
    if (!key.empty() && (!(words >> word) || word != key)) continue;
    return words >> number ? number : otherwise;
  }
  return otherwise;
}

/// Pages of address space and in RAM.
std::pair<double, double> read_pages() {
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return {size, resident};
}

double calc_free_of_groups() {
  std::ifstream file("/proc/self/cgroup");
  std::string group;
  for (std::string line; std::getline(file, line);)
    if (line.rfind("0::/", 0) == 0) group = line.substr(3);
  double min_free = kUnknown;
  while (!group.empty()) {
    const std::string folder = "/sys/fs/cgroup" + (group == "/" ? "" : group) + "/";
    const double max = read_number(folder + "memory.max", "", kUnknown);
    const double used =
        read_number(folder + "memory.current", "", 0) - read_number(folder + "memory.stat", "inactive_file", 0);
    min_free = std::min(min_free, max - used);
    group = group == "/" ? "" : group.substr(0, std::max<std::size_t>(group.rfind('/'), 1));
  }
  return min_free;
}

struct flock make_lock(off_t byte) {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  return lock;
}

}  // namespace

double get_resident_bytes() { return read_pages().second * static_cast<double>(::sysconf(_SC_PAGESIZE)); }
double get_address_space_bytes() { return read_pages().first * static_cast<double>(::sysconf(_SC_PAGESIZE)); }

double calc_free_bytes() {
  const double available = read_number("/proc/meminfo", "MemAvailable:", kUnknown);
  return std::min(1024 * (available + read_number("/proc/meminfo", "SwapFree:", 0)), calc_free_of_groups());
}

void release_freed_memory() {
#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 33)
  // The system takes pages back and gives them out again, cleared, for longer than a small model takes.
  constexpr std::size_t kWorthIt = std::size_t{16} << 20;
  if (::mallinfo2().fordblks < kWorthIt) return;
#endif
  ::malloc_trim(0);
#endif
}

void discard_pages(void* begin, void* end) {
  ::madvise(begin, static_cast<std::size_t>(static_cast<char*>(end) - static_cast<char*>(begin)), MADV_DONTNEED);
}

void fill_fresh_memory() {
#ifdef __GLIBC__
  ::mallopt(M_PERTURB, 0x5A);
#endif
}

bool lock_byte(int descriptor, off_t byte) {
  auto lock = make_lock(byte);
  return ::fcntl(descriptor, F_OFD_SETLK, &lock) == 0;
}

bool is_byte_locked(int descriptor, off_t byte) {
  auto lock = make_lock(byte);
  return ::fcntl(descriptor, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

bool sync_data(int descriptor) { return ::fdatasync(descriptor) == 0; }

void start_sync(int descriptor) {
#ifdef SYNC_FILE_RANGE_WRITE
  static_cast<void>(::sync_file_range(descriptor, 0, 0, SYNC_FILE_RANGE_WRITE));
#endif
}

bool reserve_space(int descriptor, off_t size) { return ::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, 0, size) == 0; }

int open_nameless_file() { return ::memfd_create("abandoned", MFD_CLOEXEC); }

timespec get_change_time(const struct stat& state) { return state.st_mtim; }

#endif

}  // namespace bough::platform
