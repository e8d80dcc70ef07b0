#include <algorithm>

#include "formats/matrices/detail/input.hpp"
#include "formats/matrices/detail/op4_header.hpp"
#include "formats/matrices/op4.hpp"

namespace bough::matrices {
namespace {

using namespace detail;

class TextReader {
 public:
  explicit TextReader(const std::string& path) : in_(path, read_bytes(path)) {}

  std::vector<Matrix> read() {
    std::vector<Matrix> matrices;
    while (in_.next_line())
      if (!trim(in_.get_line()).empty()) matrices.push_back(read_matrix());
    return matrices;
  }

 private:
  Matrix read_matrix() {
    read_header();
    Triplets entries;
    for (;;) {
      in_.demand_line("a column or the end of the matrix (three integers)");
      const auto [column, row, count] = read_three();
      if (column > header_.num_cols) {
        // The end: column NCOL + 1 with one number that means nothing.
        if (in_.next_line() && !parse_real(in_.get_line().substr(0, format_.width))) in_.unread();
        return make_op4_matrix(header_, entries);
      }
      if (column < 1 || row < 0 || count < 0)
        in_.fail("matrices.op4-column", "found " + quote(in_.get_line()) + ", expected a column of 1 to " +
                                            std::to_string(header_.num_cols) + ", its first row and its size");
      if (row > 0) {
        read_reals(count, row, column, entries);
      } else {
        read_strings(count, column, entries);
      }
    }
  }

  void read_header() {
    const auto line = in_.get_line();
    header_ = {};
    long* const fields[] = {&header_.num_cols, &header_.num_rows, &header_.form, &header_.type};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto value = line.size() > 8 * i ? parse_integer(line.substr(8 * i, 8)) : std::nullopt;
      if (!value)
        in_.fail("matrices.op4-header",
                 "found " + quote(line) + ", expected NCOL NROW NF NTYPE of eight columns each, a name and a format",
                 "the matrix before it may be longer or shorter than it says: write the file again");
      *fields[i] = *value;
    }
    header_.name = line.size() > 32 ? std::string(trim(line.substr(32, 8))) : "";
    settle_header(header_, in_.count_most(1), claimed_,
                  [this](const char* id, const std::string& what) { in_.fail(id, what); });
    format_ = line.size() > 40 && !trim(line.substr(40)).empty() ? parse_format(line.substr(40)) : NumberFormat{};
  }

  NumberFormat parse_format(std::string_view text) {
    const auto format = parse_number_format(text);
    if (!format) in_.fail("matrices.op4-format", "the format is " + quote(text) + ", expected one such as 1P,5E16.9");
    return *format;
  }

  struct Three {
    long a = 0, b = 0, c = 0;
  };
  Three read_three() {
    const auto line = in_.get_line();
    const auto a = parse_integer(line.substr(0, 8));
    const auto b = line.size() > 8 ? parse_integer(line.substr(8, 8)) : std::nullopt;
    const auto c = line.size() > 16 ? parse_integer(line.substr(16)) : std::nullopt;
    if (!a || !b || !c)
      in_.fail("matrices.op4-column", "found " + quote(line) + ", expected three integers of eight columns each",
               "the column before may be longer or shorter than it says: write the file again");
    return {*a, *b, *c};
  }

  void read_strings(long num_words, long column, Triplets& entries) {
    const long words_per_real = header_.is_double() ? 2 : 1;
    while (num_words > 0) {
      in_.demand_line("a string of the column");
      StringHeader string;
      if (header_.is_bigmat) {
        const auto line = in_.get_line();
        const auto length = parse_integer(line.substr(0, 8));
        const auto row = line.size() > 8 ? parse_integer(line.substr(8)) : std::nullopt;
        if (!length || !row) in_.fail("matrices.op4-string", "found " + quote(line) + ", expected L+1 and IROW");
        string = {*length - 1, *row};
        num_words -= 2 + string.num_words;
      } else {
        const auto is = parse_integer(in_.get_line());
        if (!is || *is < 0)
          in_.fail("matrices.op4-string", "found " + quote(in_.get_line()) + ", expected IS = IROW + 65536 (L + 1)");
        string = unpack_string_header(*is);
        num_words -= 1 + string.num_words;
      }
      if (string.num_words <= 0 || string.row < 1 || num_words < 0)
        in_.fail("matrices.op4-string", "found " + quote(in_.get_line()) + ": the string has " +
                                            std::to_string(string.num_words) + " words from row " +
                                            std::to_string(string.row) + ", which the column does not hold");
      read_reals(string.num_words / words_per_real, string.row, column, entries);
    }
  }

  void read_reals(long num_reals, long row, long column, Triplets& entries) {
    const long num_entries = num_reals / header_.reals_per_entry();
    if (num_reals % header_.reals_per_entry() != 0 || row + num_entries - 1 > header_.num_rows)
      in_.fail("matrices.op4-column", std::to_string(num_entries) + " entries from row " + std::to_string(row) +
                                          " of column " + std::to_string(column) + ", the matrix has " +
                                          std::to_string(header_.num_rows) + " rows");
    double real_part = 0;
    for (long i = 0; i < num_reals;) {
      in_.demand_line("the numbers of a column");
      const auto line = in_.get_line();
      const auto used = format_.width * std::min(format_.per_line, static_cast<std::size_t>(num_reals - i));
      if (line.size() > used && !trim(line.substr(used)).empty())
        in_.fail("matrices.op4-format",
                 "found " + quote(line.substr(used)) + " after column " + std::to_string(used) +
                     ", where the numbers of this line end",
                 "the format of the header is not that of the numbers: write the file again");
      for (std::size_t k = 0; k < format_.per_line && i < num_reals; ++k, ++i) {
        const auto value =
            line.size() > k * format_.width ? parse_real(line.substr(k * format_.width, format_.width)) : std::nullopt;
        if (!value)
          in_.fail_line("a number in columns " + std::to_string(k * format_.width + 1) + " to " +
                        std::to_string((k + 1) * format_.width));
        const int r = static_cast<int>(row + i / header_.reals_per_entry()) - 1, c = static_cast<int>(column) - 1;
        if (!header_.is_complex()) {
          if (*value != 0) entries.add(r, c, *value);
        } else if (i % 2 == 0) {
          real_part = *value;
        } else if (real_part != 0 || *value != 0) {
          entries.add(r, c, real_part, *value);
        }
      }
    }
  }

  TextInput in_;
  Op4Header header_;
  double claimed_ = 0;
  NumberFormat format_;
};

}  // namespace

std::vector<Matrix> read_op4_text(const std::string& path) { return TextReader(path).read(); }

}  // namespace bough::matrices
