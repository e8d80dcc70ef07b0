#pragma once
/// \file Element forces and stresses of a body as its modes and loads make them: output transformation matrices.
#include <array>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/third_order.hpp"

namespace bough::records {

/// Elements of one card with the same rows. Row e * components.size() + c is component c of element e:
///
///     offset + matrix η + beyond (monomials of η) + inertial (A_I - A_I of the preload) + external f
///
/// `matrix` is mode displacement. `inertial` and `external` are the residual of the modes in the static answer to each
/// unit load (docs/theory/recovery.md): with them it is mode acceleration.
struct RecoveryBlock {
  std::string name;  ///< of the card; with a number where elements of one card differ in their rows: "CBAR-2"
  std::vector<int> id;
  std::vector<std::string> components;  ///< "axial", "moment_z_a", "stress_xx@top"
  Eigen::MatrixXd matrix;               ///< rows x n
  /// Degrees 2 to 4 of a body of third order: rows x monomials, in the variables of ThirdOrder. Empty: the rows are
  /// linear in the modes.
  ThirdOrder::Tables beyond;
  Eigen::MatrixXd inertial;  ///< rows x 12; zero where K_G1 was not computed
  Eigen::MatrixXd external;  ///< rows x ne, in the order of the locators
  Eigen::VectorXd offset;    ///< of the preload, at rest; zero without

  /// Number of rows: elements times components.
  Eigen::Index num_rows() const { return static_cast<Eigen::Index>(id.size() * components.size()); }
  /// Returns true if the rows have terms of degree 2 to 4.
  bool has_beyond() const { return beyond[0].size() > 0; }
};

}  // namespace bough::records
