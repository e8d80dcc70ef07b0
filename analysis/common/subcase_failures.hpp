#pragma once
/// \file The subcases that could not be solved while others could: their messages name them.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::analysis {

class SubcaseFailures {
 public:
  /// Numbers of subcases solved, and in the deck: with one only the messages need no name.
  SubcaseFailures(std::size_t num_solved, std::size_t num_in_deck)
      : num_solved_(num_solved), is_named_(std::max(num_solved, num_in_deck) > 1) {}

  /// Records the messages of a subcase that failed; the largest exit code of all failures is kept.
  void add(int subcase, const Failure& failure);
  /// Returns true if no subcase has failed.
  bool is_empty() const { return failed_.empty(); }
  /// Every message once, its errors with the subcases that they are about; without the warnings of `prior`.
  std::vector<Diagnostic> get_items(const Diagnostics& prior = {}) const;
  /// Exit code of report_failure for the worst failure; 0 without failures.
  int get_exit_code() const { return exit_code_; }
  /// Throws all of them as one failure.
  [[noreturn]] void throw_all(const Diagnostics& prior) const;
  /// Subcase ids with the messages of each.
  const std::vector<std::pair<int, std::vector<Diagnostic>>>& get_failed() const { return failed_; }

 private:
  std::size_t num_solved_;
  bool is_named_;
  std::vector<std::pair<int, std::vector<Diagnostic>>> failed_;
  int exit_code_ = 0;
};

/// Adds what is new: the model of each subcase says again what the deck made the first one say.
void add_new(const Diagnostics& from, Diagnostics& to);
/// Warnings alone: those issued before a failure, which has its errors itself.
void add_warnings(const Diagnostics& from, Diagnostics& to);

}  // namespace bough::analysis
