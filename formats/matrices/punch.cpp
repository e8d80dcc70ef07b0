// Nastran punch: lines of 72 columns and a sequence number; $ lines are headings.
#include "formats/matrices/detail/input.hpp"
#include "formats/matrices/detail/mode_builder.hpp"

namespace bough::matrices::detail {
namespace {

/// Text after `key` and its equals sign in "$SUBCASE ID =       1".
std::string_view find_value(std::string_view line, std::string_view key) {
  const auto at = line.find(key);
  if (at == std::string_view::npos) return {};
  const auto equals = line.find('=', at + key.size());
  if (equals == std::string_view::npos) return {};
  const auto words = split(line.substr(equals + 1));
  return words.empty() ? std::string_view{} : words.front();
}

class PunchReader {
 public:
  explicit PunchReader(const std::string& path) : in_(path, read_bytes(path)) {}

  std::vector<ModeTable> read() {
    while (in_.next_line()) {
      const auto line = get_columns();
      if (line.empty()) continue;
      if (line.front() == '$') {
        read_title(line);
      } else if (is_in_mode_) {
        read_row(line);
      }
    }
    std::vector<ModeTable> tables;
    for (const auto& [subcase, modes] : modes_) {
      ModeTable table;
      table.subcase = subcase;
      if (!make_table(modes, table))
        in_.fail("matrices.punch", "the modes of subcase " + std::to_string(subcase) + " are not at the same nodes");
      tables.push_back(std::move(table));
    }
    return tables;
  }

 private:
  std::string_view get_columns() const { return trim(in_.get_line().substr(0, 72)); }

  void read_title(std::string_view line) {
    if (line.rfind("$REAL-IMAGINARY", 0) == 0 || line.rfind("$MAGNITUDE-PHASE", 0) == 0) is_complex_ = true;
    if (line.rfind("$REAL OUTPUT", 0) == 0) is_complex_ = false;
    if (line.rfind("$TITLE", 0) == 0) is_in_mode_ = false;
    if (line.rfind("$SUBCASE ID", 0) == 0) {
      const auto id = parse_integer(find_value(line, "$SUBCASE ID"));
      if (!id) in_.fail_line("$SUBCASE ID = and a number");
      if (is_in_mode_ && modes_[subcase_].back().rows.empty())
        in_.fail_line("the rows of a mode before another subcase");
      is_in_mode_ = false;
      subcase_ = static_cast<int>(*id);
    }
    if (line.rfind("$EIGENVALUE", 0) != 0) return;
    const auto eigenvalue = parse_real(find_value(line, "$EIGENVALUE"));
    const auto mode = parse_integer(find_value(line, "MODE"));
    if (!eigenvalue || !mode) in_.fail_line("$EIGENVALUE = and a number, MODE = and a number");
    if (is_complex_) in_.fail("matrices.punch", "the eigenvectors are complex", "solve for real modes");
    modes_[subcase_].push_back({static_cast<int>(*mode), *eigenvalue, {}});
    is_in_mode_ = true;
  }

  /// Id, G or S, three values; -CONT- and three more.
  void read_row(std::string_view line) {
    NodeRow row;
    auto words = split(line);
    const auto id = parse_integer(words[0]);
    if (!id || *id < 1 || *id > 0x7fffffff || words.size() < 2 || (words[1] != "G" && words[1] != "S"))
      in_.fail_line("a node id, G or S, and values");
    row.id = static_cast<int>(*id);
    row.is_scalar = words[1] == "S";
    read_values(words, 2, row.is_scalar ? 1 : 3, row.value);
    if (in_.next_line()) {
      words = split(get_columns());
      const bool is_continued = !words.empty() && words[0] == "-CONT-";
      if (is_continued && !row.is_scalar) read_values(words, 1, 3, row.value + 3);
      if (!is_continued && !row.is_scalar) in_.fail_line("-CONT- and three values");
      if (!is_continued) in_.unread();
    } else if (!row.is_scalar) {
      in_.fail("matrices.truncated", "the file ends within node " + std::to_string(row.id),
               "copy or write the file again");
    }
    modes_[subcase_].back().rows.push_back(row);
  }

  void read_values(const std::vector<std::string_view>& words, std::size_t first, std::size_t count, double* values) {
    if (words.size() < first + count) in_.fail_line(std::to_string(count) + " values");
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = parse_real(words[first + i]);
      if (!value) in_.fail_line("a value in place of " + quote(words[first + i]));
      values[i] = *value;
    }
  }

  TextInput in_;
  int subcase_ = 0;
  bool is_complex_ = false, is_in_mode_ = false;
  std::map<int, std::vector<ModeRows>> modes_;
};

}  // namespace

std::vector<ModeTable> read_punch(const std::string& path) { return PunchReader(path).read(); }

}  // namespace bough::matrices::detail

namespace bough::matrices {

std::vector<ModeTable> read_mode_tables(const std::string& path) {
  const auto head = detail::read_bytes(path, 16);
  const bool is_binary = head.find('\0') != std::string::npos;
  auto tables = is_binary ? detail::read_op2(path) : detail::read_punch(path);
  if (tables.empty())
    throw InputError("matrices.no-modes", {path},
                     std::string("the file holds no real eigenvectors, read as ") + (is_binary ? "OP2" : "punch file"),
                     "ask Nastran for VECTOR(PUNCH,SORT1)=ALL, or for PARAM,POST,-1");
  return tables;
}

}  // namespace bough::matrices
