#include "analysis/campaign/worker.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "analysis/common/output_folder.hpp"
#include "base/platform.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

/// While it lives, file descriptor `fd` leads to a file.
class Redirection {
 public:
  Redirection(int fd, const std::string& path) : fd_(fd) {
    flush();
    saved_ = fcntl(fd, F_DUPFD_CLOEXEC, 10);
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) return;
    dup2(file, fd);
    close(file);
  }
  ~Redirection() {
    flush();
    dup2(saved_, fd_);
    close(saved_);
  }
  Redirection(const Redirection&) = delete;
  Redirection& operator=(const Redirection&) = delete;

 private:
  static void flush() {
    std::cout.flush();
    std::cerr.flush();
    std::fflush(stdout);
    std::fflush(stderr);
  }
  int fd_, saved_;
};

/// The first line with an error; the last line if there is none.
std::string find_error(const std::string& path) {
  std::ifstream in(path);
  std::string line, last;
  while (std::getline(in, line)) {
    if (line.find("error: ") != std::string::npos) return line;
    if (!line.empty()) last = line;
  }
  return last;
}

long get_memory_kb() { return static_cast<long>(platform::get_resident_bytes() / 1024); }

/// A crash on demand, so that the tests can see one.
void crash_if_told(int number) {
  const char* text = std::getenv("BOUGH_TEST_ABORT_CASE");
  if (text != nullptr && std::atoi(text) == number) std::abort();
}

void run_steps(const BatchPlan& plan, const BatchCase& one, const RunCommand& run, BatchOutcome& outcome) {
  const auto& steps = plan.get_spec().steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto name = "step-" + std::to_string(i + 1);
    {
      const Redirection out(STDOUT_FILENO, name + ".out"), err(STDERR_FILENO, name + ".err");
      outcome.exit_code = run(plan.make_words(one, i));
    }
    if (outcome.exit_code == 0) continue;
    const auto error = find_error(name + ".err");
    outcome.error =
        steps[i].words[0] + ": " + (error.empty() ? "exit code " + std::to_string(outcome.exit_code) : error);
    return;
  }
}

bool send_line(int fd, const std::string& text) {
  for (std::size_t sent = 0; sent < text.size();) {
    const auto n = platform::send_quietly(fd, text.data() + sent, text.size() - sent);
    if (n <= 0) return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

/// Collects all values that can be read; the first that cannot is the error of the case.
void collect_all(const BatchPlan& plan, const fs::path& folder, BatchOutcome& outcome) {
  for (const auto& rule : plan.get_spec().collect) {
    try {
      outcome.outputs.push_back(collect(rule, folder));
    } catch (const Failure& failure) {
      outcome.outputs.emplace_back();
      if (outcome.exit_code != 0) continue;
      outcome.exit_code = failure.exit_code();
      outcome.error = format(failure.items().front());
    }
  }
}

}  // namespace

std::string find_printed_error(const BatchPlan& plan, const fs::path& here) {
  const auto& steps = plan.get_spec().steps;
  for (auto i = steps.size(); i > 0; --i) {
    const auto name = here / ("step-" + std::to_string(i) + ".err");
    if (!fs::exists(name)) continue;
    const auto error = find_error(name.string());
    return error.find("error: ") == std::string::npos ? "" : steps[i - 1].words[0] + ": " + error;
  }
  return {};
}

BatchOutcome run_case(const BatchPlan& plan, const BatchCase& one, const fs::path& folder, const RunCommand& run) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  BatchOutcome outcome;
  outcome.number = one.number;
  const auto here = folder / plan.get_folder(one.number);
  try {
    if (is_case_folder(here)) clear_case_folder(here);
    make_case_folder(here);
    crash_if_told(one.number);
    plan.write_files(one, here);
    fs::current_path(here);
    run_steps(plan, one, run, outcome);
    if (outcome.exit_code == 0) collect_all(plan, here, outcome);
  } catch (const Failure& failure) {
    outcome.exit_code = failure.exit_code();
    outcome.error = format(failure.items().front());
  } catch (const std::exception& error) {
    outcome.exit_code = 3;
    outcome.error = error.what();
  }
  std::error_code ignored;
  fs::current_path(folder, ignored);
  outcome.memory_kb = get_memory_kb();
  outcome.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return outcome;
}

int serve_cases(const BatchPlan& plan, const fs::path& folder, int fd, bool may_leave, const RunCommand& run) {
  std::string waiting;
  char buffer[256];
  while (true) {
    const auto end = waiting.find('\n');
    if (end == std::string::npos) {
      const auto n = recv(fd, buffer, sizeof buffer, 0);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return 0;
      waiting.append(buffer, static_cast<std::size_t>(n));
      continue;
    }
    const int number = std::atoi(waiting.c_str());
    waiting.erase(0, end + 1);
    if (number < 1 || number > plan.num_cases()) return 1;
    const auto& one = plan.get_cases()[static_cast<std::size_t>(number - 1)];
    if (!may_leave) confine_outputs((folder / plan.get_folder(number)).string());
    const auto outcome = run_case(plan, one, folder, run);
    if (!send_line(fd, to_text(outcome))) return 0;
  }
}

}  // namespace bough::analysis
