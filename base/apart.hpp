#pragma once
/// \file Work on a file that the library which reads it may not survive, done by a process of its own first.
#include <string>

namespace bough {

/// Output of a process that worked on a file, and its end if that shows a fault of the file.
struct Apart {
  std::string said;
  std::string end;  ///< empty where it ended well
};

/// Done to the file; what it throws ends the process.
using ApartTask = std::string (*)(const std::string& path);

/// Limits of the process: time of computing, and memory in addition to that of this process.
struct ApartLimits {
  double seconds = 5;
  double bytes = 1e9;
};

/// Forks a process that does the task, with nothing on its standard streams. `library` names what may break in
/// Apart::end. Where no process is to be had the task is done here.
Apart work_apart(const std::string& path, ApartTask task, const ApartLimits& limits, const std::string& library);

/// Function by which work_apart runs tasks: one process each. A fuzzer, with a million of them, keeps one for many.
using ApartWorker = Apart (*)(const std::string& path, ApartTask task, const ApartLimits& limits,
                              const std::string& library);
/// Returns the one before.
ApartWorker set_apart_worker(ApartWorker worker);

}  // namespace bough
