#pragma once
/// \file Element: stiffness, mass, DOFs and shape; further questions by interfaces. One pair of files per element.
///
/// All matrices are in basic axes at the element's grid points (offsets and pin releases are already inside), in the
/// order of get_gdofs(). Functions add into the caller's storage and keep no scratch: an element is const.
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "base/diagnostic.hpp"
#include "formats/records/deck.hpp"

namespace bough::fe {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

enum class MassKind { Lumped, Consistent };

class Beam;
class Damping;
class OffsetMass;
class PrintedForces;
class Solid;
class StressRecovery;
class StressState;
class ThermalLoads;

/// A grid (six dofs: translations and rotations in basic) or a scalar point (one dof).
struct Node {
  int id = 0;
  Vector3d x = Vector3d::Zero();               ///< in basic
  Matrix3d R_basic_cd = Matrix3d::Identity();  ///< columns: the displacement (CD) axes in basic
  int first_gdof = 0;                          ///< row of its first dof in the g-set
  int num_dofs = 6;
};

/// Shape of an element in pictures and VTU files.
struct ElementShape {
  std::string type;        ///< "line2", "tri3", "quad4", "tetra4", "penta6", "hexa8", "vertex"; empty = not drawn
  std::vector<int> nodes;  ///< indices into Model::nodes()
};

class Element {
 public:
  /// \param card  for messages, "CBAR". \param nodes  indices into Model::nodes(). \param gdofs  rows of the g-set, N
  /// of them.
  Element(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs)
      : id_(id), card_(std::move(card)), nodes_(std::move(nodes)), gdofs_(std::move(gdofs)) {}
  virtual ~Element() = default;
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;

  /// Element id of the deck; 0 for direct matrices.
  int id() const { return id_; }
  const std::string& card() const { return card_; }         ///< "CBAR", ...
  const std::vector<int>& nodes() const { return nodes_; }  ///< indices into Model::nodes()
  const std::vector<int>& gdofs() const { return gdofs_; }  ///< rows of the g-set; size() = N below
  /// Number N of dofs.
  int num_dofs() const { return static_cast<int>(gdofs_.size()); }
  /// Shape for pictures and VTU files; by default none.
  virtual ElementShape shape() const { return {}; }

  /// K += scale K_e, N x N. Symmetric; K_e times any rigid-body motion is zero for an ungrounded element. Default: K_e
  /// is zero (masses, dampers).
  virtual void add_stiffness(double, Eigen::Ref<MatrixXd>) const {}
  /// M += scale M_e, N x N, in deck units (PARAM,WTMASS is applied by assembly). Default: M_e is zero (springs,
  /// dampers).
  virtual void add_mass(MassKind, double, Eigen::Ref<MatrixXd>) const {}
  /// GE of the material or property; springs with one per direction override add_structural_damping().
  double structural_damping() const { return structural_damping_; }
  /// Sets GE, the structural damping coefficient; by the maker of the element.
  void set_structural_damping(double ge) { structural_damping_ = ge; }
  /// K += (g + GE) K_e, N x N: the imaginary part of the stiffness (Nastran's K4 with g of PARAM,G).
  virtual void add_structural_damping(double g, Eigen::Ref<MatrixXd> K) const;

  // Further questions, each a separate interface; nullptr if the element has none.

  /// Internal forces and geometric stiffness (stress_state.hpp).
  virtual const StressState* stress_state() const { return nullptr; }
  /// Forces in static results: of the stress state, or of a spring without K_G (stress_state.hpp).
  virtual const PrintedForces* printed_forces() const;
  /// Stresses and strains (stress_recovery.hpp).
  virtual const StressRecovery* stress_recovery() const { return nullptr; }
  /// Loads and strains of temperatures, if the material expands (thermal_loads.hpp).
  virtual const ThermalLoads* thermal_loads() const { return nullptr; }
  /// Mass of this kind that is off the grids or has rotary inertia (carried.hpp). Without it M moves as the
  /// translations of the grids do, in all directions alike.
  virtual const OffsetMass* offset_mass(MassKind) const { return nullptr; }
  /// Viscous damping (damping.hpp).
  virtual const Damping* damping() const { return nullptr; }
  /// The beam that takes loads along its length (PLOAD1) and has a length between its offset ends.
  virtual const Beam* as_beam() const { return nullptr; }
  /// The solid that has stresses and strains at its corners.
  virtual const Solid* as_solid() const { return nullptr; }

 private:
  int id_;
  std::string card_;
  std::vector<int> nodes_;
  std::vector<int> gdofs_;
  double structural_damping_ = 0;
};

/// Looks up nodes by deck id while elements are made.
class NodeTable {
 public:
  virtual ~NodeTable() = default;
  virtual int find_node(int id) const = 0;  ///< index, -1 when absent
  /// Its GRID card has an error already: a card that names it does not report it as missing.
  virtual bool is_refused(int /*id*/) const { return false; }
  /// Node by its index, valid as long as the table.
  virtual const Node& node(int index) const = 0;
  /// R_basic_cid at point x (the axes of a cylindrical or spherical system depend on it); nullptr-safe: reports and
  /// returns identity when cid does not exist.
  virtual Matrix3d calc_axes(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const = 0;
  /// Position in basic of coordinates given in system cid.
  virtual Vector3d calc_point(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const = 0;
};

struct ElementList {
  std::vector<std::unique_ptr<const Element>> elements;
  /// Names of the cards that add() was given; an element that is put into `elements` directly is not counted.
  std::set<std::string> cards;
  bool has_damping = false;

  /// Adds an element at the end and records its card and damping.
  void add(std::unique_ptr<const Element> element);
};

/// Every element of the deck (bars, beams, rods, tubes, springs, bushes, masses, shells, solids); missing properties,
/// materials, grids, zero lengths and bad orientations are reported with file and line, all of them. The only list of
/// element types (fe/cards/catalog.cpp).
ElementList make_elements(const records::Deck& deck, const NodeTable& nodes, Diagnostics& diagnostics);

}  // namespace bough::fe
