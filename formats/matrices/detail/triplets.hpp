#pragma once
/// \file Gathers (row, column, value) in any order and makes compressed rows of them.
#include <vector>

#include "formats/matrices/matrix.hpp"

namespace bough::matrices::detail {

/// No matrix of a body has more rows; a header that says so is damaged. Empty rows take a tenth of a microsecond each:
/// fuzzing would do little else.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
inline constexpr long kMaxRows = 100'000;
#else
inline constexpr long kMaxRows = 50'000'000;
#endif

enum class Triangle { Both, Mirror, MirrorNegative, MirrorConjugate };

class Triplets {
 public:
  /// Adds an entry at 0-based indices.
  void add(int row, int column, double value, double imaginary = 0) {
    row_.push_back(row);
    column_.push_back(column);
    value_.push_back(value);
    imaginary_.push_back(imaginary);
  }
  /// Number of entries added.
  std::size_t size() const { return row_.size(); }
  /// Returns true if there are entries (i, j) off the diagonal, but none with an entry (j, i) too, for any dof order.
  bool is_triangular() const;
  /// Adds the other side of every entry off the diagonal.
  void mirror(Triangle how);
  /// Indices of rows and columns replaced by row_of[index], column_of[index].
  void renumber(const std::vector<int>& row_of, const std::vector<int>& column_of);
  /// Sorted by row and column, entries of the same place added up, zeros left out.
  void compress(int num_rows, int num_cols, bool is_complex, Matrix& matrix) const;

 private:
  std::vector<int> row_, column_;
  std::vector<double> value_, imaginary_;
};

}  // namespace bough::matrices::detail
