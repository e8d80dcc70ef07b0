#pragma once
/// \file Given matrices on the g-set of a deck, and as elements of a model.
#include <Eigen/SparseCore>

#include "fe/elements/direct.hpp"
#include "fe/model/model.hpp"
#include "stiffening/reduce_matrices.hpp"

namespace bough::stiffening {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Grids and scalar points of a deck, numbered as in fe::Model: grids by id, then scalar points by id.
struct PointTable {
  PointTable() = default;
  /// Positions from `origin`. Reports the errors of grids and coordinate systems, as the model does.
  PointTable(const records::Deck& deck, const Eigen::Vector3d& origin, Diagnostics& diagnostics);

  std::vector<fe::Node> nodes;  ///< ascending by first dof
  int num_gdofs = 0;
  std::unordered_map<int, int> index;  ///< into nodes, by id

  const fe::Node* find(int id) const;  ///< nullptr: none
  /// Rows of a file that names none: grids and scalar points by id, six dofs and one.
  Eigen::MatrixXi calc_default_dofs() const;
  Eigen::MatrixXi calc_dof_map() const;  ///< num_gdofs x 2: node, code (scalar point: 0)
  /// The dofs of calc_dof_map() with the positions of the grids, for the mass integrals.
  modal::NodalDofs calc_nodal_dofs() const;
};

/// P: num_gdofs x rows of the matrix, so that P A Pᵀ is A on the g-set in basic axes. Reports "reduce.matrix-size",
/// "reduce.matrix-dof".
SparseRows calc_placement(const PointTable& points, const GivenMatrix& matrix, Diagnostics& diagnostics);

/// One element for each pair of points that A (num_gdofs x num_gdofs, symmetric) couples, and for each point.
void add_direct_elements(const PointTable& points, const SparseRows& A, fe::DirectKind kind, fe::ElementList& list);
/// The shapes of the deck's elements, to draw the body; elements with errors are left out.
void add_drawn_elements(const records::Deck& deck, const fe::NodeTable& nodes, fe::ElementList& list);

/// Returns true if A couples any two points.
bool couples_points(const PointTable& points, const SparseRows& A);

}  // namespace bough::stiffening
