#pragma once
/// \file The outcome table of a campaign, and single arrays of numbers out of any HDF5 file.
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::hdf5 {

/// A column: numbers (NaN if a case has none) or, when `words` is not empty, text.
struct OutcomeColumn {
  std::string path;  ///< "/parameters/E"
  std::string description;
  Eigen::MatrixXd numbers;  ///< one row a case; one column, or more where a case gives several
  std::vector<std::string> words;
};

struct OutcomeTable {
  std::string name;         ///< of the campaign
  std::string fingerprint;  ///< SHA-256 of all its inputs
  std::vector<int> cases;   ///< numbers of the cases
  std::vector<OutcomeColumn> columns;
};

/// Throws ComputationError "hdf5.write".
void write_outcomes(const OutcomeTable& table, const std::string& path);
/// Columns in the order of their paths. Throws InputError "hdf5.cannot-open", "hdf5.wrong-format", "hdf5.missing".
OutcomeTable read_outcomes(const std::string& path);

/// A dataset of numbers, reals or integers, of any file and shape: rows along its first dimension, the rest in C order.
/// A single number is 1 x 1. Throws InputError "hdf5.cannot-open", "hdf5.missing", "hdf5.type".
Eigen::MatrixXd read_numbers(const std::string& path, const std::string& dataset);

}  // namespace bough::hdf5
