#pragma once
/// \file The finite-element model: nodes, elements, dofs and constraints, made once from a deck and const after.
///
/// g-set: every dof of every node, translations and rotations in **basic** axes (one row for a scalar point).
/// f-set: the free dofs left after SPC, permanent SPC, AUTOSPC, MPC and rigid elements, in the displacement (CD) axes.
/// With ASET or OMIT they are those of the a-set, the others following them statically (fe/statics/guyan.cpp).
/// u_g = T q_f, with the CD rotation, the constraint elimination and the zeros all inside the sparse T.
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include <Eigen/Sparse>

#include "fe/elements/element.hpp"
#include "fe/model/applied_load.hpp"
#include "fe/model/constraints.hpp"
#include "fe/model/links.hpp"
#include "fe/model/prestress.hpp"
#include "formats/records/flex_body.hpp"
#include "formats/records/modes.hpp"

namespace bough::fe {

struct ModelOptions {
  int subcase = 0;                    ///< id; 0 = the first: its SPC and MPC sets are used
  bool ignore_spc = false;            ///< free-free: SPC sets and permanent SPC of translational kind are not applied
  std::optional<bool> autospc;        ///< overrides PARAM,AUTOSPC
  std::optional<MassKind> mass_kind;  ///< overrides PARAM,COUPMASS
  std::optional<Vector3d> origin;     ///< Bo in basic: node positions become relative to it
  std::vector<std::string> ignore_cards;  ///< --ignore CARD
  bool uses_enforced = false;  ///< the caller applies calc_enforced(): no warning that an SPC's value is dropped
  std::shared_ptr<const Prestress> prestress;  ///< of this deck (fe/statics/preload.hpp): its K_G0 joins the stiffness
};

/// One dof removed by AUTOSPC: node id, component 1..6 in CD axes, stiffness ratio that condemned it.
struct AutospcEntry {
  int node = 0, component = 0;
  double ratio = 0;
  bool is_skew = false;  ///< the component has stiffness of its own: the direction that has none is oblique
  /// Of a direction that is held: the component follows these (component, factor) of its node. Empty: it is held.
  std::vector<std::pair<int, double>> terms;
};

class CoordinateSystems;
class StaticSolver;
struct CheckedStiffness;

/// Makes the elements of a deck; make_elements unless a caller brings its own.
using ElementFactory = std::function<ElementList(const records::Deck&, const NodeTable&, Diagnostics&)>;

class Model final : public NodeTable {
 public:
  /// Builds everything; throws InputError with every error of the deck that concerns fe, ComputationError
  /// ("fe.preload-buckles") where the stiffness with that of the prestress is not definite.
  static Model build(const records::Deck& deck, const ModelOptions& options, Diagnostics& diagnostics);
  /// The same with elements from `factory`.
  static Model build(const records::Deck& deck, const ModelOptions& options, const ElementFactory& factory,
                     Diagnostics& diagnostics);

  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<std::unique_ptr<const Element>>& elements() const { return elements_; }
  bool has_card(const std::string& card) const {
    return cards_.contains(card);
  }                                                  ///< whether an element is of this card
  bool has_damping() const { return has_damping_; }  ///< whether any element damps
  int num_gdofs() const { return num_gdofs_; }
  int num_fdofs() const { return static_cast<int>(T_.cols()); }
  const SparseRows& T() const { return T_; }  ///< num_gdofs x num_fdofs
  /// Solves for the dofs that ASET or OMIT leave out, the others held; nullptr when none is left out.
  const std::shared_ptr<const StaticSolver>& omitted() const { return omitted_; }
  /// The fixed dofs' part: u_g = T q_f + T_fixed d, d the displacements of the fixed dofs in their CD axes, in the
  /// order of fixed_dofs() (SPC, permanent SPC, AUTOSPC). num_gdofs x num_fixed.
  const SparseRows& T_fixed() const { return T_fixed_; }
  const std::vector<int>& fixed_dofs() const { return fixed_dofs_; }  ///< rows in the numbering of the g-set, ascending
  /// What moves when an oblique direction that AUTOSPC holds lets go: a column, num_gdofs x 1, for each entry of
  /// autospc() with terms, in their order.
  const SparseRows& T_oblique() const { return T_oblique_; }
  MassKind mass_kind() const { return mass_kind_; }
  double wtmass() const { return wtmass_; }
  const std::vector<AutospcEntry>& autospc() const { return autospc_; }
  const records::Subcase& subcase() const { return subcase_; }
  /// ndof_g x 2: node id, code 1..6 (0 for a scalar point).
  Eigen::MatrixXi calc_dof_map() const;
  records::BodyMesh calc_mesh() const;

  /// K += K_e of an element of this model (N x N, as Element::add_stiffness), with K_G of its part of the prestress.
  void add_stiffness(const Element& element, Eigen::Ref<MatrixXd> K) const;
  const Prestress* prestress() const { return prestress_.get(); }  ///< nullptr: the model starts without stress
  /// K as the check of the prestress assembled it (fe/matrices/system.hpp); nullptr where there was none, and of an
  /// a-set.
  const CheckedStiffness* checked_stiffness() const { return checked_stiffness_.get(); }

  /// Rigid links with the second order of their motion (fe/model/links.hpp).
  const Links& links() const { return links_; }

  /// The f-dof that alone carries g-dof (node, component in CD axes), or -1 (constrained, dependent).
  int find_fdof(int node_index, int component) const;
  /// Node id and CD component of an f-dof, for messages.
  std::pair<int, int> describe_fdof(int fdof) const;

  /// Φ_R: num_gdofs x 6 geometric rigid-body modes about `point` (default: Bo), docs/theory/flexible-body.md §2. Scalar
  /// points: zero.
  MatrixXd calc_rigid_modes(const Vector3d& point = Vector3d::Zero()) const;

  int find_node(int id) const override;
  bool is_refused(int id) const override { return refused_grids_.count(id) > 0; }
  const Node& node(int index) const override { return nodes_[index]; }
  Matrix3d calc_axes(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const override;
  Vector3d calc_point(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const override;

  /// Whether the fixed dofs are those of load set `set`: every dof that its SPCD cards move is fixed, and no dof is
  /// fixed for the SPCD cards of another set alone.
  bool is_held_for(const records::Deck& deck, int set) const;
  /// Displacements d of the fixed dofs: those of the SPC set, overruled by the SPCD cards of load set `set` (0: none).
  /// Reports fe.spcd-not-fixed.
  VectorXd calc_enforced(const records::Deck& deck, int set, Diagnostics& diagnostics) const;

  /// Load vector (num_gdofs) of a set, in basic: FORCEx, MOMENTx, SLOAD, PLOADx, GRAV and RFORCE (with this model's
  /// mass), LOAD. Reports fe.missing-load and what is wrong with its cards.
  VectorXd calc_load(const records::Deck& deck, int set, Diagnostics& diagnostics) const;
  /// The same with what K_G wants to know of it.
  AppliedLoad calc_applied_load(const records::Deck& deck, int set, Diagnostics& diagnostics) const;

 private:
  friend class ModelBuilder;
  std::shared_ptr<const CoordinateSystems> systems_;
  std::vector<Node> nodes_;
  std::unordered_map<int, int> node_index_;
  std::set<int> refused_grids_;
  std::vector<std::unique_ptr<const Element>> elements_;
  std::set<std::string> cards_;
  bool has_damping_ = false;
  int num_gdofs_ = 0;
  SparseRows T_, T_fixed_, T_oblique_;
  std::shared_ptr<const StaticSolver> omitted_;
  std::shared_ptr<const CheckedStiffness> checked_stiffness_;
  Links links_;
  std::shared_ptr<const Prestress> prestress_;
  std::unordered_map<const Element*, const VectorXd*> prestressed_;  ///< internal forces in prestress_
  std::vector<std::pair<int, ElementShape>> drawn_lines_;            ///< PLOTEL: id, shape
  std::vector<int> fixed_dofs_;
  std::unordered_map<int, double> enforced_;  ///< by dof: the values of the SPC set that are not zero
  std::vector<int> held_by_spcd_;             ///< dofs that no SPC fixes but an SPCD of the subcase's load moves
  std::vector<int> fdof_node_, fdof_component_;
  std::vector<std::array<int, 6>> node_fdof_;
  MassKind mass_kind_ = MassKind::Lumped;
  double wtmass_ = 1;
  std::vector<AutospcEntry> autospc_;
  records::Subcase subcase_;
};

}  // namespace bough::fe
