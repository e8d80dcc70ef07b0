#include "formats/nastran/detail/lines.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/input_bytes.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

namespace fs = std::filesystem;

std::string expand_tabs(std::string_view text) {
  std::string wide;
  for (const char c : text) {
    if (c == '\t')
      wide.append(8 - wide.size() % 8, ' ');
    else
      wide += c;
  }
  return wide;
}

bool contains(std::string_view text, char c) { return std::memchr(text.data(), c, text.size()) != nullptr; }

/// Lines of one text, by number.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_(text) {}
  bool read_next(std::string_view& line) {
    if (rest_.empty()) return false;
    const auto end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    return true;
  }
  int get_number() const { return number_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// Files that include files: more than this is no deck of a user.
constexpr std::size_t kMaxIncludeLevels = 100;
/// INCLUDE statements, and bytes of files read again, all in all: files that include a file twice, which does
/// the same, double with each level.
constexpr int kMaxIncludes = 20'000;
constexpr std::size_t kMaxRepeated = std::size_t{1} << 30;

/// Format of a text that is not lines of bytes; empty for lines.
std::string find_other_format(std::string_view text) {
  const auto head = text.substr(0, 4096);
  const auto nulls = static_cast<std::size_t>(std::count(head.begin(), head.end(), '\0'));
  const bool has_mark = head.substr(0, 2) == "\xff\xfe" || head.substr(0, 2) == "\xfe\xff";
  if (has_mark || (head.size() > 1 && nulls > head.size() / 3)) return "text in UTF-16";
  const bool is_mac =
      contains(head, '\r') && text.find('\n') == std::string_view::npos && text.find('\r') + 1 < text.size();
  return is_mac ? "text whose lines end with carriage returns alone" : "";
}

class Loader {
 public:
  Loader(Source& source, Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics) {}

  void load(std::string_view text, int file, const fs::path& folder) {
    if (depth() == 1) root_ = folder;
    if (const std::string format = find_other_format(text); !format.empty()) {
      diagnostics_.error("deck.text-format", {source_.files[static_cast<std::size_t>(file)]}, "the file is " + format,
                         "save it as plain text (ASCII or UTF-8) with line feeds");
      return;
    }
    Cursor cursor(text);
    std::string_view raw;
    bool is_after_empty = false;
    while (!done_ && cursor.read_next(raw)) {
      const auto line = cut(raw);
      if (line.empty()) {
        is_after_empty = is_after_empty || trim(raw).empty();
        continue;
      }
      const char c = *std::find_if_not(line.begin(), line.end(), [](char x) { return x == ' ' || x == '\t'; });
      if ((c == 'I' || c == 'i') && is_include(line)) {
        read_include(raw, cursor, file, folder);
        continue;
      }
      if ((c == 'E' || c == 'e') && is_word(find_first_word(line), "ENDDATA")) {
        done_ = true;
        return;
      }
      if (is_after_empty) source_.after_empty.push_back(source_.lines.size());
      is_after_empty = false;
      source_.lines.push_back({line, {file, cursor.get_number()}});
    }
    if (depth() == 1 && !done_ && !source_.lines.empty() && text.back() != '\n')
      diagnostics_.warning("deck.cut-off", {source_.files[static_cast<std::size_t>(file)], cursor.get_number(), 0},
                           "the deck ends within this line, without ENDDATA: it may have been cut off",
                           "compare it with the original; write ENDDATA at its end");
  }

  void push(const std::string& name) { chain_.push_back(name); }
  void pop() { chain_.pop_back(); }

 private:
  std::size_t depth() const { return chain_.size(); }

  std::string_view cut(std::string_view line) {
    if (const void* dollar = std::memchr(line.data(), '$', line.size()))
      line = line.substr(0, static_cast<std::size_t>(static_cast<const char*>(dollar) - line.data()));
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t' || line.back() == '\r')) line.remove_suffix(1);
    // Form feeds and other marks of printers and editors are blanks.
    const auto is_control = [](unsigned char c) { return (c < ' ' && c != '\t' && c != '\r') || c == 127; };
    if (std::any_of(line.begin(), line.end(), is_control)) {
      std::string blank(line);
      std::replace_if(blank.begin(), blank.end(), is_control, ' ');
      while (!blank.empty() && blank.back() == ' ') blank.pop_back();
      if (blank.empty()) return {};
      source_.storage.push_back(std::move(blank));
      line = source_.storage.back();
    }
    if (!line.empty() && contains(line, '\t') && !contains(line, ',')) {
      source_.storage.push_back(expand_tabs(line));
      line = source_.storage.back();
    }
    return line;
  }

  static bool is_include(std::string_view line) {
    const auto word = find_first_word(line);
    if (!is_word(word, "INCLUDE")) return false;
    const auto rest = trim(std::string_view(word.data() + word.size(), line.data() + line.size()));
    // INCLUDE followed by data that is no file name cannot be a bulk card either.
    return rest.empty() || rest.front() != ',';
  }

  /// The name may be quoted, and a quoted name may go on over several lines until its quote closes.
  void read_include(std::string_view raw, Cursor& cursor, int file, const fs::path& folder) {
    const SourceLocation where{source_.files[static_cast<std::size_t>(file)], cursor.get_number(), 0};
    const auto word = find_first_word(raw);
    auto rest = trim(std::string_view(word.data() + word.size(), raw.data() + raw.size()));
    if (!rest.empty() && rest.front() == '=') rest = trim(rest.substr(1));
    std::string name;
    if (!rest.empty() && (rest.front() == '\'' || rest.front() == '"')) {
      const char quote = rest.front();
      rest.remove_prefix(1);
      std::size_t end;
      while ((end = rest.find(quote)) == std::string_view::npos) {
        name += rest;
        if (!cursor.read_next(rest)) {
          diagnostics_.error("deck.include-syntax", where, "the file name of INCLUDE has no closing quote",
                             "close it with the quote it opened with");
          return;
        }
        rest = trim(rest);
      }
      name += rest.substr(0, end);
    } else {
      name = trim(cut(rest));
    }
    name = trim(name);
    if (name.empty()) {
      diagnostics_.error("deck.include-syntax", where, "INCLUDE names no file", "write INCLUDE 'file'");
      return;
    }
    include(name, folder, where, {file, where.line, cursor.get_number(), 0});
  }

  std::optional<fs::path> find_file(const std::string& name, const fs::path& folder) const {
    std::string with_slashes = name;
    std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
    for (const fs::path& from : {folder, root_})
      for (const std::string& spelling : {name, with_slashes}) {
        std::error_code failed;
        if (auto path = from / spelling; fs::is_regular_file(path, failed)) return path;
      }
    return std::nullopt;
  }

  /// SYMBOL of SYMBOL:name; a single letter is a drive.
  static std::string get_symbol(const std::string& name) {
    const auto colon = name.find(':');
    if (colon == std::string::npos || colon < 2) return {};
    const auto is_letter = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    const auto end = name.begin() + static_cast<std::ptrdiff_t>(colon);
    return std::all_of(name.begin(), end, is_letter) ? name.substr(0, colon) : std::string{};
  }

  /// The folder that a logical symbol stands for: the environment variable of this name, or of its capitals.
  static std::optional<std::string> find_symbol(const std::string& symbol) {
    for (const std::string& name : {symbol, make_upper(symbol)})
      if (const char* value = symbol.empty() ? nullptr : std::getenv(name.c_str())) return value;
    return std::nullopt;
  }

  /// A deck that has moved: SYMBOL:name as the path below the folder, a path of another machine by its last part,
  /// letters in another case.
  std::optional<fs::path> find_moved_file(std::string name, const fs::path& folder) const {
    std::replace(name.begin(), name.end(), '\\', '/');
    const auto colon = name.find(':');
    if (colon != std::string::npos) name.erase(0, colon + 1);
    const std::string last = fs::path(name).filename().string();
    for (const std::string& spelling : {name, last})
      if (!spelling.empty() && spelling.front() != '/')
        if (auto path = find_file(spelling, folder)) return path;
    for (const fs::path& from : {folder, root_}) {
      std::error_code failed;
      for (const auto& entry : fs::directory_iterator(from.empty() ? fs::path(".") : from, failed))
        if (make_upper(entry.path().filename().string()) == make_upper(last) && entry.is_regular_file(failed))
          return from / entry.path().filename();
    }
    return std::nullopt;
  }

  /// Between SOL and CEND. Each line is looked at once, however many files are missing.
  bool is_executive() {
    for (; num_looked_at_ < source_.lines.size(); ++num_looked_at_) {
      const auto word = find_first_word(source_.lines[num_looked_at_].text);
      has_sol_ = has_sol_ || is_word(word, "SOL");
      is_past_executive_ = is_past_executive_ || is_word(word, "CEND") || is_word(word, "BEGIN");
    }
    return has_sol_ && !is_past_executive_;
  }

  void fail_many(const std::string& what, const SourceLocation& where) {
    diagnostics_.error("deck.include-many", where, what, "let the deck include each part once");
    done_ = true;
  }

  void include(const std::string& name, const fs::path& folder, const SourceLocation& where, IncludeLine statement) {
    if (++num_includes_ > kMaxIncludes) {
      fail_many("INCLUDE reads more than " + std::to_string(kMaxIncludes) + " files", where);
      return;
    }
    auto path = find_file(name, folder);
    const std::string symbol = get_symbol(name);
    const auto value = find_symbol(symbol);
    if (!path && value) path = find_file(*value + "/" + name.substr(symbol.size() + 1), folder);
    if (!path && (path = find_moved_file(name, folder)))
      diagnostics_.warning(
          "deck.include-moved", where,
          "included file '" + name + "' does not exist; " + path->lexically_normal().string() + " is read instead",
          "correct the name if another file was meant");
    if (!path && is_executive()) {
      diagnostics_.warning("deck.include-missing", where, "included file '" + name + "' does not exist",
                           "it is in the executive control, where DMAP is not run anyway");
      return;
    }
    if (!path) {
      std::error_code none;
      const bool is_there = fs::exists(folder / name, none);
      diagnostics_.error(
          "deck.include-missing", where,
          "included file '" + name + (is_there ? "' is a folder or a pipe, no file" : "' does not exist"),
          symbol.empty() ? "it is looked for in the folder of the including file and of the deck"
          : value        ? symbol + " is '" + *value + "' in the environment"
                         : "set the environment variable " + symbol + " to the folder it stands for");
      return;
    }
    std::error_code failed;
    const std::string canonical = fs::weakly_canonical(*path, failed).string();
    if (std::find(chain_.begin(), chain_.end(), canonical) != chain_.end()) {
      std::string chain;
      for (auto c = std::find(chain_.begin(), chain_.end(), canonical); c != chain_.end(); ++c)
        chain += fs::path(*c).filename().string() + " -> ";
      diagnostics_.error("deck.include-cycle", where,
                         "INCLUDE goes in a circle: " + chain + fs::path(canonical).filename().string(),
                         "remove one of these INCLUDE lines");
      return;
    }
    const std::string shown = path->lexically_normal().string();
    auto known = std::find(source_.files.begin(), source_.files.end(), shown);
    const bool is_new = known == source_.files.end();
    if (is_new) {
      auto bytes = read_input(path->string());
      if (!bytes) {
        diagnostics_.error("deck.include-missing", where, "included file '" + name + "' cannot be read",
                           "check its permissions");
        return;
      }
      known = source_.files.insert(known, shown);
      source_.texts.push_back(*bytes);
      source_.bytes.push_back(std::move(bytes));
    }
    const std::string_view text = source_.texts[static_cast<std::size_t>(known - source_.files.begin())];
    if (!is_new) repeated_ += text.size();
    if (depth() > kMaxIncludeLevels || repeated_ > kMaxRepeated) {
      fail_many(depth() > kMaxIncludeLevels
                    ? "files include files over more than " + std::to_string(kMaxIncludeLevels) + " levels"
                    : std::string("INCLUDE reads a gigabyte of files that were read before"),
                where);
      return;
    }
    statement.target = static_cast<int>(known - source_.files.begin());
    source_.includes.push_back(statement);
    push(canonical);
    load(text, static_cast<int>(known - source_.files.begin()), path->parent_path());
    pop();
  }

  Source& source_;
  Diagnostics& diagnostics_;
  std::vector<std::string> chain_;  ///< canonical paths of the files open now
  fs::path root_;
  std::size_t num_looked_at_ = 0;  ///< lines, by is_executive
  bool has_sol_ = false, is_past_executive_ = false;
  int num_includes_ = 0;
  std::size_t repeated_ = 0;  ///< bytes of files that were included before
  bool done_ = false;
};

void load_root(Source& source, std::shared_ptr<const std::string> bytes, const std::string& name,
               const std::string& canonical, const fs::path& folder, Diagnostics& diagnostics) {
  source.files.push_back(name);
  source.texts.push_back(*bytes);
  source.bytes.push_back(bytes);
  source.lines.reserve(bytes->size() / 60);
  Loader loader(source, diagnostics);
  loader.push(canonical);
  loader.load(*bytes, 0, folder);
  loader.pop();
}

}  // namespace

Source read_source(const std::string& path, Diagnostics& diagnostics) {
  Source source;
  const auto bytes = read_input(path);
  if (!bytes) {
    diagnostics.error("deck.cannot-open", {path, 0, 0}, "the deck cannot be read", "check that the file exists");
    source.files.push_back(path);
    return source;
  }
  std::error_code failed;
  load_root(source, bytes, path, fs::weakly_canonical(path, failed).string(), fs::path(path).parent_path(),
            diagnostics);
  return source;
}

Source read_source_text(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
  Source source;
  load_root(source, std::make_shared<const std::string>(text), name, name, {}, diagnostics);
  return source;
}

}  // namespace bough::nastran::detail
