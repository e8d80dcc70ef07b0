#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "base/diagnostic.hpp"
#include "formats/matrices/detail/op4_header.hpp"
#include "formats/matrices/op4.hpp"

namespace bough::matrices {
namespace {

using namespace detail;

/// Consecutive rows of a column.
struct Run {
  int row = 0;
  std::vector<double> reals;  ///< real and imaginary part in turn when complex
};

/// The columns of compressed rows, as runs: one run of everything for the dense layout.
class Columns {
 public:
  explicit Columns(const Matrix& matrix) : matrix_(matrix) {
    const auto& a = matrix.values;
    begin_.assign(static_cast<std::size_t>(a.num_cols) + 1, 0);
    for (const int column : a.indices) ++begin_[static_cast<std::size_t>(column) + 1];
    for (std::size_t c = 0; c + 1 < begin_.size(); ++c) begin_[c + 1] += begin_[c];
    row_.resize(a.data.size());
    from_.resize(a.data.size());
    auto next = begin_;
    for (int r = 0; r < a.num_rows; ++r)
      for (int k = a.indptr[static_cast<std::size_t>(r)]; k < a.indptr[static_cast<std::size_t>(r) + 1]; ++k) {
        const auto at = next[static_cast<std::size_t>(a.indices[static_cast<std::size_t>(k)])]++;
        row_[at] = r;
        from_[at] = static_cast<std::size_t>(k);
      }
  }

  std::vector<Run> make_runs(int column, bool is_dense) const {
    std::vector<Run> runs;
    const bool is_complex = matrix_.is_complex;
    int expected = -1;
    for (auto i = begin_[static_cast<std::size_t>(column)]; i < begin_[static_cast<std::size_t>(column) + 1]; ++i) {
      if (runs.empty() || (!is_dense && row_[i] != expected)) runs.push_back({row_[i], {}});
      auto& run = runs.back();
      if (is_dense) run.reals.resize(static_cast<std::size_t>(row_[i] - run.row) * (is_complex ? 2 : 1), 0.0);
      run.reals.push_back(matrix_.values.data[from_[i]]);
      if (is_complex) run.reals.push_back(matrix_.imaginary[from_[i]]);
      expected = row_[i] + 1;
    }
    return runs;
  }

 private:
  const Matrix& matrix_;
  std::vector<std::size_t> begin_, from_;
  std::vector<int> row_;
};

class TextWriter {
 public:
  TextWriter(std::ostream& out, const Op4Options& options) : out_(out), options_(options) {
    width_ = options.digits + 7;
    per_line_ = std::max(1, 80 / width_);
  }
  void write_header(const Op4Header& h) {
    char format[24];
    std::snprintf(format, sizeof format, "1P,%d%c%d.%d", per_line_, options_.exponent, width_, options_.digits);
    print("%8ld%8ld%8ld%8ld%-8s%-16s\n", h.num_cols, h.num_rows, h.form, h.type, h.name.c_str(), format);
  }
  void write_dense(int column, const Run& run) {
    print("%8d%8d%8d\n", column, run.row + 1, static_cast<int>(run.reals.size()));
    write_reals(run.reals);
  }
  void write_strings(int column, const std::vector<Run>& runs, int words_per_real, bool is_bigmat) {
    long words = 0;
    for (const auto& run : runs) words += (is_bigmat ? 2 : 1) + static_cast<long>(run.reals.size()) * words_per_real;
    print("%8d%8d%8ld\n", column, 0, words);
    for (const auto& run : runs) {
      const long length = static_cast<long>(run.reals.size()) * words_per_real;
      if (is_bigmat) {
        print("%8ld%8d\n", length + 1, run.row + 1);
      } else {
        print("%11ld\n", run.row + 1 + 65536 * (length + 1));
      }
      write_reals(run.reals);
    }
  }
  void write_end(long column) {
    print("%8ld%8d%8d\n", column, 1, 1);
    write_reals({1.0});
  }

 private:
  template <class... T>
  void print(const char* format, T... values) {
    char line[128];
    std::snprintf(line, sizeof line, format, values...);
    out_ << line;
  }
  void write_reals(const std::vector<double>& reals) {
    char text[64];
    for (std::size_t i = 0; i < reals.size(); ++i) {
      std::snprintf(text, sizeof text, "%.*E", options_.digits, reals[i]);
      char* letter = std::strrchr(text, 'E');
      if (letter && std::strlen(letter) > 4)
        std::memmove(letter, letter + 1, std::strlen(letter));  // "-1.5-300", as Fortran writes three digits
      else if (letter)
        *letter = options_.exponent;
      print("%*s", width_, text);
      out_ << ((i + 1) % static_cast<std::size_t>(per_line_) == 0 || i + 1 == reals.size() ? "\n" : "");
    }
  }

  std::ostream& out_;
  const Op4Options& options_;
  int width_ = 23, per_line_ = 3;
};

class BinaryWriter {
 public:
  BinaryWriter(std::ostream& out, const Op4Options& options) : out_(out), options_(options) {}
  void write_header(const Op4Header& h) {
    for (const long value : {h.num_cols, h.num_rows, h.form, h.type}) put_integer(value);
    auto name = h.name;
    name.resize(options_.is_64_bit ? 16 : 8, ' ');
    record_ += name;
    flush();
  }
  void write_dense(int column, const Run& run) {
    const int words_per_real = options_.is_single || options_.is_64_bit ? 1 : 2;
    put_head(column, run.row + 1, static_cast<long>(run.reals.size()) * words_per_real);
    put_reals(run.reals);
    flush();
  }
  void write_strings(int column, const std::vector<Run>& runs, int words_per_real, bool is_bigmat) {
    long words = 0;
    for (const auto& run : runs) words += (is_bigmat ? 2 : 1) + static_cast<long>(run.reals.size()) * words_per_real;
    put_head(column, 0, words);
    for (const auto& run : runs) {
      const long length = static_cast<long>(run.reals.size()) * words_per_real;
      if (is_bigmat) {
        put_integer(length + 1);
        put_integer(run.row + 1);
      } else {
        put_integer(run.row + 1 + 65536 * (length + 1));
      }
      put_reals(run.reals);
    }
    flush();
  }
  void write_end(long column) {
    put_head(column, 1, options_.is_single || options_.is_64_bit ? 1 : 2);
    put_reals({1.0});
    flush();
  }

 private:
  void put_head(long column, long row, long words) {
    put_integer(column);
    put_integer(row);
    put_integer(words);
  }
  void put_integer(long value) {
    if (options_.is_64_bit) {
      put(record_, static_cast<std::int64_t>(value));
    } else {
      put(record_, static_cast<std::int32_t>(value));
    }
  }
  void put_reals(const std::vector<double>& reals) {
    for (const double value : reals) {
      if (options_.is_single && !options_.is_64_bit) {
        put(record_, static_cast<float>(value));
      } else {
        put(record_, value);
      }
    }
  }
  template <class T>
  void put(std::string& to, T value) const {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (options_.is_big_endian == (std::endian::native == std::endian::little)) std::reverse(raw, raw + sizeof(T));
    to.append(raw, sizeof(T));
  }
  void flush() {
    std::string marker;
    put(marker, static_cast<std::int32_t>(record_.size()));
    out_ << marker << record_ << marker;
    record_.clear();
  }

  std::ostream& out_;
  const Op4Options& options_;
  std::string record_;
};

template <class Writer>
void write(Writer&& writer, const Matrix& matrix, const Op4Options& options) {
  const bool is_bigmat = options.layout == Op4Layout::Strings &&
                         (options.is_bigmat || matrix.values.num_rows >= static_cast<int>(kBigRows));
  const long rows = is_bigmat ? -static_cast<long>(matrix.values.num_rows) : matrix.values.num_rows;
  const long type = (matrix.is_complex ? 3 : 1) + (options.is_single ? 0 : 1);
  writer.write_header({matrix.values.num_cols, rows, matrix.form, type, matrix.name, is_bigmat});
  const bool is_dense = options.layout == Op4Layout::Dense;
  const int words_per_real = options.is_single || (!options.is_text && options.is_64_bit) ? 1 : 2;
  const Columns columns(matrix);
  for (int c = 0; c < matrix.values.num_cols; ++c) {
    auto runs = columns.make_runs(c, is_dense);
    if (runs.empty()) continue;
    if (is_dense) {
      writer.write_dense(c + 1, runs.front());
    } else {
      // A string header of 32 bits holds L + 1 up to 32767: longer runs are cut.
      std::vector<Run> pieces;
      const std::size_t max_reals = is_bigmat ? std::size_t{1} << 28 : 8190 * (matrix.is_complex ? 2 : 1);
      for (auto& run : runs)
        for (std::size_t i = 0; i < run.reals.size(); i += max_reals) {
          const auto end = std::min(i + max_reals, run.reals.size());
          pieces.push_back({run.row + static_cast<int>(i / (matrix.is_complex ? 2 : 1)),
                            {run.reals.begin() + static_cast<std::ptrdiff_t>(i),
                             run.reals.begin() + static_cast<std::ptrdiff_t>(end)}});
        }
      writer.write_strings(c + 1, pieces, words_per_real, is_bigmat);
    }
  }
  writer.write_end(static_cast<long>(matrix.values.num_cols) + 1);
}

}  // namespace

void write_op4(std::ostream& out, const Matrix& matrix, const Op4Options& options) {
  BOUGH_DEMAND(!matrix.name.empty() && matrix.name.size() <= 8 && options.digits >= 1 && options.digits <= 40);
  if (options.is_text) {
    write(TextWriter(out, options), matrix, options);
  } else {
    write(BinaryWriter(out, options), matrix, options);
  }
}

void write_op4(std::ostream& out, const records::SparseMatrix& matrix, const std::string& name,
               const Op4Options& options) {
  Matrix named;
  named.name = name;
  named.form = kSymmetric;
  named.values = matrix;
  write_op4(out, named, options);
}

}  // namespace bough::matrices
