#pragma once
/// \file Load vector of a load set, with the data of its second-order terms.
#include <vector>

#include "fe/model/model.hpp"

namespace bough::fe {

/// A dead force on the end of a rigid arm of a grid, among the loads of that grid.
struct ArmLoad {
  int first_rotation = 0;  ///< g-dof
  Eigen::Vector3d arm = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();
};

struct AppliedLoad {
  Eigen::VectorXd F;                  ///< num_gdofs, basic: everything
  Vector12d A_I = Vector12d::Zero();  ///< of the accelerated frame whose inertial load is in F
  std::vector<ArmLoad> arms;          ///< on the ends of offset beams
  /// Stiffness of the load in addition to that of internal forces of the solution: of pressures that turn with their
  /// faces (PARAM,FOLLOWK), of the stress inside superelements with their exterior dofs held.
  std::vector<QuadraticForm> followers;
};

/// Load vector (num_gdofs) of a set, in basic: FORCEx, MOMENTx, SLOAD, PLOADx, GRAV and RFORCE (with the mass of the
/// model), LOAD. Reports fe.missing-load and errors of its cards.
VectorXd calc_load(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics);
/// Load vector with the data that K_G needs.
AppliedLoad calc_applied_load(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics);

}  // namespace bough::fe
