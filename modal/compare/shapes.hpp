#pragma once
/// \file Modes of two models against each other: nodes matched by id and place, the modal assurance criterion, pairs.
#include <optional>
#include <string>
#include <vector>

#include "formats/records/flex_body.hpp"
#include "formats/records/modes.hpp"
#include "formats/records/static_result.hpp"

namespace bough::modal {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Data that bodies and modes files have in common.
struct ModalModel {
  std::string name;
  double mass = 0;
  Vector3d cg = Vector3d::Zero();
  Eigen::Matrix<double, 6, 1> rigid = Eigen::Matrix<double, 6, 1>::Zero();  ///< m m m Jxx Jyy Jzz about the origin
  std::vector<int> node_id;
  MatrixXd node_xyz;          ///< p x 3
  std::vector<MatrixXd> phi;  ///< [k] 6 x n
  VectorXd frequency_hz;      ///< n; load factors of buckling modes
  VectorXd modal_mass;        ///< n: φᵀMφ
  bool is_buckling = false;
  MatrixXd effective_mass;  ///< n x 6, or empty

  /// Modes of a body at its output nodes, in frame B.
  static ModalModel from(const records::FlexBody& body);
  /// Modes of a modes or buckling file at its nodes, in basic.
  static ModalModel from(const records::ModesResult& modes);
  /// Number n of modes.
  int num_modes() const { return static_cast<int>(frequency_hz.size()); }
};

/// Pairs of indices into node_id of a and b. offset: position in b minus position in a.
struct NodeMatch {
  std::vector<std::pair<int, int>> pairs;
  int by_id = 0, by_place = 0;
  Vector3d offset = Vector3d::Zero();
};

/// Nodes of one id at one place first; nodes left over by place alone. One common offset (another origin) is allowed
/// for, where it brings all common ids together. Tolerance: 1e-6 of the model's size.
NodeMatch match_nodes(const ModalModel& a, const ModalModel& b);

/// |φ_iᵀ ψ_j|² / (φ_iᵀφ_i ψ_jᵀψ_j) over the translations at the matched nodes, na x nb; over the rotations for two
/// modes that turn nodes without moving them, 0 when only one does.
MatrixXd calc_mac(const ModalModel& a, const ModalModel& b, const NodeMatch& match);

/// MAC with Mass as weight. dof_map: rows of the matrix (node id of a, code 1..6). Nothing, and the number of missing
/// rows, when a row of the matrix with mass has no matched node.
struct MassMac {
  std::optional<MatrixXd> mac;
  int num_missing = 0;
};
/// Computes the MAC with x the modes of a and y those of b on the dofs of the matrix, na x nb.
MassMac calc_mass_mac(const ModalModel& a, const ModalModel& b, const NodeMatch& match,
                      const records::SparseMatrix& mass, const Eigen::MatrixXi& dof_map);

/// One pair of modes; `sign` and `scale` bring b's mode to a's (b times sign is nearest to a).
struct ModePair {
  int a = 0, b = 0;
  double mac = 0, in_span = 0;  ///< in_span: share of a's mode that lies in the span of all modes of b
  double sign = 1;
};
/// The largest MAC first, every mode once; sorted by a. Pairs with a MAC below 0.05 are none.
std::vector<ModePair> pair_modes(const ModalModel& a, const ModalModel& b, const NodeMatch& match, const MatrixXd& mac);

}  // namespace bough::modal
