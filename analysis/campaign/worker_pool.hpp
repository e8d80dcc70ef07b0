#pragma once
/// \file Worker processes, the case of each, and its outcome.
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "analysis/campaign/batch_outcome.hpp"

namespace bough::analysis {

struct PoolOptions {
  std::vector<std::string> command;  ///< of a worker; the number of its socket is added
  int num_workers = 1;
  double time_limit = 0;               ///< s a case; 0: none
  const volatile int* stop = nullptr;  ///< turns non-zero when a signal came
  /// Output of a case before its worker ended; empty: none.
  std::function<std::string(int number)> find_error;
};

/// Gives `cases` to workers when they become free and hands every outcome to `done`. A worker that dies, or that takes
/// too long and is killed, fails its case (batch.worker-crashed, batch.time-limit) and is replaced. False when stopped:
/// what was under way is given up then.
bool run_pool(const PoolOptions& options, const std::vector<int>& cases,
              const std::function<void(const BatchOutcome&)>& done);

}  // namespace bough::analysis
