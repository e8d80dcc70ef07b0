#pragma once
/// \file What every element owes: stiffness, mass, internal forces, geometric stiffness. One pair of files per element.
///
/// All matrices are in basic axes at the element's grid points (offsets and pin releases are already inside), in the
/// order of get_gdofs(). Functions add into the caller's storage and keep no scratch of their own: an element is const.
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
class GeometricProjection;
struct ElementTemperature;
struct StressPoint;
struct CarriedMass;

/// A grid (six dofs: translations and rotations in basic) or a scalar point (one dof).
struct Node {
  int id = 0;
  Vector3d x = Vector3d::Zero();               ///< in basic
  Matrix3d R_basic_cd = Matrix3d::Identity();  ///< columns: the displacement (CD) axes in basic
  int first_gdof = 0;                          ///< row of its first dof in the g-set
  int num_dofs = 6;
};

/// How an element is drawn and written to VTU.
struct ElementShape {
  std::string type;        ///< "line2", "tri3", "quad4", "tetra4", "penta6", "hexa8", "vertex"; empty = not drawn
  std::vector<int> nodes;  ///< indices into Model::nodes()
};

class Element {
 public:
  Element(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs)
      : id_(id), card_(std::move(card)), nodes_(std::move(nodes)), gdofs_(std::move(gdofs)) {}
  virtual ~Element() = default;
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;

  int id() const { return id_; }
  const std::string& card() const { return card_; }         ///< "CBAR", ...
  const std::vector<int>& nodes() const { return nodes_; }  ///< indices into Model::nodes()
  const std::vector<int>& gdofs() const { return gdofs_; }  ///< rows of the g-set; size() = N below
  int num_dofs() const { return static_cast<int>(gdofs_.size()); }
  virtual ElementShape shape() const { return {}; }

  /// K += scale K_e, N x N. Symmetric; K_e times any rigid motion is zero for an ungrounded element.
  virtual void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const;
  /// M += scale M_e, N x N, in deck units (PARAM,WTMASS is applied by assembly).
  virtual void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const;

  /// True when mass of this kind is off the grids or has inertia of its own: then add_carried() says of what bodies M
  /// is. Mass of other elements moves as the translations of the grids do, in all directions alike.
  virtual bool carries_turning_mass(MassKind) const { return false; }
  /// The bodies of M, at scale 1 and where x (3 x nodes, basic) are. False: M is not that of bodies.
  virtual bool add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const;

  /// True when add_damping() adds something: dampers, bushes with B.
  virtual bool has_damping() const { return false; }
  /// B += scale B_e, N x N: viscous damping. Symmetric; B_e times any rigid motion is zero for an ungrounded element.
  virtual void add_damping(double scale, Eigen::Ref<MatrixXd> B) const;

  /// GE of the material or property; springs with one a direction have their own add_structural_damping().
  double structural_damping() const { return structural_damping_; }
  void set_structural_damping(double ge) { structural_damping_ = ge; }
  /// K += (g + GE) K_e, N x N: the imaginary part of the stiffness (Nastran's K4 with g of PARAM,G).
  virtual void add_structural_damping(double g, Eigen::Ref<MatrixXd> K) const;

  /// Number s of internal force components (stress resultants) on which K_G depends; 0: no geometric stiffness.
  virtual int num_internal_forces() const { return 0; }
  /// Internal forces (s) of the element for its nodal displacements u (N), linear in u. Names: internal_force_names().
  virtual void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const;
  /// Of every column of U (N x m): s x m. Elements whose map from u to forces is dear make it once.
  virtual void calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const;
  virtual std::vector<std::string> internal_force_names() const { return {}; }
  /// What static solutions print of an element: its internal forces, or those of a spring, which no K_G asks for.
  virtual std::vector<std::string> printed_force_names() const { return internal_force_names(); }
  virtual VectorXd calc_printed_forces(const Eigen::Ref<const VectorXd>& u) const;
  /// The beam that takes loads along its length (PLOAD1) and has a length between its offset ends.
  virtual const Beam* as_beam() const { return nullptr; }
  /// K_G += scale K_G(force), N x N, symmetric and linear in force.
  virtual void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                       Eigen::Ref<MatrixXd> K_G) const;
  /// sums += Φᵀ K_G(forces of u_c) Φ for every column u_c of U (N x m); Phi: N x n. The default takes the two functions
  /// above, load after load or, where the internal forces are fewer, one unit force after the other.
  virtual void add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U,
                                                 const Eigen::Ref<const MatrixXd>& Phi,
                                                 GeometricProjection& sums) const;

  /// True when add_thermal() adds something: the material expands.
  virtual bool has_expansion() const { return false; }
  /// For temperatures T: load (N) += the forces at the nodes that stretch the element as it would stretch freely;
  /// initial (s) += its internal forces at u = 0. With temperatures they are calc_internal_forces(u) + initial.
  /// Returns the strain energy at u = 0.
  virtual double add_thermal(const ElementTemperature& T, Eigen::Ref<VectorXd> load,
                             Eigen::Ref<VectorXd> initial) const;

  /// Where and in which components the element gives stresses (fe/sections/stress.hpp); empty: none.
  virtual std::vector<StressPoint> stress_points() const;
  /// Those stresses, a column per column of `forces` (internal forces, s x m) and linear in it: all components of the
  /// first point, then those of the next.
  virtual MatrixXd calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const;
  /// What temperatures T add to the stresses beside those of the internal forces, which hold what add_thermal() gives:
  /// between the plies of a laminate. Empty: nothing.
  virtual VectorXd calc_initial_stresses(const ElementTemperature& T) const;

  /// Where the element gives strains: stress_points(), of shells the reference surface too ("mid"); empty: none.
  virtual std::vector<StressPoint> strain_points() const;
  /// Mechanical strains there of internal forces (s x m), rows as those of calc_stresses: what the material strains
  /// beside its free expansion, so that σ = C ε.
  virtual MatrixXd calc_strains(const Eigen::Ref<const MatrixXd>& forces) const;
  /// What temperatures T add to those: free expansion. The sum is what the displacements strain. Empty: nothing.
  virtual VectorXd calc_thermal_strains(const ElementTemperature& T) const;
  /// Of solids, both at their corners: six a corner, in the order of the grids. The others have no rows.
  virtual MatrixXd calc_corner_strains(const Eigen::Ref<const MatrixXd>& forces) const;
  virtual VectorXd calc_corner_thermal_strains(const ElementTemperature& T) const;

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
  /// Its GRID card has an error of its own: who names it need not say that it is missing.
  virtual bool is_refused(int /*id*/) const { return false; }
  virtual const Node& node(int index) const = 0;
  /// R_basic_cid at point x (the axes of a cylindrical or spherical system depend on it); nullptr-safe: reports and
  /// returns identity when cid does not exist.
  virtual Matrix3d calc_axes(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const = 0;
  /// Position in basic of coordinates given in system cid.
  virtual Vector3d calc_point(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const = 0;
};

struct ElementList {
  std::vector<std::unique_ptr<const Element>> elements;
  /// Of what add() was given; an element that is put into `elements` directly is not counted.
  std::set<std::string> cards;
  bool has_damping = false;

  void add(std::unique_ptr<const Element> element);
};

/// Every element of the deck (bars, beams, rods, tubes, springs, bushes, masses, shells, solids); missing properties,
/// materials, grids, zero lengths and bad orientations are reported with file and line, all of them. The only list of
/// element types (fe/cards/catalog.cpp).
ElementList make_elements(const records::Deck& deck, const NodeTable& nodes, Diagnostics& diagnostics);

}  // namespace bough::fe
