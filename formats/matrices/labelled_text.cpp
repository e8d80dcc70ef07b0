// Text of one entry a line: CalculiX (jobname.sti, .mas, .dof), Abaqus *MATRIX OUTPUT in the formats MATRIX INPUT and
// COORDINATE.
#include <algorithm>
#include <filesystem>

#include "formats/matrices/detail/dofs.hpp"
#include "formats/matrices/detail/readers.hpp"
#include "formats/matrices/detail/triplets.hpp"

namespace bough::matrices::detail {
namespace {

/// Abaqus' `**` comments, keyword lines and blank lines; a keyword may say that the matrix is not symmetric.
bool is_skipped(std::string_view line, bool& is_unsymmetric) {
  line = trim(line);
  if (line.empty()) return true;
  if (line.front() != '*') return false;
  std::string upper(line);
  for (auto& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  is_unsymmetric |= upper.find("UNSYMMETRIC") != std::string::npos;
  return true;
}

/// Completes a matrix stored by one triangle, unless the file declares it unsymmetric.
void complete(Triplets& entries, bool is_unsymmetric, Matrix& matrix) {
  matrix.form = is_unsymmetric ? kSquare : kSymmetric;
  if (!is_unsymmetric && entries.is_triangular()) entries.mirror(Triangle::Mirror);
}

/// Lines "node.component" of CalculiX.
Eigen::MatrixXi read_dof_list(const std::string& path) {
  TextInput in(path, read_bytes(path));
  std::vector<Dof> dofs;
  while (in.next_line()) {
    const auto line = trim(in.get_line());
    if (line.empty()) continue;
    const auto point = line.find('.');
    const auto node = parse_integer(line.substr(0, point));
    const auto component = point == std::string_view::npos ? std::nullopt : parse_integer(line.substr(point + 1));
    if (!node || !component || *node < 1 || *node > 0x7fffffff || *component < 1 || *component > 6)
      in.fail("matrices.dof", "found " + quote(line) + ", expected node.component with a component of 1 to 6");
    dofs.emplace_back(static_cast<int>(*node), static_cast<int>(*component));
  }
  Eigen::MatrixXi list(static_cast<Eigen::Index>(dofs.size()), 2);
  for (std::size_t i = 0; i < dofs.size(); ++i) list.row(static_cast<Eigen::Index>(i)) << dofs[i].first, dofs[i].second;
  return list;
}

}  // namespace

std::vector<Matrix> read_triplet_lines(const std::string& path) {
  TextInput in(path, read_bytes(path));
  Triplets entries;
  bool is_unsymmetric = false;
  int size = 0;
  while (in.next_line()) {
    if (is_skipped(in.get_line(), is_unsymmetric)) continue;
    const auto words = split(in.get_line(), ',');
    if (words.size() != 3) in.fail_line("row, column and value");
    const auto row = parse_integer(words[0]), column = parse_integer(words[1]);
    const auto value = parse_real(words[2]);
    if (!row || !column || !value) in.fail_line("row, column and value");
    if (*row < 1 || *column < 1 || *row > kMaxRows || *column > kMaxRows)
      in.fail("matrices.index",
              "found " + quote(in.get_line()) + ", expected rows and columns of 1 to " + std::to_string(kMaxRows));
    entries.add(static_cast<int>(*row) - 1, static_cast<int>(*column) - 1, *value);
    size = std::max({size, static_cast<int>(*row), static_cast<int>(*column)});
  }
  Matrix matrix;
  complete(entries, is_unsymmetric, matrix);
  const auto dof_path = std::filesystem::path(path).replace_extension(".dof").string();
  if (dof_path != path && std::filesystem::exists(dof_path)) {
    matrix.row_dofs = matrix.column_dofs = read_dof_list(dof_path);
    if (matrix.row_dofs.rows() < size)
      throw InputError("matrices.dof", {dof_path},
                       "the file names " + std::to_string(matrix.row_dofs.rows()) +
                           " dofs, the matrix next to it has " + std::to_string(size) + " rows",
                       "give the files of one run");
    size = static_cast<int>(matrix.row_dofs.rows());
  }
  entries.compress(size, size, false, matrix);
  return {matrix};
}

std::vector<Matrix> read_abaqus_labels(const std::string& path) {
  TextInput in(path, read_bytes(path));
  Triplets entries;
  DofNumbers dofs;
  bool is_unsymmetric = false;
  while (in.next_line()) {
    if (is_skipped(in.get_line(), is_unsymmetric)) continue;
    const auto words = split(in.get_line(), ',');
    if (words.size() != 5) in.fail_line("node, dof, node, dof and value");
    int place[2];
    for (std::size_t i = 0; i < 2; ++i) {
      const auto node = parse_integer(words[2 * i]), component = parse_integer(words[2 * i + 1]);
      if (!node || !component) in.fail_line("node, dof, node, dof and value");
      if (*node < 1 || *node > 0x7fffffff || *component < 1 || *component > 6)
        in.fail("matrices.dof",
                "found node " + std::to_string(*node) + ", dof " + std::to_string(*component) +
                    ", expected a node id and a dof of 1 to 6",
                "write the matrices of a model of displacements and rotations alone");
      place[i] = dofs.find_or_add({static_cast<int>(*node), static_cast<int>(*component)});
    }
    const auto value = parse_real(words[4]);
    if (!value) in.fail_line("node, dof, node, dof and value");
    entries.add(place[0], place[1], *value);
  }
  Matrix matrix;
  complete(entries, is_unsymmetric, matrix);
  const auto order = dofs.sort(matrix.row_dofs);
  matrix.column_dofs = matrix.row_dofs;
  entries.renumber(order, order);
  entries.compress(dofs.size(), dofs.size(), false, matrix);
  return {matrix};
}

}  // namespace bough::matrices::detail
