#pragma once
/// \file Loops of a tree: constraints, their multipliers, projection, impulses (docs/theory/multibody.md, "Loops").
///
/// All constraints together are G(q) u = 0, G u̇ = γ. G is never formed: a row is a wrench on two markers, M⁻¹Gᵀ what
/// the factored tree answers to it. With a the accelerations of the open tree
///     (G M⁻¹ Gᵀ) λ = γ - G a,   u̇ = a + M⁻¹ Gᵀ λ
/// by blocks of constraints that share trees rooted at ground, each sparse by who shares one; least-norm λ where
/// constraints depend on each other. Rows with a pivot below 1e-10 of the largest are void (change points).
#include "solver/loops/closure.hpp"
#include "solver/loops/relative.hpp"
#include "solver/loops/semidefinite.hpp"

namespace bough::solver {

/// ratio q of a plain hinge coordinate.
struct CouplerTerm {
  int q_row = 0, u_row = 0;
  double ratio = 1;
};

struct Constraint {
  std::string name;
  SourceLocation at;
  std::unique_ptr<const Closure> closure;  ///< nullptr: a coupler
  int parent_marker = 0, child_marker = 0;
  std::vector<CouplerTerm> terms;  ///< Σ ratio q = offset; is_rate: Σ ratio u = 0
  double offset = 0;
  bool is_rate = false;     ///< a coupler of rates alone
  bool active = true;       ///< at the start
  double coupled_size = 0;  ///< coupler: sum of squared ratios, of angles over the square of Loops::length
  double mobility = 0;      ///< [1/M] acceleration of all bodies on its path by a unit force
  std::vector<int> path;    ///< bodies it acts on and those between them and ground, ascending
  std::vector<int> roots;   ///< of the trees they belong to

  /// Number of rows: those of the closure, 1 for a coupler.
  int num_rows() const { return closure ? closure->num_rows() : 1; }
  /// Number of rows, the first ones, that hold a position; the others hold rates alone (nonholonomic).
  int num_position_rows() const { return closure ? closure->num_position_rows() : is_rate ? 0 : 1; }
  /// Coordinates of the closing hinge; 0 without one.
  int num_q() const { return closure ? closure->num_q() : 0; }
};

struct Loops {
  std::vector<Constraint> constraints;
  double length = 1;  ///< that gaps are small to

  /// Constraint by its index.
  const Constraint& operator[](int i) const { return constraints[static_cast<size_t>(i)]; }
  /// Number of constraints, open ones too.
  int size() const { return static_cast<int>(constraints.size()); }
  int find(const std::string& name) const;  ///< -1 when absent
};

struct ConstraintData {
  ConstraintState state;
  RelativeMotion relative;
  ClosureMotion own;
  double coupled = 0;                  ///< coupler: gap
  Vector6d lambda = Vector6d::Zero();  ///< of its rows
};

struct LoopBlock {
  /// Where a unit row of a constraint is felt: by constraints that share a tree with it, and by the bodies on their
  /// paths.
  struct Reach {
    std::vector<int> read;   ///< bodies on the paths of those constraints, ascending
    std::vector<int> moved;  ///< those of them in its own trees
  };
  std::vector<int> constraints, first;  ///< which, and the first row of each
  std::vector<Reach> reach;             ///< of each
  VectorXd rows;                        ///< what the rows are off by; then the multipliers
  SemidefiniteFactor factor;            ///< of A = G M⁻¹ Gᵀ
};

struct LoopData {
  std::vector<ConstraintData> constraints;
  std::vector<LoopBlock> blocks;  ///< of those that are closed

  /// Results of constraint i.
  const ConstraintData& operator[](int i) const { return constraints[static_cast<size_t>(i)]; }
  ConstraintData& operator[](int i) { return constraints[static_cast<size_t>(i)]; }
};

/// Paths of the constraints through the tree.
void finish_loops(const Tree& tree, Loops& loops);
/// Results and scratch arrays with every constraint in its initial state. Allocates.
LoopData make_loop_data(const Loops& loops, const Tree& tree);
/// Opens and closes the constraints. Allocates.
void set_constraint_states(const Loops& loops, const Tree& tree, const std::vector<ConstraintState>& constraints,
                           LoopData& data);
/// State of each constraint, by its index.
std::vector<ConstraintState> get_constraint_states(const LoopData& data);

/// Constraint i closed as it is found at the positions of the tree: what it is off by is kept, so that nothing jumps.
ConstraintState find_as_closed(const Loops& loops, const Tree& tree, const TreeData& tree_data, int i);

/// Gaps, W (position); relative velocities, biases (velocity). After the same stages of the tree. No allocation.
void calc_closure_positions(const Loops& loops, const Tree& tree, const TreeData& tree_data, LoopData& data);
void calc_closure_velocities(const Loops& loops, const Tree& tree, const TreeData& tree_data, LoopData& data);
/// Position error of a constraint: relative to Loops::length, and in radians. After calc_closure_positions.
double calc_gap(const Loops& loops, const LoopData& data, int constraint);
/// Largest position error of the closed constraints. \param[out] which  its constraint.
double calc_largest_position_error(const Loops& loops, const LoopData& data, int* which = nullptr);

/// After solve: u̇ with the constraints, by their multipliers and a second solve. Does nothing where none is closed. No
/// allocation. `is_factored`: state and factors are those of the last call, only loads have changed.
void close_loops(const Loops& loops, const Tree& tree, TreeData& tree_data, LoopData& data, Eigen::Ref<VectorXd> u_dot,
                 bool is_factored = false);
/// Projects q and u onto G(q) = 0, G u = 0 at t in the metric of M: the corrections are in the range of M⁻¹Gᵀ. Leaves
/// tree_data at (t, q, u), factored. No allocation.
void project(const Loops& loops, const Tree& tree, double t, Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u,
             TreeData& tree_data, LoopData& data);
/// Projects du (num_u): subtracts M⁻¹Gᵀ(G M⁻¹Gᵀ)⁺G du, by the factors of the last project or
/// factor_loops. No allocation.
void remove_normal(const Loops& loops, const Tree& tree, TreeData& tree_data, LoopData& data, Eigen::Ref<VectorXd> du);
/// G M⁻¹ Gᵀ of every block. After calc_closure_positions and calc_factor. No allocation.
void factor_loops(const Loops& loops, const Tree& tree, TreeData& tree_data, LoopData& data);
/// λ: the impulses that bring G u to zero from the velocities of the tree. After Stage::Velocity and Stage::Factor.
void calc_closing_impulses(const Loops& loops, const Tree& tree, TreeData& tree_data, LoopData& data);
/// Gᵀλ into a response that was started.
void add_multipliers(const Loops& loops, const Tree& tree, const TreeData& tree_data, const LoopData& data, Sweep& s);

/// The wrench at Hc on the child, in Hp: of the multipliers last found.
Vector6d calc_constraint_wrench(const Loops& loops, const LoopData& data, int constraint);

/// G of the closed constraints, rows in the order of the blocks, all columns of u, by unit speeds. For assembly and the
/// second route. After Stage::Position.
MatrixXd calc_dense_rows(const Loops& loops, const Tree& tree, const TreeData& tree_data, const LoopData& data);
/// [1] Sizes of the rows of G as forces, moments divided by Loops::length: row / size is a displacement [L] of any row.
/// After calc_closure_positions.
VectorXd calc_row_sizes(const Loops& loops, const LoopData& data);
/// The second route: [M Gᵀ; G 0] by assembly. After close_loops, whose u̇ gives γ.
void calc_dense_accelerations(const Loops& loops, const Tree& tree, const TreeData& tree_data, const LoopData& data,
                              Eigen::Ref<VectorXd> u_dot);
/// Rows, in the same order, that hold a position.
std::vector<int> list_position_rows(const Loops& loops, const LoopData& data);
/// Returns true if a closed constraint has rows that hold rates alone.
bool has_rate_rows(const Loops& loops, const LoopData& data);
/// The gaps of the rows, in the same order. After calc_closure_positions.
VectorXd get_gaps(const Loops& loops, const LoopData& data);

/// Moves q by a small step of u.
void displace(const Tree& tree, const ConstVectorRef& step, Eigen::Ref<VectorXd> q);

}  // namespace bough::solver
