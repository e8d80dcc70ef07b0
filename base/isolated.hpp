#pragma once
/// \file Tasks on files in a separate process, for libraries that crash on damaged files.
#include <string>

namespace bough {

/// Output of a process that worked on a file, and its end if that shows a fault of the file.
struct IsolatedResult {
  std::string output;
  std::string end;  ///< fault of the file; empty: none
};

/// Task on the file; an exception of it ends the process.
using IsolatedTask = std::string (*)(const std::string& path);

/// Limits of the process: time of computing, and memory in addition to that of this process.
struct IsolationLimits {
  double seconds = 5;
  double bytes = 1e9;
};

/// Runs the task in a forked process with closed standard streams. `library` is the name, in IsolatedResult::end, of
/// the library that may crash. If no process can be forked, the task is run in this one.
IsolatedResult run_isolated(const std::string& path, IsolatedTask task, const IsolationLimits& limits,
                            const std::string& library);

/// Function by which run_isolated runs tasks: one process each. A fuzzer, with a million of them, keeps one for many.
using IsolatedRunner = IsolatedResult (*)(const std::string& path, IsolatedTask task, const IsolationLimits& limits,
                                          const std::string& library);
/// Sets the function and returns the previous one.
IsolatedRunner set_isolated_runner(IsolatedRunner runner);

}  // namespace bough
