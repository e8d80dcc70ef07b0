#include "fe/linear/threads.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <thread>

#include "fe/linear/petsc.hpp"

namespace bough::linear {

namespace {

/// While it lives, OpenMP starts no threads from this one: CHOLMOD asks for four, whatever OMP_NUM_THREADS says.
class OneThread {
 public:
  OneThread() = default;
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;
  ~OneThread() { set_openmp_levels(before_); }

 private:
  int before_ = set_openmp_levels(0);
};

/// Returns true under ulimit -v: OpenBLAS needs 128 MB of addresses for a second thread, and retries without end.
bool has_limited_memory() {
  rlimit limit{};
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

}  // namespace

int get_num_threads() {
  if (initialize_petsc().size > 1) return 1;  // the ranks are threads enough
  if (has_limited_memory()) return 1;
  if (const char* setting = std::getenv("OMP_NUM_THREADS")) return std::max(1, std::atoi(setting));
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 2U));
}

void do_alone(const std::function<void()>& work) {
  const OneThread alone;
  work();
}

void do_both(const std::function<void()>& first, const std::function<void()>& second) {
  std::exception_ptr failure;
  std::thread other([&] {
    try {
      do_alone(second);
    } catch (...) {
      failure = std::current_exception();
    }
  });
  try {
    do_alone(first);
  } catch (...) {
    other.join();
    throw;
  }
  other.join();
  if (failure) std::rethrow_exception(failure);
}

void do_halves(int size, int min_size, const std::function<void(int, int)>& work) {
  if (get_num_threads() < 2 || size < 2 * min_size) return work(0, size);
  do_both([&] { work(0, size / 2); }, [&] { work(size / 2, size); });
}

void do_columns(std::ptrdiff_t rows, std::ptrdiff_t columns, const std::function<void(int, int)>& work) {
  constexpr std::ptrdiff_t kMinRows = 5000;  // fewer are done before a thread has started
  const auto num = static_cast<int>(columns);
  do_halves(num, rows > kMinRows ? 1 : num, work);
}

}  // namespace bough::linear
