#pragma once
/// \file A reduced flexible body: everything the solver, the .FLX writer and the exports know of it (docs/formats).
///
/// Every vector is in the body frame B with origin Bo. n = num_modes, p = num_nodes. Units are the user's.
#include <array>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/mass_integrals.hpp"
#include "formats/records/recovery.hpp"
#include "formats/records/third_order.hpp"

namespace bough::records {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// The twelve inertial loads in the order of A_I (docs/theory/flexible-body.md §2; 0-based here).
enum class InertialLoad { ax, ay, az, alx, aly, alz, wx2, wy2, wz2, wxwy, wxwz, wywz };
inline constexpr int kNumInertialLoads = 12;

enum class ModeKind { Normal, Constraint, Attachment, Residual };

/// A unit load at one (node, direction), or a load pattern, whose geometric stiffness K_G2 is stored.
struct Locator {
  std::string name;
  int node = 0;       ///< node id; 0 for a pattern
  int direction = 0;  ///< 1..6; 0 for a pattern
};

/// Enough to draw the body: lines and faces by node index into grid_id.
struct BodyMesh {
  struct Block {
    std::string type;              ///< "line2", "tri3", "quad4", ...
    Eigen::MatrixXi connectivity;  ///< elements x nodes per element, indices into grid_id
    std::vector<int> element_id;
  };
  std::vector<int> grid_id;
  MatrixXd grid_xyz;  ///< g x 3
  std::vector<Block> blocks;
};

/// Strain energy of elements, ½ ηᵀ k η each.
struct ElementStrainEnergy {
  std::vector<int> id;
  std::vector<std::string> card;
  MatrixXd matrix;  ///< e x n(n+1)/2: the upper triangle of each k, row by row

  /// Returns true if the body has no element strain energies.
  bool empty() const { return id.empty(); }
  /// Column of k_ij, i <= j, of n modes.
  static Eigen::Index find_column(Eigen::Index i, Eigen::Index j, Eigen::Index n) {
    return i * n - i * (i - 1) / 2 + j - i;
  }
};

struct FlexBody {
  std::string name;
  std::vector<std::pair<std::string, std::string>> source;  ///< (file name, SHA-256)

  double mass = 0;
  Vector3d cg = Vector3d::Zero();
  Matrix3d inertia = Matrix3d::Zero();  ///< about Bo

  std::vector<int> node_id;          ///< p output nodes
  MatrixXd node_xyz;                 ///< p x 3
  std::vector<int> interface_nodes;  ///< ids among node_id that have locators: three forces, three moments
  bool is_free_free = false;         ///< rigid modes were removed: the frame is carried by no node

  VectorXd frequency_hz, eigenvalue;  ///< n
  std::vector<ModeKind> kind;         ///< n
  std::vector<MatrixXd> phi;          ///< [k] 6 x n: nodal translations (rows 0..2) and rotations (3..5)
  MatrixXd modal_mass, modal_stiffness, modal_damping;  ///< n x n
  MatrixXd effective_mass;                              ///< n x 6

  MassIntegrals lumped, consistent, exact;  ///< those the model has; the others are empty
  std::string integrals_method;             ///< "lumped", "consistent" or "exact": the one the solver uses

  MatrixXd F_I;             ///< ndof x 12; may be empty
  std::string masses;       ///< of F_I and the exact integrals: "bodies", or "nodal momenta" where M is not of bodies
  Eigen::MatrixXi dof_map;  ///< ndof x 2: node id, code 1..6 (scalar point: 0)

  std::array<MatrixXd, kNumInertialLoads> kg_inertial;  ///< K_G1, n x n each; zero where not computed
  std::array<bool, kNumInertialLoads> kg_inertial_computed{};
  std::vector<Locator> locators;
  std::vector<MatrixXd> kg_external;  ///< K_G2, one per locator
  MatrixXd external_load;             ///< n x ne: ΦᵀF_ext of each locator
  MatrixXd load_resultant;            ///< 6 x ne: force and moment about Bo of each locator's load; empty: not known
  std::vector<MatrixXd> load_moment;  ///< [e] 3 x n: Σ φ_kj × f_k, what mode j adds to that moment; as load_resultant

  ThirdOrder third_order;  ///< empty: the body has second order alone
  NextOrder next_order;    ///< of a body of second order; empty in older files and where the series do not exist

  std::string preload;   ///< what stresses the body before anything else does; empty: nothing
  MatrixXd kg_preload;   ///< n x n: its geometric stiffness, part of modal_stiffness; empty without
  VectorXd preload_A_I;  ///< 12: the inertial load factors among it, which a motion with them does not add again

  std::vector<RecoveryBlock> recovery;  ///< forces and stresses of elements; empty: not asked for
  MatrixXd inertial_load;               ///< n x 12: ΦᵀF_I, zero where K_G1 was not computed; with recovery alone

  ElementStrainEnergy strain_energy;  ///< empty: not asked for

  MatrixXd full_phi;  ///< ndof x n, only with --full
  BodyMesh mesh;
  /// 3g x n: translations of all grids of the mesh (row 3 i + axis), for pictures: single precision. Empty if `phi` or
  /// `full_phi` has them.
  Eigen::MatrixXf mesh_phi;

  /// Number n of modes.
  int num_modes() const { return static_cast<int>(eigenvalue.size()); }
  /// Number p of output nodes.
  int num_nodes() const { return static_cast<int>(node_id.size()); }
  /// Index into node_id, -1 when absent.
  int find_node(int id) const;
  /// Index of the locator at (node, direction), -1 when absent.
  int find_locator(int node, int direction) const;
  /// Copies the translations of all grids of the mesh from `Phi` (ndof x n, rows as dof_map) into mesh_phi, if elements
  /// connect grids that are no output nodes.
  void set_mesh_shapes(const MatrixXd& Phi);
  /// The set named by integrals_method.
  const MassIntegrals& integrals() const;
};

}  // namespace bough::records
