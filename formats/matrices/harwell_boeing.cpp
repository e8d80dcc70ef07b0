// Harwell-Boeing text (Duff, Grimes & Lewis, RAL-92-086), as ANSYS' HBMAT writes it, with its mapping file.
#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>

#include "formats/matrices/detail/readers.hpp"
#include "formats/matrices/detail/triplets.hpp"

namespace bough::matrices::detail {
namespace {

class HarwellBoeingReader {
 public:
  explicit HarwellBoeingReader(const std::string& path) : in_(path, read_bytes(path)) {}

  Matrix read() {
    in_.demand_line("the title");
    in_.demand_line("the numbers of lines");
    const auto counts = split(in_.get_line());
    const auto num_rhs = counts.size() > 4 ? parse_integer(counts[4]) : std::optional<long>(0);
    if (counts.size() < 4 || !num_rhs) in_.fail_line("five numbers of lines");
    in_.demand_line("type and size");
    read_type();
    in_.demand_line("the formats");
    const auto line = in_.get_line();
    const auto pointers = read_format(line.substr(0, 16)),
               indices = read_format(line.size() > 16 ? line.substr(16, 16) : ""),
               values = read_format(line.size() > 32 ? line.substr(32, 20) : "");
    if (*num_rhs > 0) in_.demand_line("the type of the right-hand sides");

    std::vector<long> begin;
    read_fields(num_cols_ + 1, pointers, [&](std::string_view field, long i) {
      const auto value = parse_integer(field);
      if (!value || *value < (begin.empty() ? 1 : begin.back()) || *value > num_entries_ + 1 || (i == 0 && *value != 1))
        in_.fail("matrices.index", "found the column pointer " + quote(field) +
                                       ", expected numbers that rise from 1 to " + std::to_string(num_entries_ + 1));
      begin.push_back(*value);
    });
    if (begin.back() != num_entries_ + 1)
      in_.fail("matrices.index", "the column pointers end at " + std::to_string(begin.back()) + ", expected " +
                                     std::to_string(num_entries_ + 1));
    std::vector<int> rows;
    read_fields(num_entries_, indices, [&](std::string_view field, long) {
      const auto value = parse_integer(field);
      if (!value || *value < 1 || *value > num_rows_)
        in_.fail("matrices.index", "found the row " + quote(field) + ", expected 1 to " + std::to_string(num_rows_));
      rows.push_back(static_cast<int>(*value) - 1);
    });
    const long per_entry = is_complex_ ? 2 : 1;
    std::vector<double> reals;
    read_fields(num_entries_ * per_entry, values, [&](std::string_view field, long) {
      const auto value = parse_real(field);
      if (!value) in_.fail_line("numbers of " + std::to_string(values.width) + " columns");
      reals.push_back(*value);
    });
    Triplets entries;
    for (long c = 0; c < num_cols_; ++c)
      for (long k = begin[static_cast<std::size_t>(c)] - 1; k < begin[static_cast<std::size_t>(c) + 1] - 1; ++k) {
        const auto at = static_cast<std::size_t>(k * per_entry);
        entries.add(rows[static_cast<std::size_t>(k)], static_cast<int>(c), reals[at],
                    is_complex_ ? reals[at + 1] : 0.0);
      }
    Matrix matrix;
    matrix.form = num_rows_ != num_cols_ ? kRectangular : triangle_ == Triangle::Mirror ? kSymmetric : kSquare;
    // ANSYS marks whole matrices of superelements as symmetric: both triangles are there, nothing is to be mirrored.
    if (entries.is_triangular()) entries.mirror(triangle_);
    entries.compress(static_cast<int>(num_rows_), static_cast<int>(num_cols_), is_complex_, matrix);
    return matrix;
  }

 private:
  void read_type() {
    const auto words = split(in_.get_line());
    if (words.size() < 4 || words[0].size() != 3) in_.fail_line("a type such as RSA, rows, columns and entries");
    const auto letter = [&](std::size_t i) { return std::toupper(static_cast<unsigned char>(words[0][i])); };
    const auto rows = parse_integer(words[1]), columns = parse_integer(words[2]), entries = parse_integer(words[3]);
    if ((letter(0) != 'R' && letter(0) != 'C') || letter(2) != 'A' || !std::strchr("SUHZR", letter(1)))
      in_.fail("matrices.hb-type",
               "the type is " + quote(words[0]) +
                   ", expected R or C, then S, U, H, Z or R, then A: an assembled matrix with values");
    if (!rows || !columns || *rows < 1 || *columns < 1 || *rows > kMaxRows || *columns > kMaxRows || !entries ||
        *entries < 0 || static_cast<std::size_t>(*entries) > in_.count_most(2))
      in_.fail("matrices.size", "found " + quote(in_.get_line()) + ", expected 1 to " + std::to_string(kMaxRows) +
                                    " rows and columns and no more entries than the file can hold");
    is_complex_ = letter(0) == 'C';
    triangle_ = letter(1) == 'S'   ? Triangle::Mirror
                : letter(1) == 'Z' ? Triangle::MirrorNegative
                : letter(1) == 'H' ? Triangle::MirrorConjugate
                                   : Triangle::Both;
    num_rows_ = *rows;
    num_cols_ = *columns;
    num_entries_ = *entries;
    if (triangle_ != Triangle::Both && num_rows_ != num_cols_)
      in_.fail("matrices.hb-type", "the type is " + quote(words[0]) + ", the matrix is not square");
  }

  NumberFormat read_format(std::string_view text) {
    const auto format = parse_number_format(text);
    if (!format) in_.fail("matrices.hb-format", "the format is " + quote(text) + ", expected one such as (10I8)");
    return *format;
  }

  template <class Use>
  void read_fields(long count, const NumberFormat& format, const Use& use) {
    for (long i = 0; i < count;) {
      in_.demand_line("more numbers of the matrix");
      const auto line = in_.get_line();
      const auto words = split(line);
      const auto expected = std::min(format.per_line, static_cast<std::size_t>(count - i));
      // Some writers (SciPy) do not keep to their own format: words between blanks, when there are as many.
      for (std::size_t k = 0; k < expected; ++k, ++i)
        use(words.size() == expected         ? words[k]
            : line.size() > k * format.width ? line.substr(k * format.width, format.width)
                                             : std::string_view{},
            i);
    }
  }

  TextInput in_;
  bool is_complex_ = false;
  Triangle triangle_ = Triangle::Both;
  long num_rows_ = 0, num_cols_ = 0, num_entries_ = 0;
};

/// Lines "equation node label": UX UY UZ ROTX ROTY ROTZ; lines of text are headings.
Eigen::MatrixXi read_mapping(const std::string& path, int size) {
  static constexpr const char* labels[] = {"UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"};
  TextInput in(path, read_bytes(path));
  Eigen::MatrixXi dofs = Eigen::MatrixXi::Zero(size, 2);
  while (in.next_line()) {
    const auto words = split(in.get_line());
    if (words.size() != 3) continue;
    const auto equation = parse_integer(words[0]), node = parse_integer(words[1]);
    if (!equation || !node) continue;
    int component = 0;
    for (int c = 0; c < 6; ++c)
      if (equals_ignoring_case(words[2], labels[c])) component = c + 1;
    if (*equation < 1 || *equation > size || *node < 1 || *node > 0x7fffffff || component == 0)
      in.fail("matrices.dof", "found " + quote(in.get_line()) + ", expected an equation of 1 to " +
                                  std::to_string(size) + ", a node and UX, UY, UZ, ROTX, ROTY or ROTZ");
    dofs.row(*equation - 1) << static_cast<int>(*node), component;
  }
  for (int i = 0; i < size; ++i)
    if (dofs(i, 0) == 0)
      throw InputError("matrices.dof", {path}, "equation " + std::to_string(i + 1) + " has no node",
                       "give the mapping file of this matrix");
  return dofs;
}

}  // namespace

std::vector<Matrix> read_harwell_boeing(const std::string& path) {
  auto matrix = HarwellBoeingReader(path).read();
  for (const char* ending : {".mapping", ".MAPPING"}) {
    const auto mapping = std::filesystem::path(path).replace_extension(ending).string();
    if (mapping == path || matrix.form == kRectangular || !std::filesystem::exists(mapping)) continue;
    matrix.row_dofs = matrix.column_dofs = read_mapping(mapping, matrix.values.num_rows);
    break;
  }
  return {matrix};
}

}  // namespace bough::matrices::detail
