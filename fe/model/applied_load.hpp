#pragma once
/// \file A load on a model, with what its second order needs beside the forces.
#include <vector>

#include <Eigen/Dense>

#include "fe/model/links.hpp"

namespace bough::fe {

using Vector12d = Eigen::Matrix<double, 12, 1>;

/// A dead force on the end of a rigid arm of a grid, among the loads of that grid.
struct ArmLoad {
  int first_rotation = 0;  ///< g-dof
  Eigen::Vector3d arm = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();
};

struct AppliedLoad {
  Eigen::VectorXd F;                  ///< num_gdofs, basic: everything
  Vector12d A_I = Vector12d::Zero();  ///< of the accelerated frame whose inertial load is in F
  std::vector<ArmLoad> arms;          ///< on the ends of offset beams
  /// Pressures that turn with their faces (PARAM,FOLLOWK): their stiffness, one load.
  std::vector<QuadraticForm> followers;
};

}  // namespace bough::fe
