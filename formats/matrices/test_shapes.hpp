#pragma once
/// \file Mode shapes of a modal test from universal files (docs/formats/uff.md).
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::matrices {

struct TestShapes {
  std::vector<int> node_id;           ///< p, ascending
  Eigen::MatrixXd node_xyz;           ///< p x 3, from datasets 15 or 2411; empty without them
  Eigen::VectorXd frequency_hz;       ///< n, ascending [1/T]
  Eigen::VectorXd damping;            ///< n, viscous damping ratio
  std::vector<Eigen::MatrixXcd> phi;  ///< [k] 6 x n, components along the axes of the file; 0 where not measured
  bool is_complex = false;            ///< a shape has imaginary parts
};

/// Reads datasets 55 of normal modes (analysis type 2) and complex modes (3, 7) with three or six components a node,
/// nodes of datasets 15 and 2411, coordinate systems of 18 and 2420: components are turned to the axes of the file.
/// Throws InputError "matrices.uff", "matrices.truncated", "matrices.bad-number"
/// with the line.
TestShapes read_test_shapes(const std::string& path);

}  // namespace bough::matrices
