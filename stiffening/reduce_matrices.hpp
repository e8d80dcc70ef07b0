#pragma once
/// \file A flexible body from matrices that another program wrote (docs/other-fe-codes.md): grids and constraints of
/// a deck, K and M of the files in place of its elements.
#include <Eigen/SparseCore>

#include "stiffening/reduce.hpp"

namespace bough::stiffening {

/// A matrix with the dofs of its rows. Columns of K, M, B, K_G are the same dofs.
struct GivenMatrix {
  std::string label;                                       ///< for messages: file and name
  Eigen::SparseMatrix<double, Eigen::RowMajor> values;     ///< num_dofs x num_dofs, or x n
  Eigen::MatrixXi row_dofs = Eigen::MatrixXi::Zero(0, 2);  ///< node, code; 0 rows: the g-set, points by id
  bool is_basic = false;                                   ///< else in the displacement systems (CD) of the grids
  SourceLocation at;
  /// Returns true if no matrix is given.
  bool empty() const { return values.rows() == 0; }
};

/// Mode shapes with the eigenvalues of their file, if it has any.
struct GivenModes {
  GivenMatrix Phi;
  VectorXd eigenvalue;  ///< n, or empty
};

/// K_G and the load that it belongs to: an inertial load, or one of load, (node, direction), load_set.
struct GivenGeometric {
  std::string name;
  GivenMatrix K_G;
  int inertial = -1;  ///< records::InertialLoad; -1: external
  GivenMatrix load;   ///< num_dofs x columns
  int load_column = 0;
  int node = 0, direction = 0, load_set = 0;
};

struct GivenMatrices {
  GivenMatrix K, M, B;
  GivenModes modes;  ///< empty: solved for
  std::vector<GivenGeometric> geometric;
  double mass_scale = 1;
  std::vector<int> clamped;
};

/// Reduces given matrices to a flexible body, as reduce() a deck.
///
/// K_G1 and K_G2 are those given: `kg_inertial_computed` flags them, warnings name the missing ones. Mass integrals:
/// the momentum set (called lumped where M couples no two points) and the exact one. Warnings: reduce.no-stiffening,
/// reduce.not-rigid-mass, reduce.missing-dofs, reduce.modes-differ, reduce.modes-residual, reduce.matrix-order.
/// \throws InputError with reduce.matrix-size, reduce.matrix-dof, reduce.not-symmetric, reduce.negative-mass, and the
///     errors of reduce().
ReducedBody reduce_matrices(const records::Deck& deck, const records::BodySpec& spec, const GivenMatrices& matrices,
                            const ReduceOptions& options, Diagnostics& diagnostics);

/// Modes of a body compared with others of the same structure.
struct ModeCheck {
  VectorXd frequency_hz;  ///< m, of the others: by the eigenvalues of their file; -1 without
  MatrixXd mac;           ///< n x m: cos² of the angle between modes, translations of the common output nodes
};

/// The deck gives the displacement systems, unless `theirs` is in basic. Throws reduce.no-common-nodes.
ModeCheck compare_modes(const records::FlexBody& body, const records::Deck& deck, const GivenModes& theirs,
                        Diagnostics& diagnostics);

}  // namespace bough::stiffening
