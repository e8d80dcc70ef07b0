#include "bough/formats/export/matrix_files.hpp"

#include <cstdio>

#include "bough/base/diagnostic.hpp"

namespace bough::exports {

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

void write_output4(std::ostream& out, const records::SparseMatrix& matrix, const std::string& name) {
  BOUGH_DEMAND(name.size() <= 8 && matrix.num_rows == matrix.num_cols);
  char line[80];
  std::snprintf(line, sizeof line, "%8d%8d%8d%8d%-8s%-16s\n", matrix.num_cols, matrix.num_rows, 6, 2, name.c_str(),
                "1P,3E23.16");
  out << line;
  // A symmetric matrix: its rows are its columns.
  for (int column = 0; column < matrix.num_cols; ++column) {
    const int begin = matrix.indptr[static_cast<std::size_t>(column)],
              end = matrix.indptr[static_cast<std::size_t>(column) + 1];
    if (begin == end) continue;
    const int first = matrix.indices[static_cast<std::size_t>(begin)];
    std::vector<double> values(static_cast<std::size_t>(matrix.indices[static_cast<std::size_t>(end - 1)] - first + 1),
                               0.0);
    for (int k = begin; k < end; ++k)
      values[static_cast<std::size_t>(matrix.indices[static_cast<std::size_t>(k)] - first)] =
          matrix.data[static_cast<std::size_t>(k)];
    std::snprintf(line, sizeof line, "%8d%8d%8d\n", column + 1, first + 1, static_cast<int>(values.size()));
    out << line;
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::snprintf(line, sizeof line, "%23.16E", values[i]);
      out << line << (i % 3 == 2 || i + 1 == values.size() ? "\n" : "");
    }
  }
  std::snprintf(line, sizeof line, "%8d%8d%8d\n%23.16E\n", matrix.num_cols + 1, 1, 1, 1.0);
  out << line;
}

}  // namespace bough::exports
