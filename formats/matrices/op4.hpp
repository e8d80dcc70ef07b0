#pragma once
/// \file Nastran OUTPUT4 (docs/formats/op4.md): every flavour that is read, and the same written.
#include <ostream>
#include <string>
#include <vector>

#include "formats/matrices/matrix.hpp"

namespace bough::matrices {

enum class Op4Layout {
  Dense,   ///< each column from its first to its last entry
  Strings  ///< runs of entries; a matrix of 65536 rows or more gets BIGMAT strings
};

struct Op4Options {
  bool is_text = true;
  Op4Layout layout = Op4Layout::Dense;
  bool is_bigmat = false;      ///< Strings: BIGMAT, negative NROW, whatever the size
  bool is_single = false;      ///< types 1 and 3 in place of 2 and 4
  int digits = 16;             ///< text: after the point
  char exponent = 'E';         ///< text: 'E' or 'D'
  bool is_big_endian = false;  ///< binary
  bool is_64_bit = false;      ///< binary: integers of 8 bytes, names of 16, every real in 8 bytes
};

/// Appends one matrix; a file holds any number one after the other. The name has one to eight letters.
void write_op4(std::ostream& out, const Matrix& matrix, const Op4Options& options);
/// A real matrix that is symmetric: form 6.
void write_op4(std::ostream& out, const records::SparseMatrix& matrix, const std::string& name,
               const Op4Options& options);

/// Throw InputError "matrices.*" with the line, or the byte offset.
std::vector<Matrix> read_op4_text(const std::string& path);
std::vector<Matrix> read_op4_binary(const std::string& path);

}  // namespace bough::matrices
