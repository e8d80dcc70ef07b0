#pragma once
/// \file A flexible body from matrices and mode shapes that are given: generalized matrices, integrals, gains at nodes
/// (NASA-CR-202063 4.2.2, 4.2.3).
#include <Eigen/SparseCore>

#include "modal/integrals.hpp"

namespace bough::modal {

using RowSparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

struct MatrixModel {
  RowSparse M, K;  ///< num_dofs x num_dofs
  RowSparse D;     ///< physical damping; 0 x 0 where `zeta` gives it
  MatrixXd Phi;    ///< num_dofs x n: the modes that are kept
  NodalDofs dofs;
  Vector3d reference = Vector3d::Zero();  ///< Bo: integrals and nodes are about it
  double mass = 0;                        ///< of the whole body: M may not contain the mass at its supports
  double zeta = 0;
};

/// Modal M, K, D, both integral sets ("consistent": momentum formulas; "exact"), and Φ at the nodes (1-based numbers).
/// With zeta, D_jj = 2 ζ sqrt(K_jj / M_jj) as the report has it: the damping of modes of unit generalized mass. Warns
/// with "modal.damping-not-normalized" where they are not; throws InputError("modal.no-modal-mass").
records::FlexBody calc_matrix_body(const MatrixModel& model, const std::vector<int>& nodes, Diagnostics& diagnostics);

}  // namespace bough::modal
