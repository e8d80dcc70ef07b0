#include "analysis/campaign/worker_pool.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "base/platform.hpp"

namespace bough::analysis {

namespace {

using Clock = std::chrono::steady_clock;

struct Worker {
  pid_t pid = 0;
  int fd = -1;
  int number = 0;  ///< of its case; 0: idle
  Clock::time_point begin;
  std::string waiting;  ///< of its answer
};

/// Separates a worker from the MPI job that this program may be part of. Open MPI stores how to reach the job in its
/// parameters too.
void clear_launch() {
  const bool is_launched = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr;
  for (char** entry = platform::get_environment(); *entry != nullptr;) {
    const std::string text = *entry;
    const bool is_launch = text.rfind("OMPI_COMM_", 0) == 0 || text.rfind("OMPI_UNIVERSE", 0) == 0 ||
                           text.rfind("PMIX_", 0) == 0 || text.rfind("PMI_", 0) == 0 ||
                           (is_launched && text.rfind("OMPI_MCA_", 0) == 0);
    if (is_launch)
      unsetenv(text.substr(0, text.find('=')).c_str());
    else
      ++entry;
  }
}

[[noreturn]] void become_worker(const PoolOptions& options, int fd) {
  platform::end_with_parent();
  setpgid(0, 0);  // Ctrl-C is for the parent to act on
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  fcntl(fd, F_SETFD, 0);
  if (const int null = open("/dev/null", O_RDONLY); null >= 0) dup2(null, STDIN_FILENO);
  clear_launch();
  // One core each.
  setenv("OMP_NUM_THREADS", "1", 0);
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  auto words = options.command;
  words.push_back(std::to_string(fd));
  // In a Python process the executable is the interpreter; the module says how to come here again, a word a line.
  std::string program = platform::get_executable();
  if (const char* launcher = std::getenv("BOUGH_WORKER_LAUNCHER")) {
    std::vector<std::string> launch;
    std::istringstream lines(launcher);
    for (std::string line; std::getline(lines, line);) launch.push_back(line);
    if (!launch.empty()) {
      program = launch.front();
      launch.insert(launch.end(), words.begin() + 1, words.end());
      words = launch;
    }
  }
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  _exit(127);
}

class Pool {
 public:
  Pool(const PoolOptions& options, const std::vector<int>& cases, const std::function<void(const BatchOutcome&)>& done)
      : options_(options), cases_(cases), done_(done) {}
  ~Pool() {
    for (auto& worker : workers_) end(worker, worker.number != 0);
  }

  bool run() {
    const auto count = std::min<std::size_t>(static_cast<std::size_t>(options_.num_workers), cases_.size());
    for (std::size_t i = 0; i < count; ++i) workers_.push_back(start());
    for (auto& worker : workers_) give_next(worker);
    while (std::any_of(workers_.begin(), workers_.end(), [](const Worker& w) { return w.number != 0; })) {
      if (is_stopped()) return false;
      wait();
      for (auto& worker : workers_)
        if (worker.number != 0 && is_late(worker)) fail_late(worker);
    }
    return !is_stopped();
  }

 private:
  bool is_stopped() const { return options_.stop != nullptr && *options_.stop != 0; }

  Worker start() {
    int ends[2];
    if (!platform::open_socket_pair(ends))
      throw ComputationError("batch.no-worker", {}, std::string("no socket for a worker: ") + std::strerror(errno),
                             "use fewer with -j");
    const pid_t pid = fork();
    if (pid == 0) become_worker(options_, ends[1]);
    close(ends[1]);
    if (pid < 0) {
      close(ends[0]);
      throw ComputationError("batch.no-worker", {}, std::string("no process for a worker: ") + std::strerror(errno),
                             "use fewer with -j");
    }
    Worker worker;
    worker.pid = pid;
    worker.fd = ends[0];
    return worker;
  }

  /// Returns the status that waitpid gives.
  int end(Worker& worker, bool kills) {
    if (worker.pid == 0) return 0;
    if (kills) kill(worker.pid, SIGKILL);
    close(worker.fd);
    int status = 0;
    while (waitpid(worker.pid, &status, 0) < 0 && errno == EINTR) continue;
    worker.pid = 0;
    return status;
  }

  void give_next(Worker& worker) {
    worker.number = 0;
    worker.waiting.clear();
    if (next_ >= cases_.size() || is_stopped()) return;
    if (worker.pid == 0) worker = start();
    worker.number = cases_[next_++];
    worker.begin = Clock::now();
    const auto line = std::to_string(worker.number) + "\n";
    // A worker that is gone already shows as the end of its answers.
    (void)!platform::send_quietly(worker.fd, line.data(), line.size());
  }

  void wait() {
    std::vector<pollfd> polled;
    for (const auto& worker : workers_) polled.push_back({worker.number != 0 ? worker.fd : -1, POLLIN, 0});
    if (poll(polled.data(), polled.size(), 100) <= 0) return;
    for (std::size_t i = 0; i < polled.size(); ++i)
      if (polled[i].revents != 0) read(workers_[i]);
  }

  void read(Worker& worker) {
    char buffer[65536];
    const auto n = recv(worker.fd, buffer, sizeof buffer, MSG_DONTWAIT);
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) return;
    if (n <= 0) return fail_crashed(worker);
    worker.waiting.append(buffer, static_cast<std::size_t>(n));
    if (worker.waiting.back() != '\n') return;
    if (const auto outcome = parse_outcome(worker.waiting)) {
      done_(*outcome);
      give_next(worker);
    } else {
      fail_crashed(worker);
    }
  }

  bool is_late(const Worker& worker) const {
    return options_.time_limit > 0 && get_seconds(worker) > options_.time_limit;
  }
  static double get_seconds(const Worker& worker) {
    return std::chrono::duration<double>(Clock::now() - worker.begin).count();
  }

  void fail(Worker& worker, const std::string& error) {
    BatchOutcome outcome;
    outcome.number = worker.number;
    outcome.exit_code = 3;
    outcome.seconds = get_seconds(worker);
    outcome.error = error;
    done_(outcome);
    give_next(worker);
  }
  void fail(Worker& worker, const char* id, const std::string& what, const std::string& advice) {
    Diagnostic diagnostic;
    diagnostic.id = id;
    diagnostic.what = what;
    diagnostic.advice = advice;
    fail(worker, format(diagnostic));
  }
  void fail_crashed(Worker& worker) {
    const int status = end(worker, false);
    // A user library ended it, and the worker could still print which.
    const auto error = WIFEXITED(status) && options_.find_error ? options_.find_error(worker.number) : std::string();
    if (!error.empty()) return fail(worker, error);
    const auto why = WIFSIGNALED(status) ? std::string("signal ") + std::to_string(WTERMSIG(status)) + " (" +
                                               strsignal(WTERMSIG(status)) + ")"
                                         : "exit code " + std::to_string(WEXITSTATUS(status));
    fail(worker, "batch.worker-crashed", "the worker ended by " + why,
         "run the case's steps one by one in its folder; please report the fault");
  }
  void fail_late(Worker& worker) {
    end(worker, true);
    fail(worker, "batch.time-limit", "the case took longer than its time limit",
         "raise time_limit, or look at the case's folder");
  }

  const PoolOptions& options_;
  const std::vector<int>& cases_;
  const std::function<void(const BatchOutcome&)>& done_;
  std::vector<Worker> workers_;
  std::size_t next_ = 0;
};

}  // namespace

bool run_pool(const PoolOptions& options, const std::vector<int>& cases,
              const std::function<void(const BatchOutcome&)>& done) {
  return Pool(options, cases, done).run();
}

}  // namespace bough::analysis
