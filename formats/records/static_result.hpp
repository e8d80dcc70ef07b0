#pragma once
/// \file Output of `static` and `matrices`.
#include "formats/records/flex_body.hpp"

namespace bough::records {

/// Forces of the elements of one card, in the element's own names.
struct ElementForces {
  std::string card;
  std::vector<std::string> components;
  std::vector<int> id, property;  ///< property: PID, 0 without one
  MatrixXd force;                 ///< elements x components
  VectorXd strain_energy;         ///< elements
};

/// Stresses of the elements of one card that have the same points. "xx@top": component and point; derived ones
/// (von_mises, max, min, max_shear, failure, ...) are among them. Strains likewise, at the points of the stresses.
struct ElementStresses {
  std::string card;
  std::vector<std::string> components;
  std::vector<int> id, property;
  MatrixXd stress;  ///< elements x components
  MatrixXd corner;  ///< strains of solids alone: elements x (xx yy zz xy yz zx of each corner)
};

/// Margins of safety of the elements of one card whose material has limits: limit / |stress| - 1, no number where
/// there is no limit, or no stress of that kind.
struct StressMargins {
  std::string card;
  std::vector<int> id;
  MatrixXd margin;  ///< elements x (tension, compression, shear)
};

/// Over the subcases, of each grid or element: a row each, a column per component.
struct CaseExtremes {
  std::string path;  ///< displacement, reaction, elements/CARD, stresses/CARD, strains/CARD
  std::string dims;
  std::vector<std::string> components;
  std::vector<int> id;
  MatrixXd low, high;
  Eigen::MatrixXi low_case, high_case;  ///< ids of the subcases
};

/// A force that acts on a grid: of an element ("CBAR", its id), or of LOAD, SPC, MPC, INERTIA (id 0). Basic axes.
struct GridForce {
  int node = 0;
  std::string source;
  int element = 0;
  Eigen::Matrix<double, 6, 1> force = Eigen::Matrix<double, 6, 1>::Zero();
};

/// One subcase: vectors on the g-set in basic axes.
struct StaticSubcase {
  int id = 0;
  std::string label;
  int load_set = 0, spc_set = 0, mpc_set = 0, temperature_set = 0;
  VectorXd displacement;
  VectorXd load;
  VectorXd reaction;   ///< forces of the single-point constraints on the structure
  VectorXd mpc_force;  ///< forces of MPC and rigid elements: K u - F minus the reactions
  double strain_energy = 0;
  double epsilon = 0;  ///< work of the residual over the work of the loads
  /// About the origin: forces x y z, moments x y z.
  Eigen::Matrix<double, 6, 1> load_resultant, reaction_resultant, mpc_resultant;
  /// SUPORT, a row per dof; its forces are among the reactions. Empty without.
  struct Support {
    int node = 0, component = 0;
    double strain_energy = 0;  ///< of its unit motion: none if the body is free
    double acceleration = 0;   ///< with inertia relief
  };
  std::vector<Support> support;
  double support_epsilon = 0;  ///< of all of them, as Nastran prints it
  VectorXd inertia;            ///< inertia relief: the forces of the mass that balance the load; empty without
  Eigen::Matrix<double, 6, 1> inertia_resultant = Eigen::Matrix<double, 6, 1>::Zero();
  std::vector<ElementForces> elements;
  std::vector<ElementStresses> stresses;
  std::vector<ElementStresses> strains;  ///< where asked for; with those of temperatures
  std::vector<StressMargins> margins;
  std::vector<GridForce> grid_forces;  ///< where asked for: by grid, then elements, then the others
};

struct StaticResult {
  std::vector<std::pair<std::string, std::string>> source;
  Eigen::MatrixXi dof_map;  ///< ndof x 2: node id, code 1..6 (0 for a scalar point)
  BodyMesh mesh;
  std::vector<StaticSubcase> subcases;
  std::vector<CaseExtremes> extremes;  ///< where asked for
};

/// Compressed rows, as SciPy's csr_matrix.
struct SparseMatrix {
  std::vector<double> data;
  std::vector<int> indices, indptr;
  int num_rows = 0, num_cols = 0;
};

struct MatricesResult {
  std::vector<std::pair<std::string, std::string>> source;
  Eigen::MatrixXi dof_map;
  BodyMesh mesh;
  SparseMatrix K, M, B;                                   ///< B, viscous damping: empty without dampers
  std::vector<std::pair<std::string, SparseMatrix>> K_G;  ///< by name: LOAD_n
};

}  // namespace bough::records
