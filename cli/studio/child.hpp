#pragma once
/// \file Child processes of the studio: this program again, confined to one folder, with its output in memory.
#include <memory>
#include <string>
#include <vector>

namespace bough::cli {

struct ChildResult {
  int code = 0;        ///< exit code; 128 + signal if a signal ended it
  std::string output;  ///< of stdout
  bool is_late = false;
};

/// Runs `bough WORDS` in `folder` with BOUGH_FOLDER set to it and `input` as stdin; stderr is dropped. A child that
/// takes longer than max_seconds is killed. \throws ComputationError "studio.no-process".
ChildResult run_child(const std::vector<std::string>& words, const std::string& folder, const std::string& input,
                      int max_seconds);

/// A command in the background whose progress can be read. Output of stdout and stderr is kept in order, at most
/// kMaxOutput bytes of it.
class Job {
 public:
  static constexpr std::size_t kMaxOutput = std::size_t{1} << 22;

  /// \throws ComputationError "studio.no-process".
  Job(std::vector<std::string> words, const std::string& folder);
  /// Interrupts a job that goes on; kills it if it has not ended after two seconds.
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// Returns the words of the command, without the name of the program.
  const std::vector<std::string>& get_words() const { return words_; }
  struct State {
    bool is_running = true;
    int code = 0;
    std::string output;     ///< from byte `from` on
    std::size_t total = 0;  ///< bytes so far
  };
  /// Returns the state of the command with its output from byte `from` on; thread-safe.
  State get_state(std::size_t from) const;
  /// Interrupts the command as Ctrl-C does: a run writes a checkpoint and ends.
  void stop();

 private:
  struct Shared;
  std::vector<std::string> words_;
  std::unique_ptr<Shared> shared_;
};

}  // namespace bough::cli
