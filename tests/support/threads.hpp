#pragma once
/// \file The number of threads, set for a test.
#include <cstdlib>
#include <string>

namespace bough::test {

/// So many threads while it lives.
class Threads {
 public:
  explicit Threads(int num) {
    if (const char* before = std::getenv("OMP_NUM_THREADS")) before_ = before;
    setenv("OMP_NUM_THREADS", std::to_string(num).c_str(), 1);
  }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads() {
    if (before_.empty())
      unsetenv("OMP_NUM_THREADS");
    else
      setenv("OMP_NUM_THREADS", before_.c_str(), 1);
  }

 private:
  std::string before_;
};

}  // namespace bough::test
