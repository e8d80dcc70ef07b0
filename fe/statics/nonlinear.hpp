#pragma once
/// \file Static equilibrium under large displacements and rotations, elastic material: load steps, Newton's method.
///
/// Elements are linear in frames that follow their nodes (fe/corotational), rigid elements turn as rigid bodies, RBE3
/// with the mean of their grids, other constraint equations are linear in displacements and rotation vectors. Theory:
/// docs/theory/nonlinear-statics.md.
#include <memory>
#include <string>
#include <vector>

#include "fe/corotational/corotational_element.hpp"
#include "fe/loads/follower_loads.hpp"
#include "fe/statics/element_recovery.hpp"
#include "fe/statics/finite_ties.hpp"

namespace bough::fe {

struct NonlinearOptions {
  int num_increments = 10;  ///< equal steps of a load; a step that finds no equilibrium is halved, ten times at most
  int max_iterations = 25;  ///< of Newton's method in a step
  /// Follows the path through limit points, unstable states included, to where the load is reached first.
  bool has_arc_length = false;
  /// Place and advice of fe.no-equilibrium of steps without arc length.
  SourceLocation at;
  std::string advice =
      "look for buckling or a snap-through there: lower the load, give --arc-length to pass it, enforce displacements, "
      "or give more --increments";
};

class NonlinearStatics {
 public:
  /// Throws InputError with all that cannot move far: fe.nonlinear-element, fe.nonlinear-link, fe.nonlinear-model.
  /// `model` and `deck` outlive this.
  NonlinearStatics(const Model& model, const records::Deck& deck);

  /// State of the last equilibrium: displacements with rotation vectors [num_gdofs] and the rotation of each node.
  const DeformedState& state() const { return state_; }
  int num_iterations() const { return num_iterations_; }  ///< of all steps so far
  /// Number of load steps so far, halved ones included.
  int num_steps() const { return num_steps_; }

  /// Goes from the load of the last call (first: none) to `to` through stable states: their tangent stiffness is
  /// positive definite, or of positive determinant where moments about fixed axes make it unsymmetric. Throws
  /// ComputationError fe.no-equilibrium with the share of the load that was reached; the state is that of the last
  /// equilibrium then.
  /// `moving`: the part of `to` that follows the grids. With has_arc_length the states between are unstable where the
  /// load falls; fe.limit-point and fe.unstable-equilibrium report them.
  void go_to(const StaticLoad& to, const FollowerLoads& moving, const NonlinearOptions& options,
             Diagnostics& diagnostics);

  /// go_to() for a load of load set `set`: its pressures and forces by grids follow, unless PARAM,LGDISP is 2. Throws
  /// fe.nonlinear-load for PLOAD1 and RFORCE.
  void go_to_load_set(const StaticLoad& to, int set, const NonlinearOptions& options, Diagnostics& diagnostics);

  /// Result of the last state. `displacement` has rotation vectors. Moments of resultants are of deformed places.
  records::StaticSubcase make_result() const;
  /// FiniteForces::d and internal, by element, and their strain energies.
  const DeformedElements& deformed() const { return deformed_; }
  const VectorXd& energies() const { return energies_; }

 private:
  struct Tangent;
  Tangent evaluate(const VectorXd& F);
  void find_offset_masses();
  void find_linear_ties();
  /// A load, and the part of it that follows the grids.
  struct PathLoad : StaticLoad {
    FollowerLoads moving;
  };
  bool has_fixed_moments(const PathLoad& load);
  VectorXd calc_dead_forces(const PathLoad& load) const;
  VectorXd calc_forces(const VectorXd& dead) const;
  void set_loads(const PathLoad& from, const PathLoad& to, double share);
  void evaluate_element(int e, const Element& element, FiniteForces& forces) const;
  VectorXd collect(const VectorXd& residual) const;
  void move_to_unknowns(Tangent& tangent);
  void report_turned_ties(Diagnostics& diagnostics) const;
  void advance(const VectorXd& step);
  Eigen::SparseMatrix<double, Eigen::RowMajor> reduce(const Eigen::SparseMatrix<double, Eigen::RowMajor>& K) const;
  bool find_equilibrium(const VectorXd& F, const VectorXd& dF, const VectorXd& enforced, double share,
                        int max_iterations);
  VectorXd make_displacement() const;
  struct Arc;
  void follow_arc(const PathLoad& to, const NonlinearOptions& options, Diagnostics& diagnostics);

  const Model& model_;
  const records::Deck& deck_;
  FiniteTies ties_;
  std::vector<int> node_of_;                                      ///< node of each g-dof
  std::vector<char> is_stiff_;                                    ///< of each element
  std::vector<std::unique_ptr<const CorotationalElement>> kept_;  ///< stored if there is memory; otherwise recomputed
  std::vector<ArmLoad> offset_masses_;                            ///< force: of a unit acceleration, its size the mass
  std::vector<int> tied_;              ///< nodes of linear equations: MPC, RBE3 of single components
  std::vector<int> turned_by_vector_;  ///< of these: rotation vectors are their unknowns
  std::vector<ArmLoad> arm_loads_;     ///< of the state, as the next two
  FollowerLoads followers_;
  InitialForces heat_;
  bool is_symmetric_ = true;  ///< false: moments about fixed axes, or loads that follow the grids
  DeformedState state_;
  SparseRows basis_;  ///< of evaluate(): displacements and spins of all nodes by the unknowns; no rows: the identity
  VectorXd F_, d_;    ///< of the last state: dead forces, enforced displacements
  PathLoad load_;     ///< that the last go_to() reached
  DeformedElements deformed_;
  VectorXd energies_, residual_;
  double residual_work_ = 0, energy_ = 0, max_turn_ = 0, last_rate_ = 0;
  int num_iterations_ = 0, num_steps_ = 0;
};

}  // namespace bough::fe
