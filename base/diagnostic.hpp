#pragma once
/// \file Diagnostics: an error or a warning, its location and advice.
///
/// Two kinds of failure (house rule): a breach of a contract between two pieces of Bough is an assertion; bad input or
/// a computation that failed is a Diagnostic with a stable id (docs/errors.md), collected so that all are reported.
#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace bough {

/// A place in an input file. line and column are 1-based; 0 means "not known".
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
};

enum class Severity { Note, Warning, Error };

struct Diagnostic {
  Severity severity = Severity::Error;
  std::string id;  ///< stable id of the catalogue, e.g. "deck.missing-grid"
  SourceLocation where;
  std::string what;    ///< lower case, no full stop, found against expected
  std::string advice;  ///< what to do; may be empty
};

/// "file:line: error: what; what to do [id]", the one format of every message.
std::string format(const Diagnostic& d);

/// Collects diagnostics; nothing is thrown until throw_if_errors.
class Diagnostics {
 public:
  /// Adds an error, warning or note.
  void error(std::string_view id, SourceLocation where, std::string what, std::string advice = {});
  void warning(std::string_view id, SourceLocation where, std::string what, std::string advice = {});
  void note(std::string_view id, SourceLocation where, std::string what, std::string advice = {});
  /// Adds one message of any severity.
  void add(Diagnostic d);
  /// Unless one with the same id and text is here already.
  void add_new(const Diagnostic& d);

  /// All messages in the order in which they were added.
  const std::vector<Diagnostic>& items() const { return items_; }
  /// Number of errors among the messages.
  int num_errors() const { return num_errors_; }
  /// Number of warnings among the messages.
  int num_warnings() const { return num_warnings_; }
  /// Returns true if a message with this id is there.
  bool has(std::string_view id) const;

  /// Throws InputError with everything collected so far if there is an error among it.
  void throw_if_errors() const;

 private:
  std::vector<Diagnostic> items_;
  int num_errors_ = 0;
  int num_warnings_ = 0;
};

/// Base of what Bough throws for reasons outside its own code. what() is the first thousand diagnostics,
/// one per line, and how many follow.
class Failure : public std::exception {
 public:
  Failure(std::vector<Diagnostic> items, int exit_code);
  /// The messages as text, one per line.
  const char* what() const noexcept override { return text_.c_str(); }
  /// All messages of the failure, errors and warnings.
  const std::vector<Diagnostic>& items() const { return items_; }
  /// Exit code of the command line: 1 wrong input, 3 failed computation.
  int exit_code() const { return exit_code_; }

 private:
  std::vector<Diagnostic> items_;
  std::string text_;
  int exit_code_;
};

/// The input is wrong (exit code 1).
class InputError : public Failure {
 public:
  explicit InputError(std::vector<Diagnostic> items) : Failure(std::move(items), 1) {}
  InputError(std::string_view id, SourceLocation where, std::string what, std::string advice = {});
};

/// The computation failed: singular, did not converge, diverged (exit code 3).
class ComputationError : public Failure {
 public:
  explicit ComputationError(std::vector<Diagnostic> items) : Failure(std::move(items), 3) {}
  ComputationError(std::string_view id, SourceLocation where, std::string what, std::string advice = {});
};

/// The nearest of `candidates` to `word` by edit distance, or empty when none is near: for "did you mean".
std::string find_nearest(std::string_view word, const std::vector<std::string>& candidates);

/// Contract between two pieces of Bough; always on. Use BOUGH_DEMAND.
[[noreturn]] void demand_failed(const char* condition, const char* function, const char* file, int line);

}  // namespace bough

#define BOUGH_DEMAND(condition) \
  ((condition) ? static_cast<void>(0) : ::bough::demand_failed(#condition, __func__, __FILE__, __LINE__))
