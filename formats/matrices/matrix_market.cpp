#include "formats/matrices/matrix_market.hpp"

#include <cstdio>

#include "formats/matrices/detail/readers.hpp"
#include "formats/matrices/detail/triplets.hpp"

namespace bough::matrices {

void write_matrix_market(std::ostream& out, const records::SparseMatrix& matrix, const std::string& comment) {
  const auto visit = [&](const auto& use) {
    for (int row = 0; row < matrix.num_rows; ++row)
      for (int k = matrix.indptr[static_cast<std::size_t>(row)]; k < matrix.indptr[static_cast<std::size_t>(row) + 1];
           ++k)
        if (const int column = matrix.indices[static_cast<std::size_t>(k)]; column <= row)
          use(row, column, matrix.data[static_cast<std::size_t>(k)]);
  };
  std::size_t count = 0;
  visit([&](int, int, double) { ++count; });
  out << "%%MatrixMarket matrix coordinate real symmetric\n% " << comment << '\n'
      << matrix.num_rows << ' ' << matrix.num_cols << ' ' << count << '\n';
  char line[80];
  visit([&](int row, int column, double value) {
    std::snprintf(line, sizeof line, "%d %d %.17g\n", row + 1, column + 1, value);
    out << line;
  });
}

namespace detail {
namespace {

class MarketReader {
 public:
  explicit MarketReader(const std::string& path) : in_(path, read_bytes(path)) {}

  Matrix read() {
    read_banner();
    skip_comments("the size line");
    const auto words = split(in_.get_line());
    if (words.size() != (is_array_ ? 2U : 3U))
      in_.fail_line(is_array_ ? "rows and columns" : "rows, columns and entries");
    num_rows_ = read_size(words[0]);
    num_cols_ = read_size(words[1]);
    if (triangle_ != Triangle::Both && num_rows_ != num_cols_)
      in_.fail("matrices.market", "a symmetric matrix of " + std::to_string(num_rows_) + " x " +
                                      std::to_string(num_cols_) + ", expected as many rows as columns");
    Triplets entries;
    if (is_array_) {
      read_array(entries);
    } else {
      const auto count = parse_integer(words[2]);
      if (!count || *count < 0) in_.fail_line("the number of entries");
      for (long i = 0; i < *count; ++i) read_entry(entries);
    }
    while (in_.next_line())
      if (!trim(in_.get_line()).empty())
        in_.fail("matrices.market", "found " + quote(in_.get_line()) + " after the last entry",
                 "the size line gives too few entries: write the file again");
    Matrix matrix;
    matrix.form = num_rows_ != num_cols_ ? kRectangular : triangle_ == Triangle::Mirror ? kSymmetric : kSquare;
    entries.mirror(triangle_);
    entries.compress(static_cast<int>(num_rows_), static_cast<int>(num_cols_), is_complex_, matrix);
    return matrix;
  }

 private:
  void read_banner() {
    in_.demand_line("%%MatrixMarket");
    const auto words = split(in_.get_line());
    const auto is = [&](std::size_t i, const char* word) {
      return words.size() > i && equals_ignoring_case(words[i], word);
    };
    if (words.size() != 5 || !is(1, "matrix") || !(is(2, "coordinate") || is(2, "array")) ||
        !(is(3, "real") || is(3, "integer") || is(3, "complex") || is(3, "double")) ||
        !(is(4, "general") || is(4, "symmetric") || is(4, "skew-symmetric") || is(4, "hermitian")))
      in_.fail("matrices.market",
               "found " + quote(in_.get_line()) +
                   ", expected matrix, coordinate or array, real, integer or complex, and general, symmetric, "
                   "skew-symmetric or hermitian",
               is(3, "pattern") ? "a pattern has no values: write the values too" : "");
    is_array_ = is(2, "array");
    is_complex_ = is(3, "complex");
    if (is(4, "symmetric")) triangle_ = Triangle::Mirror;
    if (is(4, "skew-symmetric")) triangle_ = Triangle::MirrorNegative;
    if (is(4, "hermitian")) triangle_ = Triangle::MirrorConjugate;
  }

  void skip_comments(const char* expected) {
    do in_.demand_line(expected);
    while (trim(in_.get_line()).empty() || in_.get_line().front() == '%');
  }

  long read_size(std::string_view word) {
    const auto size = parse_integer(word);
    if (!size || *size < 1 || *size > kMaxRows)
      in_.fail("matrices.size",
               "found " + quote(in_.get_line()) + ", expected 1 to " + std::to_string(kMaxRows) + " rows and columns");
    return *size;
  }

  /// The values from word `first` on.
  void add(const std::vector<std::string_view>& words, std::size_t first, long row, long column, Triplets& entries) {
    const auto re = parse_real(words[first]);
    const auto im = is_complex_ ? parse_real(words[first + 1]) : std::optional<double>(0);
    if (!re || !im) in_.fail_line("a number");
    entries.add(static_cast<int>(row), static_cast<int>(column), *re, *im);
  }

  void read_entry(Triplets& entries) {
    skip_comments("an entry: row, column, value");
    const auto words = split(in_.get_line());
    if (words.size() != (is_complex_ ? 4U : 3U)) in_.fail_line("row, column and value");
    const auto row = parse_integer(words[0]), column = parse_integer(words[1]);
    if (!row || !column || *row < 1 || *column < 1 || *row > num_rows_ || *column > num_cols_)
      in_.fail("matrices.index", "found " + quote(in_.get_line()) + ", the matrix has " + std::to_string(num_rows_) +
                                     " rows and " + std::to_string(num_cols_) + " columns");
    add(words, 2, *row - 1, *column - 1, entries);
  }

  /// Column by column; of a symmetric matrix from the diagonal down, of a skew one from below it.
  void read_array(Triplets& entries) {
    for (long c = 0; c < num_cols_; ++c) {
      const long first = triangle_ == Triangle::Both ? 0 : triangle_ == Triangle::MirrorNegative ? c + 1 : c;
      for (long r = first; r < num_rows_; ++r) {
        skip_comments("a value");
        const auto words = split(in_.get_line());
        if (words.size() != (is_complex_ ? 2U : 1U)) in_.fail_line("one value");
        add(words, 0, r, c, entries);
      }
    }
  }

  TextInput in_;
  bool is_array_ = false, is_complex_ = false;
  Triangle triangle_ = Triangle::Both;
  long num_rows_ = 0, num_cols_ = 0;
};

}  // namespace

std::vector<Matrix> read_matrix_market(const std::string& path) { return {MarketReader(path).read()}; }

}  // namespace detail
}  // namespace bough::matrices
