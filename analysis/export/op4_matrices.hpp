#pragma once
/// \file Matrices one after the other in the OUTPUT4 format.
#include <sstream>
#include <string>

#include "formats/matrices/op4.hpp"

namespace bough::analysis {

class Op4Matrices {
 public:
  /// Starts an empty file; `options` select the number format and the digits of each matrix.
  explicit Op4Matrices(matrices::Op4Options options = {}) : options_(options) {}

  /// Nothing of a matrix without entries in size.
  void put(const std::string& name, const Eigen::MatrixXd& dense);
  void put(const std::string& name, const records::SparseMatrix& a);
  /// Returns the bytes of the file so far.
  std::string take() const { return out_.str(); }

 private:
  matrices::Op4Options options_;
  std::ostringstream out_;
};

}  // namespace bough::analysis
