#pragma once
/// \file Measured frequency response functions from universal files (docs/formats/uff.md).
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::matrices {

/// One function over frequency of dataset 58.
struct TestFunction {
  std::string name;             ///< first line of the identification
  int node = 0, direction = 0;  ///< of the response: 1 to 6, negative: against the axis; 0: none
  int reference = 0, reference_direction = 0;
  int load_case = 0;
  int quantity = 0;    ///< ordinate: 8 displacement, 11 velocity, 12 acceleration, 9 force, else unknown
  Eigen::VectorXd hz;  ///< ascending
  Eigen::VectorXcd value;
  int line = 0;  ///< where it begins
};

/// Reads the datasets 58 of frequency response functions (function type 4) and spectra (12) over frequency: even and
/// uneven, single and double precision. Other datasets and functions are passed over. Throws InputError "matrices.uff",
/// "matrices.truncated", "matrices.bad-number" with the line.
std::vector<TestFunction> read_test_functions(const std::string& path);

}  // namespace bough::matrices
