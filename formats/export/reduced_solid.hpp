#pragma once
/// \file The stiffness and mass of a Craig-Bampton body on the motions of its interface frames, as Simscape's Reduced
/// Order Flexible Solid takes them.
#include <optional>
#include <string>
#include <vector>

#include "formats/records/flex_body.hpp"

namespace bough::exports {

/// Rows and columns of K, M, C: per frame translations x y z and rotations x y z, frame after frame, then the other
/// modes.
struct ReducedSolid {
  std::vector<int> node;    ///< m frames: node ids, 0 for the body frame
  Eigen::MatrixXd P;        ///< m x 3, origins in the body frame
  Eigen::MatrixXd K, M, C;  ///< (6m + other modes)^2
};

/// The frames are the interface nodes, and the body frame itself where no interface node carries it. Rigid-body motion
/// q_r and modal coordinates η give u = [Φ_R Φ]_b [q_r; η] at the frames; solved for q_r and the amplitudes of the
/// constraint modes, the matrices diag(0, K) and [M_rr Γᵀ; Γ M] (docs/theory/flexible-body.md §4) follow the change of
/// coordinates. Nothing, and why, for a body without constraint modes or with frames that they do not move one to one.
std::optional<ReducedSolid> calc_reduced_solid(const records::FlexBody& body, std::string& why);

}  // namespace bough::exports
