#pragma once
/// \file The stages of reduce(), in the order in which reduce.cpp calls them. Internal.
#include "fe/loads/loads.hpp"
#include "fe/loads/temperatures.hpp"
#include "fe/statics/preload.hpp"
#include "formats/records/deck.hpp"
#include "modal/bases/basis.hpp"
#include "stiffening/reduce.hpp"

namespace bough::stiffening {

struct GivenModel;

/// The inputs of every stage.
struct BodyRequest {
  const records::Deck& deck;
  const records::BodySpec& spec;
  const ReduceOptions& options;
  const GivenModel* given;  ///< matrices of another program in place of the deck's elements; nullptr: none
  Diagnostics& diagnostics;
  std::shared_ptr<const fe::Prestress> prestress = nullptr;  ///< of the shape that the deck has; nullptr: none

  /// The body file, or the deck when there is none.
  SourceLocation where() const { return spec.file.empty() ? deck.locate({0, 0}) : SourceLocation{spec.file, 0, 0}; }
  /// Returns true if the frame is not that of the constraints.
  bool is_free() const { return spec.frame != records::BodyFrame::Fixed; }
  /// Returns true if the frame is neither that of the constraints nor the mean axes of free-free modes.
  bool moves_to_frame() const { return is_free() && spec.frame != records::BodyFrame::Free; }
  /// Makes the elements of the deck, or those of the given matrices.
  fe::ElementFactory make_factory() const;
  /// Reports a stage of the work to the caller's progress function, if any.
  void report(const std::string& stage) const {
    if (options.progress) options.progress(stage);
  }
  /// Place of a key of the body file (BodySpec::locate), or where().
  SourceLocation where(const std::string& key) const { return spec.file.empty() ? where() : spec.locate(key); }
  /// Adds an error at the place of a key.
  void error_at(const std::string& key, std::string_view id, const std::string& message,
                const std::string& advice = {}) const {
    diagnostics.error(id, where(key), message, advice);
  }
  /// Adds an error at where().
  void error(std::string_view id, const std::string& message, const std::string& advice = {}) const {
    diagnostics.error(id, where(), message, advice);
  }
  /// Adds a warning at the place of a key.
  void warning_at(const std::string& key, std::string_view id, const std::string& message,
                  const std::string& advice) const {
    diagnostics.warning(id, where(key), message, advice);
  }
  /// Adds a warning at where().
  void warning(std::string_view id, const std::string& message, const std::string& advice) const {
    diagnostics.warning(id, where(), message, advice);
  }
  /// Adds a note at where().
  void note(std::string_view id, const std::string& message, const std::string& advice) const {
    diagnostics.note(id, where(), message, advice);
  }
};

/// The deformed shape and the stress of [body.preload] with nonlinear = true. The body is made of its deck.
fe::DeformedPreload calc_nonlinear_preload(const BodyRequest& request);

/// The model of a body, with its positions from Bo and the stiffness of its preload; const after.
struct BodyModel {
  fe::ModelOptions options;  ///< of `model`
  std::unique_ptr<const fe::Model> model;
  std::unique_ptr<const fe::System> system;
};

/// Static solutions on the SPC set of a fixed body, on a statically determinate support of a free one.
struct StaticSupport {
  modal::bases::StaticSolve solve;
  const linear::SymmetricFactor* factor = nullptr;  ///< LLᵀ of K without more support, owned by `solve`; nullptr: none
};

/// A load whose K_G the body has: a unit at a node and direction, or a load pattern; `F` num_gdofs in basic.
struct LoadPattern {
  std::string group;  ///< the name in the body file; "" for the units at the interface nodes
  records::Locator locator;
  fe::AppliedLoad load;
  fe::InitialForces initial;  ///< of a temperature set
  int load_set = 0;           ///< whose loads along beams the forces of elements contain; 0: none
};

/// M on the g-set and the twelve inertial loads that it makes.
struct InertialLoads {
  linear::SymmetricMatrix M;
  MatrixXd F_I;  ///< num_gdofs x 12
};

/// The shapes of a body with their modal matrices.
struct ModalBasis {
  MatrixXd Phi;  ///< num_gdofs x n in basic
  VectorXd eigenvalue;
  MatrixXd mass, stiffness, damping;  ///< n x n
  std::vector<records::ModeKind> kind;
  modal::bases::ModesCheck check;           ///< of the normal modes; empty if none were computed
  std::vector<std::string> massless_loads;  ///< names of residual loads whose flexibility is lost in part
};

/// The loads of K_G as columns, inertial loads first, with their static solutions.
struct SolvedLoads {
  std::vector<int> inertial;  ///< records::InertialLoad of the first columns, ascending
  fe::AppliedLoads columns;
  MatrixXd U;  ///< num_gdofs x m
  /// Number of inertial loads, the first columns.
  Eigen::Index num_inertial() const { return static_cast<Eigen::Index>(inertial.size()); }
};

/// Throws InputError with all errors of the body file that need no model.
void check_spec(const BodyRequest& request);

/// Bo in basic if the body file or a grid of the deck gives it; empty: the basic origin or the centre of mass.
std::optional<Eigen::Vector3d> find_origin(const records::Deck& deck, const records::BodySpec& spec);
/// Builds the model with the selected constraints, about Bo; a frame of reference conditions is checked first.
BodyModel build_body_model(const BodyRequest& request);
/// Name, mass, centre of mass, inertia, preload. Throws reduce.no-mass; reports reduce.mass-by-direction.
records::FlexBody make_rigid_body(const BodyRequest& request, const fe::Model& model);
/// Throws reduce.mechanism.
StaticSupport make_static_support(const BodyRequest& request, const fe::System& system);
/// Reports reduce.mechanism: the parts that nothing constrains, if there are several; else `message`.
void add_mechanism_error(const BodyRequest& request, const fe::Model& model, const std::string& message);

/// Interface nodes of the body file, each once.
std::vector<int> list_interface_nodes(const records::BodySpec& spec);
/// Units at the interface nodes, then the loads of the body file, then the loads of given K_G. Throws
/// reduce.load-on-nothing.
std::vector<LoadPattern> make_load_patterns(const BodyRequest& request, const fe::Model& model);
/// Assembles M on the g-set and computes F_I for unit load factors. Collective.
InertialLoads calc_body_inertial_loads(const fe::Model& model);
/// Returns true if residual vectors of the inertial loads are requested.
bool needs_inertial_residuals(const records::BodySpec& spec);
/// Name of a residual load, a unit at an interface node; direction: 1 to 6.
std::string get_unit_name(int node, int direction);
/// The columns for residual vectors, in the order of the spec. F_I: as of needs_inertial_residuals().
modal::response::ResidualLoads make_residual_loads(const BodyRequest& request, const fe::Model& model,
                                                   const std::vector<LoadPattern>& patterns, const MatrixXd& F_I);

/// Modes, frame and damping. Throws reduce.grounded, reduce.mechanism, reduce.bad-select, reduce.bad-damping.
ModalBasis calc_body_basis(const BodyRequest& request, const BodyModel& model, const StaticSupport& support,
                           const modal::response::ResidualLoads& residual);
/// Given shapes, with full modal matrices. Throws reduce.no-modal-mass.
ModalBasis make_given_basis(const BodyRequest& request, const fe::System& system);
/// The frame of a body that moves_to_frame().
modal::bases::FrameSpec make_frame_spec(const records::BodySpec& spec);
/// Damping by ratio, table, Rayleigh's factors and the materials, of a basis that is orthogonal to the rigid-body
/// modes: these do not dissipate.
MatrixXd calc_body_damping(const BodyRequest& request, const fe::Model& model, const modal::bases::Basis& basis);
/// damping += ΦᵀBΦ of the dampers of the deck, which couples modes.
void add_dampers(const fe::Model& model, const MatrixXd& Phi, MatrixXd& damping);

/// The model with the point masses of [[body.augment]]; no model without them.
BodyModel augment(const BodyRequest& request, const BodyModel& model);
/// Projects the augmented basis on the body alone: mass, mean axes and, by `orthogonalize`, its modes.
void remove_augmentation(const BodyRequest& request, const fe::Model& model, modal::bases::Basis& basis);

/// Returns true if the node translates without rotating: a grid of solids or rods alone. A rotation in its rows is that
/// of the frame, not of the node.
bool lacks_rotation(const fe::Model& model, const fe::Node& node);
/// Sets eigenvalues, frequencies [Hz], kinds and modal matrices of the body.
void set_modes(const ModalBasis& basis, records::FlexBody& body);
/// Sets the output nodes, by default all grids, their positions from Bo and the rows of Phi.
void set_nodes(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi, records::FlexBody& body);
/// Mass integrals, effective masses, F_I. `strain`: of arms in the exact integrals (modal::calc_strained_integrals).
/// Reports reduce.inertia-approximated.
void set_integrals(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi, const InertialLoads& loads,
                   records::FlexBody& body, const MatrixXd& strain = {});
/// Locators, external loads, their resultants and moments.
void set_loads(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi,
               const std::vector<LoadPattern>& patterns, records::FlexBody& body);

/// Throws reduce.bad-order if third order is requested and the model has what the series do not contain.
void check_third_order(const BodyRequest& request, const fe::Model& model);
/// Returns true if check_third_order() finds nothing in this body.
bool has_series(const BodyRequest& request, const fe::Model& model);
/// Energy of the soft modes of a body of second order, if the model has power series (docs/theory/third-order.md, "Next
/// order").
void set_next_order(const BodyRequest& request, const fe::Model& model, const ModalBasis& basis,
                    const StaticSupport& support, const InertialLoads& inertial, records::FlexBody& body);
/// Indices of the elements in the model, of each block of FlexBody::recovery.
using RecoveredElements = std::vector<std::vector<int>>;
/// Starts the blocks of the elements that the spec recovers, without rows. Throws reduce.bad-recover,
/// reduce.unknown-element.
RecoveredElements start_recovery(const BodyRequest& request, const fe::Model& model, records::FlexBody& body);
/// Third order, if it is requested, with RecoveryBlock::beyond; after set_loads. Throws reduce.bad-order.
void set_third_order(const BodyRequest& request, const fe::Model& model, const ModalBasis& basis,
                     const std::vector<LoadPattern>& patterns, const StaticSupport& support,
                     const InertialLoads& inertial, const RecoveredElements& recovered, records::FlexBody& body);
/// Degree 2 of order 2 for loads that the modes do not follow, in pairs with residual vectors
/// (docs/theory/third-order.md, "Lost twist"); after set_geometric_stiffness.
void set_lost_loads(const ModalBasis& basis, records::FlexBody& body);

/// Solves K u = f for each inertial load of the spec, a column of F_I [num_gdofs x 12], and for each pattern, on the
/// static support.
SolvedLoads solve_loads(const BodyRequest& request, const std::vector<LoadPattern>& patterns, const MatrixXd& F_I,
                        const StaticSupport& support);
/// Sets K_G1 of the inertial loads and K_G2 of the patterns, n x n each; those of thermal patterns contain their
/// initial stress.
void set_geometric_stiffness(const fe::Model& model, const MatrixXd& Phi, const std::vector<LoadPattern>& patterns,
                             const SolvedLoads& solved, records::FlexBody& body);
/// Sets the rows of the blocks that start_recovery() made: forces and stresses of elements.
void set_recovery(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi,
                  const std::vector<LoadPattern>& patterns, const SolvedLoads& solved,
                  const RecoveredElements& recovered, records::FlexBody& body);
/// Rows of an element in a block: the forces that static solutions print, then stresses. d: N x columns, deformations;
/// forces: internal forces [s x columns]; `more`: stresses in addition to those of the forces, or none (0 rows).
MatrixXd calc_recovery_rows(const fe::Element& element, const MatrixXd& d, const MatrixXd& forces,
                            const MatrixXd& more = {});
/// K_G0 of the preload and its inertial load factors. Throws reduce.bad-preload.
void set_preload(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi, records::FlexBody& body);
/// Sets the strain energy matrices of all elements, if they are requested.
void set_strain_energy(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi,
                       records::FlexBody& body);

}  // namespace bough::stiffening
