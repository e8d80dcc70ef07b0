#pragma once
/// \file Output of a command: messages on stderr, tables and JSON on stdout; silent on every rank but the first.
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "base/text_table.hpp"
#include "base/words.hpp"

namespace bough::cli {

/// Exit codes of the contract.
enum ExitCode { kSuccess = 0, kInputError = 1, kUsageError = 2, kComputationFailed = 3 };

using Table = TextTable;

/// Words of `text` on lines of at most `width` columns; lines after the first begin with `indent` blanks.
std::string wrap(const std::string& text, std::size_t indent, std::size_t width);

/// Columns of the terminal of stdout; 0 without a terminal.
std::size_t get_terminal_width();

class Console {
 public:
  /// \param quiet  only errors and requested results are printed. \param verbosity  number of -v. Colours are off
  /// unless stderr is a terminal and NO_COLOR is unset or empty.
  Console(bool quiet, int verbosity);

  /// The file that a message is about when it names none, unless it concerns the command line.
  void set_subject(std::string file) { subject_ = std::move(file); }

  /// Returns true on the rank that prints.
  bool is_root() const { return is_root_; }
  /// Makes rank 0 the one that prints; without a call it is rank 0 of the launcher of MPI.
  void set_rank(int rank) { is_root_ = rank == 0; }

  /// To stdout, also when quiet: the result that was asked for. Throws ComputationError("cli.write") when it is not
  /// taken.
  void print_data(const std::string& text) const;
  /// To stdout unless quiet: tables and summaries for a reader.
  void print(const std::string& text) const;
  /// To stderr, only with -v.
  void print_detail(const std::string& text) const;
  /// One message in the common format, coloured when stderr is a terminal and NO_COLOR is not set.
  void print(const Diagnostic& diagnostic) const;
  /// An error that concerns the command line or the program, not a file.
  void print_error(const std::string& id, const std::string& what, const std::string& advice) const;
  /// Prints a diagnostic; warnings and notes are left out when quiet.
  void print_unless_quiet(const Diagnostic& diagnostic) const;
  /// All of them; warnings and notes are left out when quiet, and all but the first of a kind without -v (shorten).
  void print(const Diagnostics& diagnostics) const;
  /// Prints a list as print(const Diagnostics&) does.
  void print(const std::vector<Diagnostic>& items) const;
  /// Overwrites the progress line on a terminal; elsewhere, with -v, prints lines.
  void show_progress(const std::string& text);
  /// Ends the progress line, so that the next output begins on a new one.
  void end_progress();
  /// Shows the stage of a request as progress; an empty one ends the line.
  void show_stage(const std::string& stage) { stage.empty() ? end_progress() : show_progress(stage); }
  /// Returns true if show_progress() prints: on the printing rank, not quiet, on a terminal or with -v.
  bool shows_progress() const { return is_root_ && !quiet_ && (stderr_is_terminal_ || verbosity_ > 0); }

 private:
  bool quiet_;
  int verbosity_;
  bool is_root_;
  bool stderr_is_terminal_;
  bool colors_;
  bool progress_open_ = false;
  std::string subject_;
};

/// Everything printed so far goes out: ComputationError("cli.write") when it does not, or did not before.
void flush_data();

/// The first `max_shown` messages of each id, severity and file, in their order; one line where the next would stand
/// says how many follow.
std::vector<Diagnostic> shorten(const std::vector<Diagnostic>& items, std::size_t max_shown = 10);

/// Prints the diagnostics of a Failure and gives the exit code.
int report_failure(const Failure& failure, const Console& console);

}  // namespace bough::cli
