#pragma once
/// \file Work on a file that the library which reads it may not survive, done by a process of its own first.
#include <string>

namespace bough {

/// What a process that worked on a file has to say, and how it ended where that says something of the file.
struct Apart {
  std::string said;
  std::string end;  ///< empty where it ended well
};

/// Done to the file; what it throws ends the process.
using ApartTask = std::string (*)(const std::string& path);

/// Of computing, and beyond what this process has.
struct ApartLimits {
  double seconds = 5;
  double bytes = 1e9;
};

/// Forks a process that does the task, with nothing on its standard streams. `library` names what may break in
/// Apart::end. Where no process is to be had the task is done here.
Apart work_apart(const std::string& path, ApartTask task, const ApartLimits& limits, const std::string& library);

/// How work_apart has tasks done: by a process each, unless a fuzzer, which has a million of them, keeps one for many.
using ApartWorker = Apart (*)(const std::string& path, ApartTask task, const ApartLimits& limits,
                              const std::string& library);
/// Returns the one before.
ApartWorker set_apart_worker(ApartWorker worker);

}  // namespace bough
