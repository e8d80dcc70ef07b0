#include "tests/solver/support/malloc_count.hpp"

#include <atomic>
#include <cstddef>
#include <cstdlib>

// GCC has macros for the sanitizers, which have a malloc of their own, Clang features.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define BOUGH_HAS_MALLOC_OF_ITS_OWN
#endif
#endif
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !defined(BOUGH_HAS_MALLOC_OF_ITS_OWN)
#define BOUGH_COUNTS_MALLOC
extern "C" void* __libc_malloc(size_t size);

namespace {
std::atomic<long> num_mallocs{0};
}

extern "C" void* malloc(size_t size) {
  num_mallocs.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
#endif

namespace bough::solver::testing {

long get_malloc_count() {
#ifdef BOUGH_COUNTS_MALLOC
  return num_mallocs;
#else
  return -1;
#endif
}

}  // namespace bough::solver::testing
