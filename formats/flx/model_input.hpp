#pragma once
/// \file The two ASCII files of the program that NASA-CR-202063 4.2.3 describes (docs/formats/flx.md): the model
/// information file and the matrices.
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include "base/diagnostic.hpp"

namespace bough::flx {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Code of a degree of freedom that belongs to no node: a coordinate of a reduced model.
inline constexpr int kGeneralizedDof = 7;

/// Names of the report in brackets. Node numbers are 1..num_nodes, in the order of xyz.
struct ModelInput {
  int num_nodes = 0, num_dofs = 0, num_modes_given = 0;  ///< [nnode, ndof, nmode_sys]
  Eigen::MatrixXi dof_map;                               ///< ndof x 2 [inod, idof_type]: node, 1..6; or any, 7
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();      ///< [r_offset] the integrals are about this point
  Eigen::MatrixXd xyz;                                   ///< nnode x 3 [node_mat]
  int body_id = 0;                                       ///< [bid]
  int modopt = 0;                                        ///< 0 all integrals, 1 zero and first order, 2 zero order
  double mass = 0;                                       ///< [mass] of the whole body: scales α
  int damping_option = 0;                                ///< [idamp] 1 matrix D is given, 2 from zeta
  double zeta = 0;
  std::vector<int> modes;  ///< [nmdind] 1-based, ascending
  std::vector<int> nodes;  ///< [inod_out] ascending
  bool has_special_nodes = false;
};

struct ModelMatrices {
  SparseMatrix M, K, D;  ///< ndof x ndof; D only with damping_option 1
  Eigen::MatrixXd Phi;   ///< ndof x num_modes_given
};

/// Reads MODEL.inp. Every fault is reported with file, line and item; after one the record is not to be used.
/// "flx.short-file", "flx.bad-number", "flx.wrong-size", "flx.unknown-node", "flx.bad-dof", "flx.duplicate-dof",
/// "flx.bad-option", "flx.bad-value", "flx.too-many-modes", "flx.bad-selection", "flx.node-order".
ModelInput read_model_input(const std::string& path, Diagnostics& diagnostics);

/// Reads MATRICES.mat row by row; zeros are not kept. "flx.short-file", "flx.bad-number"; warns with
/// "flx.unsymmetric".
ModelMatrices read_model_matrices(const std::string& path, const ModelInput& model, Diagnostics& diagnostics);

}  // namespace bough::flx
