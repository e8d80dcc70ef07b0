#include "cli/studio/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>

#include "base/diagnostic.hpp"
#include "base/platform.hpp"

namespace bough::cli {

namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const char* what, int error) {
  throw ComputationError("studio.no-process", {}, std::string(what) + ": " + std::strerror(error),
                         "end other programs, then try again");
}

/// Both ends of a pipe, closed at the end.
class Pipe {
 public:
  Pipe() {
    if (!platform::open_pipe(ends_)) fail("no pipe for a process", errno);
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int get(int end) const { return ends_[end]; }
  int release(int end) { return std::exchange(ends_[end], -1); }
  void close_end(int end) {
    if (ends_[end] >= 0) close(ends_[end]);
    ends_[end] = -1;
  }

 private:
  int ends_[2] = {-1, -1};
};

/// Starts this program in a process group of one. Of the descriptors only 0, 1 and 2 are open in it.
pid_t spawn(const std::vector<std::string>& words, const std::string& folder, int in, int out, int err) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (in < 0)
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  else
    posix_spawn_file_actions_adddup2(&actions, in, 0);
  posix_spawn_file_actions_adddup2(&actions, out, 1);
  if (err < 0)
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  else
    posix_spawn_file_actions_adddup2(&actions, err, 2);
  const short closing = platform::close_other_descriptors(actions);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) sigaddset(&defaults, signal);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, static_cast<short>(POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP | closing));
  std::vector<std::string> arguments{"bough"};
  arguments.insert(arguments.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (auto& word : arguments) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::vector<std::string> values;
  for (char** entry = platform::get_environment(); *entry != nullptr; ++entry)
    if (std::strncmp(*entry, "BOUGH_FOLDER=", 13) != 0) values.emplace_back(*entry);
  values.push_back("BOUGH_FOLDER=" + folder);
  std::vector<char*> envp;
  for (auto& value : values) envp.push_back(value.data());
  envp.push_back(nullptr);
  pid_t pid = 0;
  const int error =
      posix_spawn(&pid, platform::get_executable().c_str(), &actions, &attributes, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) fail("no process for a command", error);
  return pid;
}

int wait_code(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0)
    if (errno != EINTR) return 127;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void write_all(int fd, const std::string& text) {
  for (std::size_t sent = 0; sent < text.size();) {
    const auto n = write(fd, text.data() + sent, text.size() - sent);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;  // a child that died: its exit code reports it
    sent += static_cast<std::size_t>(n);
  }
}

}  // namespace

ChildResult run_child(const std::vector<std::string>& words, const std::string& folder, const std::string& input,
                      int max_seconds) {
  Pipe in, out;
  const pid_t pid = spawn(words, folder, in.get(0), out.get(1), -1);
  in.close_end(0);
  out.close_end(1);
  write_all(in.get(1), input);
  in.close_end(1);
  ChildResult result;
  const auto end = Clock::now() + std::chrono::seconds(max_seconds);
  char buffer[65536];
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd ready{out.get(0), POLLIN, 0};
    const int count = left > 0 ? poll(&ready, 1, static_cast<int>(left)) : 0;
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      result.is_late = true;
      kill(-pid, SIGKILL);
      break;
    }
    const auto n = read(out.get(0), buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    result.output.append(buffer, static_cast<std::size_t>(n));
  }
  result.code = wait_code(pid);
  return result;
}

struct Job::Shared {
  std::mutex mutex;
  pid_t pid = 0;
  bool is_running = true;
  int code = 0;
  std::string output;
  std::thread reader;
};

Job::Job(std::vector<std::string> words, const std::string& folder)
    : words_(std::move(words)), shared_(std::make_unique<Shared>()) {
  Pipe out;
  shared_->pid = spawn(words_, folder, -1, out.get(1), out.get(1));
  out.close_end(1);
  const int fd = out.release(0);
  auto* const shared = shared_.get();
  shared_->reader = std::thread([shared, fd] {
    char buffer[16384];
    while (true) {
      const auto n = read(fd, buffer, sizeof buffer);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) break;
      const std::lock_guard lock(shared->mutex);
      const auto room = kMaxOutput - std::min(kMaxOutput, shared->output.size());
      shared->output.append(buffer, std::min(room, static_cast<std::size_t>(n)));
    }
    close(fd);
    // Waits without taking the exit code: stop() may use the id of the process until is_running is false.
    siginfo_t info;
    while (waitid(P_PID, static_cast<id_t>(shared->pid), &info, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
    }
    const std::lock_guard lock(shared->mutex);
    shared->code = wait_code(shared->pid);
    shared->is_running = false;
  });
}

Job::~Job() {
  stop();
  for (int i = 0; i < 40 && get_state(kMaxOutput).is_running; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->is_running) kill(-shared_->pid, SIGKILL);
  }
  shared_->reader.join();
}

Job::State Job::get_state(std::size_t from) const {
  const std::lock_guard lock(shared_->mutex);
  State state{shared_->is_running, shared_->code, {}, shared_->output.size()};
  if (from < shared_->output.size()) state.output = shared_->output.substr(from);
  return state;
}

void Job::stop() {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->is_running) kill(-shared_->pid, SIGINT);
}

}  // namespace bough::cli
