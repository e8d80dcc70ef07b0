#pragma once
/// \file The dofs of the interface nodes as separate coordinates: q_f = S_i q_i + S_b u_b.
#include <utility>
#include <vector>

#include "fe/linear/symmetric_matrix.hpp"
#include "fe/model/model.hpp"

namespace bough::modal::bases {

using Eigen::MatrixXd;
using fe::SparseRows;

/// Boundary dofs u_b = T_b q_f of a list of nodes. A dof of the f-set is a coordinate already; one that follows others
/// (the reference grid of an RBE3, a grid of an RBE2) takes the place of the f-dof that weighs most in it, found by
/// elimination with column pivoting. With direct dofs only, S_i and S_b are columns of the identity.
struct Partition {
  std::vector<std::pair<int, int>> boundary;  ///< nb: node id, component 1..6 in its displacement axes; scalar point: 1
  std::vector<int> interior;                  ///< f-dof of each column of S_i, ascending
  SparseRows S_i;                             ///< num_fdofs x ni
  MatrixXd S_b;                               ///< num_fdofs x nb
  /// Number nb of interface coordinates.
  int num_boundary() const { return static_cast<int>(boundary.size()); }
  /// S_i is columns of the identity: SᵢᵀASᵢ are rows and columns of A.
  bool is_selection() const { return S_i.nonZeros() == S_i.cols(); }
};

/// Dofs that constraints hold have no coordinate. Those that follow from the dofs before them are left out, warning
/// "modal.dependent-interface". Cost O(nb² c), c f-dofs in T_b.
Partition make_partition(const fe::Model& model, const std::vector<int>& nodes, Diagnostics& diagnostics);

/// S on PETSC_COMM_WORLD, its rows laid out as those of A.
linear::PetscMat make_petsc(const SparseRows& S, const linear::SymmetricMatrix& A);
/// Sᵀ A S.
linear::SymmetricMatrix calc_triple_product(const linear::SymmetricMatrix& A, const SparseRows& S);

}  // namespace bough::modal::bases
