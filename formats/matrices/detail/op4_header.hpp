#pragma once
/// \file Header of an OUTPUT4 matrix and the columns that follow it, for the text and the binary reader.
#include <algorithm>
#include <functional>
#include <string>

#include "formats/matrices/detail/triplets.hpp"

namespace bough::matrices::detail {

/// Raises an error at the reader's place.
using Fail = std::function<void(const char* id, const std::string& what)>;

struct Op4Header {
  long num_cols = 0, num_rows = 0, form = 0, type = 0;
  std::string name;
  bool is_bigmat = false;

  /// Returns true for types 3 and 4.
  bool is_complex() const { return type > 2; }
  /// Returns true for types 2 and 4, double precision.
  bool is_double() const { return type % 2 == 0; }
  /// Number of reals per entry: 1, or 2 for complex ones.
  long reals_per_entry() const { return is_complex() ? 2 : 1; }
};

/// Nastran's own rule: from this many rows on, strings are BIGMAT.
inline constexpr long kBigRows = 65536;

/// Checks and settles the sign of NROW. `claimed`: rows and columns of the matrices of the file so far, of which there
/// are no more than two large matrices have, and a hundred for each byte.
inline void settle_header(Op4Header& header, std::size_t file_size, double& claimed, const Fail& fail) {
  header.is_bigmat = header.num_rows < 0 || header.num_rows >= kBigRows;
  header.num_rows = std::abs(header.num_rows);
  if (header.num_rows == 0 || header.num_rows > kMaxRows || header.num_cols <= 0 || header.num_cols > kMaxRows)
    fail("matrices.size", "matrix " + header.name + " has " + std::to_string(header.num_rows) + " rows and " +
                              std::to_string(header.num_cols) + " columns, expected 1 to " + std::to_string(kMaxRows) +
                              " of each");
  claimed += static_cast<double>(header.num_rows) + static_cast<double>(header.num_cols);
  if (claimed > 4.0 * kMaxRows + 100.0 * static_cast<double>(file_size))
    fail("matrices.size", "the matrices up to " + header.name + " claim " +
                              std::to_string(static_cast<long long>(claimed)) + " rows and columns in " +
                              std::to_string(file_size) + " bytes");
  if (header.type < 1 || header.type > 4)
    fail("matrices.op4-header",
         "matrix " + header.name + " has the type " + std::to_string(header.type) + ", expected 1 to 4");
}

/// The matrix of a header and its entries. A symmetric one (form 6) of which the file holds one triangle is completed.
inline Matrix make_op4_matrix(const Op4Header& header, Triplets& entries) {
  Matrix matrix;
  matrix.name = header.name;
  matrix.form = static_cast<int>(header.form);
  if (header.form == kSymmetric && header.num_rows == header.num_cols && entries.is_triangular())
    entries.mirror(Triangle::Mirror);
  entries.compress(static_cast<int>(header.num_rows), static_cast<int>(header.num_cols), header.is_complex(), matrix);
  return matrix;
}

/// Length in words and first row (1-based) of a string of the non-BIGMAT kind: IS = IROW + 65536 (L + 1).
struct StringHeader {
  long num_words = 0, row = 0;
};
/// Unpacks IS.
inline StringHeader unpack_string_header(long is) {
  const long words = is / 65536;
  return {words - 1, is - 65536 * words};
}

}  // namespace bough::matrices::detail
