#pragma once
/// \file Steps of build_system, each reporting every error it finds.
#include <map>
#include <optional>
#include <string>

#include "solver/builder/build_system.hpp"
#include "solver/functions/curve.hpp"

namespace bough::solver {

/// A name, as messages show it.
std::string quote(const std::string& name);

/// A body of the system, or nothing when its record has errors. `is_lagged`: its stiffening is a matter of others.
std::optional<Body> build_body(const records::BodyRecord& record, const FlexMap& flex, Diagnostics& diagnostics,
                               bool is_lagged = false);

/// Hinge that carries each body, parents first. order_tree reports loops and unknown names.
struct TreeOrder {
  std::vector<int> body;   ///< spec index by tree index
  std::vector<int> hinge;  ///< inboard hinge by tree index, -1: none given (a free hinge is made)
  std::map<std::string, int> tree_index;
};
/// Sorts bodies and hinges into a tree. Reports system.duplicate-name, system.ground-child and the names that are
/// unknown.
TreeOrder order_tree(const records::SystemSpec& spec, Diagnostics& diagnostics);

/// Springs, dampers, motion and initial coordinates of one hinge into `tb` (tb.hinge is set).
void build_hinge_coordinates(const records::HingeRecord& record, const FunctionMap& functions, TreeBody& tb,
                             Diagnostics& diagnostics);

/// Reports "system.motion-jumps" where a prescribed position jumps within the run.
void check_motion(const records::HingeRecord& record, const records::SimulationRecord& simulation, const TreeBody& tb,
                  Diagnostics& diagnostics);

/// The function of that name; reports "system.unknown-function" when there is none.
const TimeFunction* find_function(const FunctionMap& functions, const std::string& name, const SourceLocation& where,
                                  const std::string& user, Diagnostics& diagnostics);

/// Every [[tank]] into system.tree; the bodies are in. Reports "system.unknown-body", "system.bad-tank".
void build_tanks(const records::SystemSpec& spec, const TreeOrder& order, const FunctionMap& functions, System& system,
                 Diagnostics& diagnostics);

/// One [[force]]; `flex` is the record of its body or nullptr. Reports and returns nothing on errors.
std::optional<AppliedForce> build_force(const records::ForceRecord& record, const Tree& tree, int body,
                                        const records::FlexBody* flex, const FunctionMap& functions,
                                        Diagnostics& diagnostics);

/// Every [[constraint]] and its markers into system.loops, after the tree is finished.
void build_constraints(const records::SystemSpec& spec, const TreeOrder& order, System& system,
                       Diagnostics& diagnostics);
/// Chooses the results recovered on each flexible body, for the results file and for sensors; constraints and forces
/// are built before. Reports "system.no-recovery", "system.unknown-element"; notes "system.recovery-loads"; warns
/// "system.recovery-constraint".
void build_recoveries(const records::SystemSpec& spec, const FlexMap& flex, System& system, Diagnostics& diagnostics);
/// Initial positions and rates that close the loops, into system; `system` owns system. Reports
/// "system.cannot-assemble"; notes "system.assembled" (what was moved) and "system.redundant-constraint".
void assemble(const records::SystemSpec& spec, const TreeOrder& order, System& system, Diagnostics& diagnostics);
/// Records and bodies in which force elements look up their names.
struct ElementContext {
  const records::SystemSpec& spec;
  const TreeOrder& order;
  const FlexMap& flex;
  const FunctionMap& functions;
  const std::vector<bool>& body_is_valid;
  /// Returns true if the body, by its tree index, was built without errors.
  bool is_valid(int body) const { return body_is_valid[static_cast<size_t>(body)]; }
};
/// The [[function]] of that name as a curve; nullptr for "" and with errors reported.
std::unique_ptr<const Curve> find_curve(const ElementContext& context, const std::string& name,
                                        const SourceLocation& where, const std::string& user, Diagnostics& diagnostics);
/// One [[force]] with a type; its markers go into the finished tree. Reports and returns nullptr on errors.
std::unique_ptr<const ForceElement> build_element(const records::ForceElementRecord& record,
                                                  const ElementContext& context, Tree& tree, Diagnostics& diagnostics);
/// Returns true if coordinate i, from 0, has dry friction or rigid stops, and so a JointContact.
bool has_joint_contact(const records::HingeLawRecord& law, int i);
/// Force laws along the coordinates of a body's hinge, and the inertia of its motors; the tree is finished.
void build_hinge_laws(const records::HingeRecord& record, const ElementContext& context, TreeBody& tb,
                      std::vector<std::unique_ptr<const ForceElement>>& elements,
                      std::vector<JointContact>& joint_contacts, std::vector<LoadFriction>& load_frictions,
                      Diagnostics& diagnostics);

/// Reports "system.beyond-stop" for a coordinate that starts beyond a rigid stop; within calc_slack it is moved to the
/// stop.
void check_stops(System& system, Diagnostics& diagnostics);
/// Warns "system.stiff-shapes" of constraints, and hinges to ground, that hold a node of a flexible body in directions
/// in which its normal modes give way too little.
void check_shapes(const records::SystemSpec& spec, const System& system, const FlexMap& flex, Diagnostics& diagnostics);

/// Kind of load at a node. A hinge that can transmit a moment takes both.
struct NodeLoad {
  bool force = false, moment = false;
};
/// Index of node `id`; -1 with "system.unknown-node", "system.missing-locators" (a force on a stiffened body needs the
/// node's three), "system.node-without-rotation" (a moment at a grid of solids) or "system.frame-node" (the origin of a
/// free frame) reported.
int find_loaded_node(const std::string& body_name, const Body& body, int id, NodeLoad load, const SourceLocation& where,
                     const std::string& user, Diagnostics& diagnostics);

/// Notes properties that make a flexible body hard or impossible to integrate: "system.spanned-hinge" (clamped modes
/// that leave less than 0.1 % of the inertia about the hinge of the body), "system.inconsistent-integrals" (mass
/// integrals of no body).
void check_flexible_body(const TreeBody& tb, const records::FlexBody& flex, const records::BodyRecord& record,
                         Diagnostics& diagnostics);

}  // namespace bough::solver
