#pragma once
/// \file The finite-element model: nodes, elements, dofs and constraints, made once from a deck and const after. It
/// contains no matrix of the whole and no load; fe/statics/build_model.hpp makes the models that are solved.
///
/// g-set: every dof of every node, translations and rotations in **basic** axes (one row for a scalar point).
/// f-set: the free dofs left after SPC, permanent SPC, AUTOSPC, MPC and rigid elements, in the displacement (CD) axes.
/// With ASET or OMIT they are the dofs of the a-set, which the other free dofs follow statically
/// (fe/statics/guyan.hpp). u_g = T q_f, with the CD rotation, the constraint elimination and the zeros all inside the
/// sparse T.
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
#include "fe/model/constraints.hpp"
#include "fe/model/links.hpp"
#include "fe/model/prestress.hpp"
#include "formats/records/flex_body.hpp"
#include "formats/records/modes.hpp"

namespace bough::fe {

using Elements = std::vector<std::unique_ptr<const Element>>;
/// Changes the elements of K2GG, M2GG and B2GG before they join `others`, the elements of the cards.
using AdjustDirect =
    std::function<void(const records::Deck&, const Elements& others, ElementList& direct, Diagnostics&)>;

struct ModelOptions {
  int subcase = 0;                    ///< id; 0 = the first: its SPC and MPC sets are used
  bool ignore_spc = false;            ///< free-free: SPC sets and permanent SPC of translational kind are not applied
  std::optional<bool> autospc;        ///< overrides PARAM,AUTOSPC
  std::optional<MassKind> mass_kind;  ///< overrides PARAM,COUPMASS
  std::optional<Vector3d> origin;     ///< Bo in basic: node positions become relative to it
  std::vector<std::string> ignore_cards;  ///< --ignore CARD
  bool uses_enforced = false;  ///< the caller applies calc_enforced(): no warning that an SPC's value is dropped
  std::shared_ptr<const Prestress> prestress;  ///< of this deck (fe/statics/preload.hpp): its K_G0 joins the stiffness
  AdjustDirect adjust_direct = {};
};

/// One dof removed by AUTOSPC: node id, component 1..6 in CD axes, stiffness ratio that condemned it.
struct AutospcEntry {
  int node = 0, component = 0;
  double ratio = 0;
  bool is_skew = false;  ///< the component has stiffness: the direction without stiffness is oblique
  /// Oblique direction that is fixed: the component follows these (component, factor) of its node. Empty: it is fixed.
  std::vector<std::pair<int, double>> terms;
};

/// A dof that a card fixes or makes dependent.
struct ConstrainedDof {
  int dof = 0;       ///< row in the numbering of the g-set
  std::string card;  ///< of the constraint equation; empty: SPC or permanent SPC
  SourceLocation at;
};

/// Displacements (num_gdofs x m) that loads F_g (num_gdofs x m) give the dofs outside the a-set, with the a-set fixed.
using OmittedSolution = std::function<MatrixXd(const Eigen::Ref<const MatrixXd>& F_g)>;

class CoordinateSystems;
struct CheckedStiffness;

/// Makes the elements of a deck; make_elements unless a caller brings its own.
using ElementFactory = std::function<ElementList(const records::Deck&, const NodeTable&, Diagnostics&)>;

class Model final : public NodeTable {
 public:
  /// Builds nodes, constraints, elements and T after AUTOSPC: the first step of build_model(). Throws InputError with
  /// every error of the deck that concerns them.
  static Model build(const records::Deck& deck, const ModelOptions& options, const ElementFactory& factory,
                     Diagnostics& diagnostics);

  /// Grids and scalar points, with their positions and CD axes; the index of a node is its position here.
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Elements in the order in which the factory made them.
  const std::vector<std::unique_ptr<const Element>>& elements() const { return elements_; }
  bool has_card(const std::string& card) const {
    return cards_.contains(card);
  }                                                  ///< whether an element is of this card
  bool has_damping() const { return has_damping_; }  ///< whether any element damps
  /// Number of rows of the g-set.
  int num_gdofs() const { return num_gdofs_; }
  /// Number of dofs of the f-set, the columns of T.
  int num_fdofs() const { return static_cast<int>(T_.cols()); }
  const SparseRows& T() const { return T_; }  ///< num_gdofs x num_fdofs
  /// Static solution of the dofs that ASET or OMIT eliminate; empty if none is eliminated.
  const OmittedSolution& omitted() const { return omitted_; }
  /// The fixed dofs' part: u_g = T q_f + T_fixed d, d the displacements of the fixed dofs in their CD axes, in the
  /// order of fixed_dofs() (SPC, permanent SPC, AUTOSPC). num_gdofs x num_fixed.
  const SparseRows& T_fixed() const { return T_fixed_; }
  const std::vector<int>& fixed_dofs() const { return fixed_dofs_; }  ///< rows in the numbering of the g-set, ascending
  /// Displacements of the SPC set that are not zero, by fixed dof.
  const std::unordered_map<int, double>& spc_displacements() const { return spc_displacements_; }
  /// Fixed dofs that no SPC names but an SPCD of the load of the subcase moves.
  const std::vector<int>& fixed_by_spcd() const { return fixed_by_spcd_; }
  /// All dofs that cards constrain, dependent dofs first; filled if the deck has ASET or OMIT.
  const std::vector<ConstrainedDof>& constrained_dofs() const { return constrained_dofs_; }
  /// Motions of the oblique directions that AUTOSPC fixes: a column for each entry of autospc() with terms, in their
  /// order.
  const SparseRows& T_oblique() const { return T_oblique_; }
  /// The kind of mass matrix of the options or of PARAM,COUPMASS.
  MassKind mass_kind() const { return mass_kind_; }
  /// Factor of all masses, PARAM,WTMASS.
  double wtmass() const { return wtmass_; }
  /// Dofs and directions without stiffness that AUTOSPC has fixed.
  const std::vector<AutospcEntry>& autospc() const { return autospc_; }
  /// The subcase whose sets the model uses.
  const records::Subcase& subcase() const { return subcase_; }
  /// ndof_g x 2: node id, code 1..6 (0 for a scalar point).
  Eigen::MatrixXi calc_dof_map() const;
  /// Grids and shapes of the elements for pictures, blocks by shape, without scalar points.
  records::BodyMesh calc_mesh() const;

  /// K += K_e of an element of this model (N x N, as Element::add_stiffness), with K_G of its part of the prestress.
  void add_stiffness(const Element& element, Eigen::Ref<MatrixXd> K) const;
  const Prestress* prestress() const { return prestress_.get(); }  ///< nullptr: the model starts without stress
  /// K as the check of the prestress assembled it (fe/matrices/system.hpp); nullptr without a prestress, and of an
  /// a-set.
  const CheckedStiffness* checked_stiffness() const { return checked_stiffness_.get(); }

  /// This model with fewer f-dofs: T has the columns of the f-dofs `kept`, and `omitted` gives the displacements of the
  /// others under loads.
  Model with_transform(SparseRows T, const std::vector<int>& kept, OmittedSolution omitted) &&;
  /// This model with the K of its f-set, so that it is assembled and factored once.
  Model with_stiffness(std::shared_ptr<const CheckedStiffness> stiffness) &&;

  /// Rigid links with the second order of their motion (fe/model/links.hpp).
  const Links& links() const { return links_; }

  /// The f-dof that alone carries g-dof (node, component in CD axes), or -1 (constrained, dependent).
  int find_fdof(int node_index, int component) const;
  /// Row in the numbering of the g-set of component 1..6 (0: scalar point) of a grid. \return -1 after reporting
  /// fe.missing-grid or fe.bad-component.
  int find_ldof(int grid, int component, const std::string& card, const SourceLocation& at,
                Diagnostics& diagnostics) const;
  /// "grid 3 component 2" of such a row.
  std::string name_dof(int ldof) const;
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
  OmittedSolution omitted_;
  std::shared_ptr<const CheckedStiffness> checked_stiffness_;
  Links links_;
  std::shared_ptr<const Prestress> prestress_;
  std::unordered_map<const Element*, const VectorXd*> prestressed_;  ///< internal forces in prestress_
  std::vector<std::pair<int, ElementShape>> drawn_lines_;            ///< PLOTEL: id, shape
  std::vector<int> fixed_dofs_;
  std::unordered_map<int, double> spc_displacements_;
  std::vector<int> fixed_by_spcd_;
  std::vector<ConstrainedDof> constrained_dofs_;
  std::vector<int> fdof_node_, fdof_component_;
  std::vector<std::array<int, 6>> node_fdof_;
  MassKind mass_kind_ = MassKind::Lumped;
  double wtmass_ = 1;
  std::vector<AutospcEntry> autospc_;
  records::Subcase subcase_;
};

}  // namespace bough::fe
