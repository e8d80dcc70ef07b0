#pragma once
/// \file Switch of the fill level of flexible bodies: the state of one variant of a system as that of another.
#include "solver/system/system.hpp"

namespace bough::solver {

/// Nodes of a body after a switch of its level against those before it.
struct LevelMatch {
  int body = -1;
  double position = 0;  ///< L; largest distance of a node
  double rotation = 0;  ///< rad; largest angle
  double velocity = 0;  ///< L/T; largest difference
};

/// Takes q and u of `from` to the variant `to`, whose fill levels differ.
///
/// Hinge coordinates and rates keep their values. Modal coordinates and rates of a body whose level changes, and its
/// six hinge coordinates if its hinge is free, are those with which its nodes have the least squares of differences in
/// position, rotation (times the size of the body) and velocity. Gauss-Newton for the positions; the velocities are
/// linear. Nodes at which hinges are attached have the weight 1000.
/// \param from_data  evaluated at (t, q, u).  \param to_data  of `to`, with the present modes.
/// \return the match of each body whose level changes. \note Allocates.
std::vector<LevelMatch> match_levels(const System& from, const SystemData& from_data, const System& to,
                                     SystemData& to_data, double t, Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u);

}  // namespace bough::solver
