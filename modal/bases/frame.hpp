#pragma once
/// \file Body frames: six conditions on the deformation that say how the frame follows it (docs/theory/bases.md).
#include <string>
#include <vector>

#include "fe/matrices/assembly.hpp"

namespace bough::modal::bases {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

enum class FrameKind {
  MeanAxes,    ///< Γ0 = Γ1 = 0: no momentum of the deformation seen from the frame (Buckens, Tisserand)
  Node,        ///< rides on a node: its translation and rotation are zero
  ThreeNodes,  ///< 3-2-1: the first node at rest, the second on its line, the third in its plane
  MassCentre  ///< Γ0 = 0: its place in the body is the centre of mass's; turns with a node, with three, or as mean axes
};

struct FrameSpec {
  FrameKind kind = FrameKind::MeanAxes;
  std::vector<int> nodes;  ///< Node: one; ThreeNodes: three; MassCentre: none, one or three
};

/// Returns the number of nodes that the frame takes ("one"), if it has another one; nullptr: it has the right number.
const char* find_expected_nodes(const FrameSpec& frame);

/// C, 6 x num_gdofs: the frame follows the deformation u so that C u = 0, three rows for translation, three for
/// rotation. Throws InputError("modal.bad-frame"): three nodes on a line, a node whose rotations no element holds, a
/// wrong number of nodes.
MatrixXd calc_reference_conditions(const fe::Model& model, const FrameSpec& frame);

/// Φ - Φ_R (C Φ_R)⁻¹ C Φ: the same deformations seen from the frame. Φ_R about Bo.
MatrixXd shift_to_frame(const fe::Model& model, const MatrixXd& C, const MatrixXd& Phi);

}  // namespace bough::modal::bases
