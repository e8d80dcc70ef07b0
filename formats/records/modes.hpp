#pragma once
/// \file Output of `modes`: normal modes or buckling factors of a deck, with the health tables.
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

/// Energies of the elements in each mode. Mode j: ½ φᵀK_eφ, and ½ φᵀM_eφ, which times ω² is the kinetic energy. Their
/// sums are ½ ω² and ½ of the modal mass. What no element holds (preload of links) is the difference to `total`.
struct ModeEnergies {
  std::vector<int> id, property;         ///< elements with stiffness or mass; PID, 0 without one
  std::vector<std::string> card;         ///< of each
  MatrixXd strain, kinetic;              ///< elements x n
  VectorXd total_strain, total_kinetic;  ///< n: of the whole matrices
  /// Returns true if no element energies were requested.
  bool empty() const { return strain.size() == 0; }
};

/// Modal effective mass about a grid, in units of mass.
struct EffectiveMass {
  int grid = 0;                                                             ///< 0: not asked for
  MatrixXd mass;                                                            ///< n x 6
  Eigen::Matrix<double, 6, 6> rigid = Eigen::Matrix<double, 6, 6>::Zero();  ///< rigid-body mass about that grid
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
  ModeEnergies energies;  ///< where asked for
  EffectiveMass effective_mass_about;
};

}  // namespace bough::records
