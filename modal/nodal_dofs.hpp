#pragma once
/// \file Map from displacements of nodes to rows of a vector: the description of a model that the integrals and the
/// inertial loads need, be it Bough's own or matrices from elsewhere (NASA-CR-202063 4.2.2, degree-of-freedom map).
#include "fe/model/model.hpp"

namespace bough::modal {

using Eigen::MatrixXd;
using Eigen::Vector3d;

struct NodalDofs {
  MatrixXd xyz;                               ///< p x 3, nodes in the frame of the integrals
  Eigen::Matrix<int, Eigen::Dynamic, 6> row;  ///< p x 6: row of x y z θx θy θz; -1 where the model has no such dof
  int num_dofs = 0;                           ///< rows of a vector; those that no node names are generalized or scalar

  /// Every node with six dofs, on the g-set.
  static NodalDofs from_model(const fe::Model& model);
  /// dof_map: ndof x 2, node 1..p and code 1..6; rows with another code belong to no node.
  static NodalDofs from_map(const Eigen::Ref<const Eigen::MatrixXi>& dof_map, const MatrixXd& xyz);

  /// Number of nodes, with or without dofs.
  int num_nodes() const { return static_cast<int>(xyz.rows()); }
  /// The six values of node k in every column of X (num_dofs x m): 6 x m, zero where the dof is missing.
  MatrixXd gather(const Eigen::Ref<const MatrixXd>& X, int k) const;
  /// Puts a 6 x m block back; what belongs to a missing dof is dropped.
  void scatter(const Eigen::Ref<const MatrixXd>& block, int k, Eigen::Ref<MatrixXd> X) const;

  /// Φ_R, num_dofs x 6: translation rows [1, -p̃], rotation rows [0, 1], p from `reference`; zero in other rows.
  MatrixXd calc_rigid_modes(const Vector3d& reference = Vector3d::Zero()) const;
};

}  // namespace bough::modal
