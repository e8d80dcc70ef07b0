#pragma once
/// \file What `modes` writes: normal modes or buckling factors of a deck, with the health tables.
#include "formats/records/flex_body.hpp"

namespace bough::records {

/// Mass properties about a stated point, in basic (Nastran's grid point weight generator).
struct MassProperties {
  double mass = 0;  ///< translational mass, mean of the three directions
  Vector3d cg = Vector3d::Zero();
  Matrix3d inertia = Matrix3d::Zero();  ///< about the reference point
  Vector3d reference = Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> rigid_mass = Eigen::Matrix<double, 6, 6>::Zero();  ///< Φ_Rᵀ M Φ_R about reference
};

struct ModesResult {
  std::vector<std::pair<std::string, std::string>> source;
  int subcase = 0;
  MassProperties mass_properties;
  std::vector<int> node_id;
  MatrixXd node_xyz;                  ///< p x 3
  VectorXd eigenvalue, frequency_hz;  ///< n
  std::vector<ModeKind> kind;
  VectorXd residual;  ///< n, |Kφ - λMφ| / |Kφ| (absolute for rigid modes)
  int num_rigid_modes = 0;
  int inertia_count = -1;     ///< eigenvalues below the highest by the factor's inertia; -1 not checked
  std::vector<MatrixXd> phi;  ///< [k] 6 x n
  VectorXd modal_mass;        ///< n
  MatrixXd effective_mass;    ///< n x 6, about the origin
  VectorXd load_factor;       ///< buckling only
  BodyMesh mesh;
};

}  // namespace bough::records
