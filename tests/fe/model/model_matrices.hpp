#pragma once
/// \file Dense matrices of a model, for comparison.
#include "fe/matrices/assembly.hpp"
#include "fe/model/model.hpp"

namespace bough::fe::test {

/// K of all G-set dofs in basic axes [num_gdofs x num_gdofs].
inline MatrixXd get_stiffness(const Model& model) {
  return calc_stiffness_times(model, MatrixXd::Identity(model.num_gdofs(), model.num_gdofs()));
}
/// M of all G-set dofs in basic axes, lumped or consistent as the model has it.
inline MatrixXd get_mass(const Model& model) {
  return calc_mass_times(model, model.mass_kind(), MatrixXd::Identity(model.num_gdofs(), model.num_gdofs()));
}
/// The model's matrix of basic axes in displacement axes.
inline MatrixXd rotate_to_displacement_axes(const Model& model, const MatrixXd& A) {
  MatrixXd R = MatrixXd::Identity(A.rows(), A.rows());
  for (const Node& node : model.nodes())
    for (int part = 0; part < node.num_dofs - 1; part += 3)
      R.block<3, 3>(node.first_gdof + part, node.first_gdof + part) = node.R_basic_cd;
  return R.transpose() * A * R;
}

}  // namespace bough::fe::test
