#include "cli/common/memory_limit.hpp"

#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "base/diagnostic.hpp"
#include "base/part_file.hpp"
#include "base/platform.hpp"
#include "cli/common/console.hpp"

namespace bough::cli {

namespace {

constexpr const char* kThreads = "OPENBLAS_NUM_THREADS";
/// Memory of OpenBLAS per thread, and of MPI and PETSc at their start.
constexpr std::size_t kWorkSpace = std::size_t{200} << 20;

bool is_limited() {
  rlimit limit{};
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

/// Ends the program, since HDF5 and others do not check failed allocations. Calls only functions allowed in a handler.
void end_without_memory(int) {
  remove_parts();
  const char* text =
      "error: a library did not survive the limit of memory (ulimit -v); raise it, or use a smaller model "
      "[cli.no-memory]\n";
  (void)!::write(STDERR_FILENO, text, std::strlen(text));
  ::_exit(kComputationFailed);
}

void catch_crashes() {
  static std::array<char, 1 << 16> room;  // stack of the handler, since the normal stack may be exhausted
  stack_t stack{};
  stack.ss_sp = room.data();
  stack.ss_size = room.size();
  ::sigaltstack(&stack, nullptr);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT}) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) continue;
    struct sigaction own {};
    own.sa_handler = end_without_memory;
    own.sa_flags = SA_ONSTACK;
    ::sigaction(signal, &own, nullptr);
  }
}

}  // namespace

void prepare_for_memory_limit(char** arguments) {
  if (!is_limited() || std::getenv(kThreads) != nullptr) return;
  setenv(kThreads, "1", 1);
  execv(platform::get_executable().c_str(), arguments);  // where that fails, the threads stay
}

void set_work_space_aside() {
  if (!is_limited()) return;
  catch_crashes();
  void* room = mmap(nullptr, kWorkSpace, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED)
    throw ComputationError("cli.no-memory", {}, "the limit of memory (ulimit -v) leaves too little to start with",
                           "raise it by some 200 MB");
  munmap(room, kWorkSpace);
  // Whichever BLAS is there; a product of this size takes the work space, which is kept for those that follow.
  using Product = void (*)(const char*, const char*, const int*, const int*, const int*, const double*, const double*,
                           const int*, const double*, const int*, const double*, double*, const int*);
  const auto multiply = reinterpret_cast<Product>(dlsym(RTLD_DEFAULT, "dgemm_"));
  if (multiply == nullptr) return;
  constexpr int n = 128;
  const double one = 1, zero = 0;
  const std::vector<double> a(n * n);
  std::vector<double> c(n * n);
  multiply("N", "N", &n, &n, &n, &one, a.data(), &n, a.data(), &n, &zero, c.data(), &n);
}

}  // namespace bough::cli
