#pragma once
/// \file Differences between Linux, macOS and their processors. The only header with functions of one system: the rest
/// of Bough calls POSIX and the standard library (tests/architecture/portability.py).
#include <spawn.h>
#include <sys/stat.h>
#include <sys/types.h>

#include <cfloat>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

/// Attribute of functions that are compiled for AVX2 and FMA; absent on other processors, and with BOUGH_NARROW.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(BOUGH_NARROW)
#define BOUGH_AVX2 __attribute__((target("avx2,fma")))
#endif
#define BOUGH_INLINE inline __attribute__((always_inline))

/// Makes the loader call `function` before main(), on Linux before the constructors of the libraries too.
#ifdef __APPLE__
#define BOUGH_CALL_AT_LOAD(function) \
  __attribute__((constructor)) void call_at_load() { function(); }
#else
#define BOUGH_CALL_AT_LOAD(function) \
  __attribute__((section(".preinit_array"), used)) void (*const call_at_load)() = function;
#endif

namespace bough::platform {

#ifdef BOUGH_AVX2
/// Returns true if the processor has AVX2 and FMA.
inline bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
}
#endif

/// True if long double has more digits than double: not on macOS with ARM, where residuals take double-double
/// arithmetic.
inline constexpr bool kHasExtended = LDBL_MANT_DIG > DBL_MANT_DIG;

/// Reads a number as std::from_chars does, which libc++ has from version 20 on for floating-point numbers.
/// \param value  unchanged on failure.
std::from_chars_result read_number(const char* first, const char* last, double& value);
/// Reads an integer of base 2 to 36 as std::from_chars does. \param value  unchanged on failure.
template <std::integral Integer>
std::from_chars_result read_number(const char* first, const char* last, Integer& value, int base = 10) {
  return std::from_chars(first, last, value, base);
}

/// Reads a number by strtod_l in the C locale, for standard libraries without std::from_chars of doubles.
std::from_chars_result read_number_of_c(const char* first, const char* last, double& value);

/// File to execute in order to start this program again. On Linux it leads to the running program even if its file has
/// been replaced.
std::string get_executable();
/// Path of the file of this program, of the interpreter in a Python process; symbolic links followed. Empty on failure.
std::filesystem::path find_executable(std::error_code& failed);
/// Files of the libraries that this process has loaded.
std::vector<std::string> list_libraries();
/// Suffix of shared libraries, and names of this platform in FMUs of FMI 2 and 3.
extern const char* const kLibrarySuffix;
extern const char* const kFmi2Platform;
extern const char* const kFmi3Platform;
/// Environment of this process, NAME=value, ending with null; may move with setenv().
char** get_environment();

/// Opens a pipe that no program started by this one inherits. \return false: errno has the reason.
bool open_pipe(int (&ends)[2]);
/// Opens a pair of stream sockets that no program started by this one inherits. \return false: errno has the reason.
bool open_socket_pair(int (&ends)[2]);
/// send() without SIGPIPE where the other end is closed.
ssize_t send_quietly(int socket, const char* data, std::size_t size);
/// Makes the child started by posix_spawn inherit only the descriptors of the actions. \return flags to add.
short close_other_descriptors(posix_spawn_file_actions_t& actions);
/// Makes the system kill this process when its parent ends. macOS cannot: there the process ends at its next read from
/// the parent.
void end_with_parent();
/// Ends the process with all threads, without the C library. Async-signal-safe.
[[noreturn]] void end_process(int code) noexcept;

/// Memory of this process in RAM, bytes; 0 if unknown.
double get_resident_bytes();
/// Address space of this process, bytes; 0 if unknown.
double get_address_space_bytes();
/// RAM and swap space that are free, bytes, within the limits of control groups; infinity if unknown.
double calc_free_bytes();
/// Returns memory that was freed to the system, if that is worth its time.
void release_freed_memory();
/// Gives pages back to the system; their contents are lost. \param begin, end multiples of the page size.
void discard_pages(void* begin, void* end);
/// Fills memory from malloc with a pattern from now on, so that a value that was never set shows. macOS: no effect.
void fill_fresh_memory();

/// Exclusive lock of an open file description on one byte. \return false: errno is EAGAIN or EACCES if another holds
/// it, and ENOTSUP on macOS, whose public headers have no such locks.
bool lock_byte(int descriptor, off_t byte);
/// Returns true if another open file description holds that lock; false if that is not known.
bool is_byte_locked(int descriptor, off_t byte);
/// Writes data of a file to its disk. \return false: errno has the reason.
bool sync_data(int descriptor);
/// Starts writing data of a file to its disk, if the system can; does not wait.
void start_sync(int descriptor);
/// Reserves space up to `size` bytes without changing the length of the file. \return false: errno has the reason.
bool reserve_space(int descriptor, off_t size);
/// Open file without a name, in memory or in the temporary folder; -1: errno has the reason.
int open_nameless_file();
/// Time of the last change of the contents.
timespec get_change_time(const struct stat& state);

}  // namespace bough::platform
