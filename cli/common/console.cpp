#include "cli/common/console.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>
#include <tuple>

#include "analysis/common/failures.hpp"
#include "analysis/common/ranks.hpp"
#include "base/input_bytes.hpp"
#include "cli/common/interrupt.hpp"

namespace bough::cli {

namespace {
/// "5,990"
std::string group_digits(std::size_t number) {
  auto text = std::to_string(number);
  for (auto at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
  return text;
}

/// Thrown once: what a full disk refused is not tried again at the end.
ComputationError fail_to_print() {
  const int cause = errno;
  std::clearerr(stdout);
  return {"cli.write",
          {"standard output"},
          "not everything could be printed" + (cause != 0 ? std::string(": ") + std::strerror(cause) : std::string()),
          "check where the output goes, and the space left there"};
}

/// False where the file has no such line.
bool read_line(const SourceLocation& where, std::string& line) {
  if (const auto kept = find_input(where.file)) {
    std::string_view rest = *kept;
    for (int k = 1; k < where.line && !rest.empty(); ++k)
      rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
    line = rest.substr(0, rest.find('\n'));
    return !rest.empty();
  }
  std::ifstream in(where.file);
  for (int k = 0; k < where.line; ++k)
    if (!std::getline(in, line)) return false;
  return true;
}

/// The line that a message is about, and a mark under its column where that is known; nothing where it cannot be read.
std::string show_source_line(const SourceLocation& where) {
  constexpr std::size_t kLongest = 100;
  std::error_code ignored;
  if (where.line <= 0 || !std::filesystem::is_regular_file(where.file, ignored)) return "";
  std::string line;
  if (!read_line(where, line)) return "";
  // A negative column is that of a card, or of a text with tabs expanded: the message does not contain it.
  const bool is_told = where.column >= 0, has_tabs = line.find('\t') != std::string::npos;
  // Control characters of the terminal are replaced by blanks.
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = ' ';
  line.erase(line.find_last_not_of(' ') + 1);
  if (line.empty()) return "";
  if (line.size() > kLongest) {
    auto end = kLongest;
    while ((static_cast<unsigned char>(line[end]) & 0xC0) == 0x80) --end;  // not inside a letter
    line.resize(end);
    line += " ...";
  }
  auto text = "    " + line + "\n";
  const auto column = static_cast<std::size_t>(is_told || !has_tabs ? std::abs(where.column) : 0);
  if (column > 0 && column <= kLongest) text += std::string(3 + column, ' ') + "^\n";
  return text;
}
}  // namespace

std::string wrap(const std::string& text, std::size_t indent, std::size_t width) {
  std::istringstream words(text);
  std::string out, word;
  std::size_t column = indent;
  while (words >> word) {
    if (column > indent && column + 1 + calc_display_width(word) > width) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) out += ' ';
    out += word;
    column += calc_display_width(word) + (column > indent ? 1 : 0);
  }
  return out;
}

std::size_t get_terminal_width() {
  winsize size{};
  return isatty(STDOUT_FILENO) != 0 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

Console::Console(bool quiet, int verbosity)
    : quiet_(quiet),
      verbosity_(verbosity),
      is_root_(analysis::get_launch_rank() == 0),
      stderr_is_terminal_(isatty(STDERR_FILENO) != 0) {
  const char* no_color = std::getenv("NO_COLOR");
  colors_ = stderr_is_terminal_ && (no_color == nullptr || *no_color == '\0');
}

void Console::print_data(const std::string& text) const {
  if (!is_root_ || text.empty()) return;
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) < text.size()) throw fail_to_print();
}

void Console::print(const std::string& text) const {
  if (!quiet_) print_data(text);
}

void Console::print_detail(const std::string& text) const {
  if (is_root_ && verbosity_ > 0) std::fprintf(stderr, "%s\n", text.c_str());
}

void Console::print(const Diagnostic& diagnostic) const {
  if (!is_root_) return;
  const auto located = analysis::locate(diagnostic, subject_);
  std::string text = format(located);
  if (colors_) {
    const bool is_error = diagnostic.severity == Severity::Error;
    const std::string word = is_error ? "error:" : diagnostic.severity == Severity::Warning ? "warning:" : "note:";
    if (const auto at = text.find(word); at != std::string::npos) {
      text.replace(at, word.size(), (is_error ? "\033[1;31m" : "\033[1;33m") + word + "\033[0m");
    }
  }
  text += '\n';
  if (stderr_is_terminal_ && diagnostic.severity != Severity::Note) text += show_source_line(located.where);
  std::fputs(text.c_str(), stderr);
}

void Console::print_error(const std::string& id, const std::string& what, const std::string& advice) const {
  Diagnostics one;
  one.error(id, {}, what, advice);
  print(one.items().front());
}

void Console::print_unless_quiet(const Diagnostic& diagnostic) const {
  if (diagnostic.severity == Severity::Error || !quiet_) print(diagnostic);
}

void Console::print(const Diagnostics& diagnostics) const { print(diagnostics.items()); }

void Console::print(const std::vector<Diagnostic>& items) const {
  for (const auto& item : verbosity_ > 0 ? items : shorten(items)) print_unless_quiet(item);
}

void Console::show_progress(const std::string& text) {
  if (!shows_progress()) return;
  if (stderr_is_terminal_) {
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    std::fflush(stderr);
    progress_open_ = true;
  } else {
    std::fprintf(stderr, "%s\n", text.c_str());
  }
}

void Console::end_progress() {
  if (progress_open_) std::fputc('\n', stderr);
  progress_open_ = false;
}

void flush_data() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw fail_to_print();
}

std::vector<Diagnostic> shorten(const std::vector<Diagnostic>& items, std::size_t max_shown) {
  struct Kind {
    std::size_t count = 0, line = 0;  ///< number of messages; line of the summary of the others
  };
  std::map<std::tuple<std::string, Severity, std::string>, Kind> kinds;
  std::vector<Diagnostic> shown;
  for (const auto& item : items) {
    auto& kind = kinds[{item.id, item.severity, item.where.file}];
    if (item.id.empty() || ++kind.count <= max_shown) {
      shown.push_back(item);
    } else if (kind.count == max_shown + 1) {
      kind.line = shown.size();
      shown.push_back({item.severity, item.id, {item.where.file}, {}, {}});
    }
  }
  for (const auto& [key, kind] : kinds)
    if (kind.count > max_shown) {
      auto& line = shown[kind.line];
      // Diagnostics keeps no more items.
      const bool is_cut = items.size() >= 200'000;
      line.what =
          (is_cut ? "... and at least " : "... and ") + group_digits(kind.count - max_shown) + " more of " + line.id;
      line.advice = "-v prints them all";
    }
  return shown;
}

int report_failure(const Failure& failure, const Console& console) {
  end_in_silence();
  console.print(failure.items());
  return analysis::choose_exit_code(failure);
}

}  // namespace bough::cli
