#include "formats/matrices/matrix_reader.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "formats/hdf5/sparse_file.hpp"
#include "formats/matrices/detail/readers.hpp"
#include "formats/matrices/op4.hpp"

namespace bough::matrices {

using namespace detail;

namespace {

constexpr std::string_view kHdf5Signature("\x89HDF\r\n\x1a\n", 8);

/// The first lines are enough to tell the text formats apart.
constexpr std::size_t kHeadBytes = 1 << 16;

bool is_op4_header(std::string_view line) {
  if (line.size() < 33) return false;
  for (std::size_t i = 0; i < 4; ++i)
    if (!parse_integer(line.substr(8 * i, 8))) return false;
  return !parse_integer(line.substr(32, 8));
}

/// The third line of a Harwell-Boeing file: RSA and four numbers.
bool is_harwell_boeing(const std::vector<std::string>& lines) {
  if (lines.size() < 4) return false;
  const auto words = split(lines[2]);
  if (words.size() < 4 || words[0].size() != 3 || !std::strchr("RCPrcp", words[0][0])) return false;
  return std::all_of(words.begin() + 1, words.begin() + 4, [](auto w) { return parse_integer(w).has_value(); }) &&
         lines[3].find('(') != std::string::npos;
}

bool are_numbers(const std::vector<std::string_view>& words) {
  for (std::size_t i = 0; i + 1 < words.size(); ++i)
    if (!parse_integer(words[i])) return false;
  return !words.empty() && parse_real(words.back());
}

std::optional<Format> detect_text(const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  if (equals_ignoring_case(std::string_view(lines[0]).substr(0, 14), "%%MatrixMarket")) return Format::MatrixMarket;
  if (is_harwell_boeing(lines)) return Format::HarwellBoeing;
  for (const auto& line : lines) {
    const auto text = trim(line);
    if (text.empty() || text.front() == '*' || text.front() == '$') continue;
    if (is_op4_header(line)) return Format::Op4Text;
    if (equals_ignoring_case(text.substr(0, 4), "DMIG")) return Format::Dmig;
    const auto words = split(text, ',');
    if (words.size() == 5 && are_numbers(words)) return Format::AbaqusLabels;
    if (words.size() == 3 && are_numbers(words)) return Format::Triplets;
    // Decks and punch files hold more than DMIG: one such line among the first makes it one.
    const bool has_dmig = std::any_of(lines.begin(), lines.end(), [](const std::string& l) {
      return equals_ignoring_case(trim(l).substr(0, 4), "DMIG");
    });
    return has_dmig ? std::optional(Format::Dmig) : std::nullopt;
  }
  return {};
}

std::vector<std::string> split_lines(const std::string& head) {
  std::vector<std::string> lines;
  TextInput in("", head);
  while (in.next_line()) lines.emplace_back(in.get_line());
  return lines;
}

std::string list_names(const std::vector<Matrix>& matrices) {
  std::string names;
  for (std::size_t i = 0; i < matrices.size() && i < 20; ++i) names += (i > 0 ? ", " : "") + matrices[i].name;
  return names + (matrices.size() > 20 ? ", ..." : "");
}

}  // namespace

namespace detail {

std::vector<Matrix> read_hdf5(const std::string& path) {
  auto file = hdf5::read_sparse_file(path);
  std::vector<Matrix> matrices;
  for (auto& [name, values] : file.matrices) {
    Matrix matrix;
    matrix.name = name;
    matrix.form = values.num_rows == values.num_cols ? kSquare : kRectangular;
    if (file.dof_map.rows() == values.num_rows) matrix.row_dofs = file.dof_map;
    if (file.dof_map.rows() == values.num_cols) matrix.column_dofs = file.dof_map;
    matrix.values = std::move(values);
    matrices.push_back(std::move(matrix));
  }
  return matrices;
}

}  // namespace detail

namespace {

struct FormatRow {
  Format format;
  std::string_view name;
  std::vector<Matrix> (*read)(const std::string& path, Diagnostics& diagnostics);
};

/// Adapts a reader without diagnostics to the type of those with diagnostics.
template <std::vector<Matrix> (*read)(const std::string&)>
std::vector<Matrix> read_by(const std::string& path, Diagnostics&) {
  return read(path);
}

const FormatRow& get_row(Format format) {
  static const FormatRow rows[] = {{Format::Op4Text, "Nastran OUTPUT4, formatted", read_by<read_op4_text>},
                                   {Format::Op4Binary, "Nastran OUTPUT4, binary", read_by<read_op4_binary>},
                                   {Format::Dmig, "Nastran DMIG", read_dmig},
                                   {Format::MatrixMarket, "Matrix Market", read_by<read_matrix_market>},
                                   {Format::Hdf5, "HDF5, compressed rows", read_by<read_hdf5>},
                                   {Format::Mat, "MATLAB", read_by<read_mat>},
                                   {Format::HarwellBoeing, "Harwell-Boeing", read_by<read_harwell_boeing>},
                                   {Format::AbaqusLabels, "Abaqus matrix input", read_by<read_abaqus_labels>},
                                   {Format::Triplets, "row column value", read_by<read_triplet_lines>}};
  const auto at = std::find_if(std::begin(rows), std::end(rows), [&](const auto& row) { return row.format == format; });
  BOUGH_DEMAND(at != std::end(rows));
  return *at;
}

}  // namespace

std::string_view get_format_name(Format format) { return get_row(format).name; }

Format detect_format(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw InputError("matrices.cannot-open", {path}, "this is a folder", "give a file");
  const auto head = read_bytes(path, kHeadBytes);
  if (head.empty()) throw InputError("matrices.empty", {path}, "the file is empty", "write it again");
  if (std::string_view(head).substr(0, 8) == kHdf5Signature) return Format::Hdf5;
  if (head.compare(0, 10, "MATLAB 5.0") == 0 || head.compare(0, 10, "MATLAB 7.3") == 0) return Format::Mat;
  if (head.size() >= 4) {
    unsigned char raw[4];
    std::memcpy(raw, head.data(), 4);
    const bool is_little = (raw[0] == 24 || raw[0] == 48) && !raw[1] && !raw[2] && !raw[3];
    const bool is_big = (raw[3] == 24 || raw[3] == 48) && !raw[0] && !raw[1] && !raw[2];
    if (is_little || is_big) return Format::Op4Binary;
  }
  if (head.find('\0') == std::string::npos)
    if (const auto format = detect_text(split_lines(head)); format) return *format;
  throw InputError("matrices.unknown-format", {path}, "the file is of no format that holds matrices",
                   "give Nastran OUTPUT4 or DMIG, Matrix Market, HDF5 with compressed rows, MATLAB, Harwell-Boeing, "
                   "CalculiX .sti/.mas or Abaqus matrix text");
}

std::vector<Matrix> read_matrices(const std::string& path, Diagnostics& diagnostics) {
  return get_row(detect_format(path)).read(path, diagnostics);
}

Matrix read_matrix(const std::string& path, const std::string& name, Diagnostics& diagnostics) {
  auto matrices = read_matrices(path, diagnostics);
  if (matrices.empty()) throw InputError("matrices.empty", {path}, "the file holds no matrix", "give a file with one");
  const bool has_names = matrices.size() > 1 || !matrices.front().name.empty();
  if (name.empty() || !has_names) {
    if (matrices.size() == 1) return std::move(matrices.front());
    throw InputError("matrices.several", {path}, "the file holds " + list_names(matrices), "name the one to take");
  }
  for (auto& matrix : matrices)
    if (equals_ignoring_case(matrix.name, name)) return std::move(matrix);
  std::vector<std::string> names;
  for (const auto& matrix : matrices) names.push_back(matrix.name);
  const auto nearest = find_nearest(name, names);
  throw InputError("matrices.unknown-name", {path},
                   "the file holds no matrix \"" + name + "\", found " + list_names(matrices),
                   nearest.empty() ? "give one of these names" : "did you mean " + nearest + "?");
}

Matrix read_real_square_matrix(const std::string& path, const std::string& name, Diagnostics& diagnostics) {
  auto matrix = read_matrix(path, name, diagnostics);
  const auto title = matrix.name.empty() ? std::string("the matrix") : "matrix " + matrix.name;
  const bool has_imaginary =
      std::any_of(matrix.imaginary.begin(), matrix.imaginary.end(), [](double value) { return value != 0; });
  if (has_imaginary)
    throw InputError("matrices.complex", {path}, title + " is complex, expected real values",
                     "give structural damping as a damping of the modes");
  if (matrix.values.num_rows != matrix.values.num_cols)
    throw InputError("matrices.not-square", {path},
                     title + " has " + std::to_string(matrix.values.num_rows) + " rows and " +
                         std::to_string(matrix.values.num_cols) + " columns, expected as many");
  matrix.is_complex = false;
  matrix.imaginary.clear();
  return matrix;
}

}  // namespace bough::matrices
