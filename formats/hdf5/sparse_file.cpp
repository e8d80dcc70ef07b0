#include "formats/hdf5/sparse_file.hpp"

#include <algorithm>
#include <cstdint>

#include "formats/hdf5/detail/reader.hpp"

namespace bough::hdf5 {
namespace {

constexpr int kDeepestGroup = 8;

records::SparseMatrix read_sparse(FileReader& file, const std::string& path) {
  records::SparseMatrix matrix;
  const auto shape = file.read_integers(path + "/shape", 2);
  matrix.indptr = file.read_integers(path + "/indptr", -1);
  matrix.indices = file.read_integers(path + "/indices", -1);
  matrix.data = file.read_array(path + "/data", {-1}).data;
  file.throw_if_errors();
  matrix.num_rows = shape[0];
  matrix.num_cols = shape[1];
  const auto fail = [&](const std::string& what) {
    file.error("hdf5.value", (path.empty() ? "/" : path) + ": " + what, "write the file again");
  };
  if (matrix.num_rows < 0 || matrix.num_cols < 0) {
    fail("the shape is negative");
  } else if (matrix.indptr.size() != static_cast<std::size_t>(matrix.num_rows) + 1) {
    fail("indptr has " + std::to_string(matrix.indptr.size()) + " entries, expected rows + 1 = " +
         std::to_string(std::int64_t{matrix.num_rows} + 1) + "; compressed columns are not read");
  } else if (matrix.data.size() != matrix.indices.size()) {
    fail("data has " + std::to_string(matrix.data.size()) + " entries, indices " +
         std::to_string(matrix.indices.size()));
  } else if (matrix.indptr.front() != 0 || matrix.indptr.back() < 0 ||
             static_cast<std::size_t>(matrix.indptr.back()) != matrix.data.size() ||
             !std::is_sorted(matrix.indptr.begin(), matrix.indptr.end())) {
    fail("indptr does not rise from 0 to the number of entries, " + std::to_string(matrix.data.size()));
  } else if (std::any_of(matrix.indices.begin(), matrix.indices.end(),
                         [&](int column) { return column < 0 || column >= matrix.num_cols; })) {
    fail("indices has a column that is not 0 to " + std::to_string(matrix.num_cols - 1));
  }
  file.throw_if_errors();
  return matrix;
}

void find_matrices(FileReader& file, const std::string& group, int depth, SparseFile& found) {
  const auto names = file.get_children(group.empty() ? "/" : group);
  const auto has = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  if (has("data") && has("indices") && has("indptr") && has("shape")) {
    found.matrices.emplace_back(group.empty() ? group : group.substr(1), read_sparse(file, group));
    return;
  }
  if (depth == kDeepestGroup) return;
  for (const auto& name : names) find_matrices(file, group + "/" + name, depth + 1, found);
}

}  // namespace

SparseFile read_sparse_file(const std::string& path) {
  FileReader file(path);
  SparseFile found;
  find_matrices(file, "", 0, found);
  if (file.has("/dof_map")) found.dof_map = file.read_integer_matrix("/dof_map", -1, 2);
  file.throw_if_errors();
  return found;
}

}  // namespace bough::hdf5
