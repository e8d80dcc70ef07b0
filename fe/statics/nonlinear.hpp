#pragma once
/// \file Static equilibrium under large displacements and rotations, elastic material: load steps, Newton's method.
///
/// Elements are linear in frames that follow their nodes (fe/corotational), rigid elements turn as rigid bodies, loads
/// keep their directions. Theory: docs/theory/nonlinear-statics.md.
#include <memory>
#include <vector>

#include "fe/corotational/corotational_element.hpp"
#include "fe/model/rigid_arms.hpp"
#include "fe/statics/element_recovery.hpp"

namespace bough::fe {

struct NonlinearOptions {
  int num_increments = 10;  ///< equal steps of a load; a step that finds no equilibrium is halved, ten times at most
  int max_iterations = 25;  ///< of Newton's method in a step
};

/// Places of all nodes. Start: undeformed.
struct DeformedState {
  VectorXd u;               ///< num_gdofs: translations and scalar points in basic; rows of rotations are zero
  std::vector<Matrix3d> R;  ///< rotation of every node
};

class NonlinearStatics {
 public:
  /// Throws InputError with all that cannot move far: fe.nonlinear-element, fe.nonlinear-link, fe.nonlinear-model.
  /// `model` outlives this.
  NonlinearStatics(const Model& model, const records::Deck& deck);

  const DeformedState& state() const { return state_; }
  int num_iterations() const { return num_iterations_; }  ///< of all steps so far
  int num_steps() const { return num_steps_; }

  /// Goes from the load of the last call (first: none) to `load` through stable states: their tangent stiffness is
  /// positive definite, or of positive determinant where moments about fixed axes make it unsymmetric. Throws
  /// ComputationError fe.no-equilibrium with the share of the load that was reached; the state is that of the last
  /// equilibrium then.
  void go_to(const StaticLoad& load, const NonlinearOptions& options, Diagnostics& diagnostics);

  /// Result of the last state. `displacement` has rotation vectors. Moments of resultants are of deformed places.
  records::StaticSubcase make_result() const;
  /// FiniteForces::d and internal, by element, and their strain energies.
  const DeformedElements& deformed() const { return deformed_; }
  const VectorXd& energies() const { return energies_; }

 private:
  struct Tangent;
  Tangent evaluate(const VectorXd& F);
  void find_offset_masses();
  bool has_fixed_moments(const StaticLoad& load);
  void set_arm_loads(const StaticLoad& from, const StaticLoad& to, double share);
  void evaluate_element(int e, const Element& element, FiniteForces& forces) const;
  void move_to_parents(const Element& element, FiniteForces& forces, std::vector<int>& gdofs) const;
  VectorXd collect_arms(VectorXd residual) const;
  void advance(const VectorXd& step);
  Eigen::SparseMatrix<double, Eigen::RowMajor> reduce(const Eigen::SparseMatrix<double, Eigen::RowMajor>& K) const;
  bool find_equilibrium(const VectorXd& F, const VectorXd& enforced, double share, int max_iterations);
  VectorXd make_displacement() const;

  const Model& model_;
  RigidArms arms_;
  std::vector<int> node_of_;                                      ///< node of each g-dof
  std::vector<char> is_stiff_;                                    ///< of each element
  std::vector<std::unique_ptr<const CorotationalElement>> kept_;  ///< where there is room; else made again each time
  std::vector<ArmLoad> offset_masses_;                            ///< force: of a unit acceleration, its size the mass
  std::vector<ArmLoad> arm_loads_;                                ///< of the state
  bool has_moments_ = false;  ///< moments about fixed axes: the tangent stiffness is not symmetric
  DeformedState state_;
  VectorXd F_, d_;   ///< of the last state
  StaticLoad load_;  ///< that the last go_to() reached
  DeformedElements deformed_;
  VectorXd energies_, residual_;
  double residual_work_ = 0, energy_ = 0, max_turn_ = 0, last_rate_ = 0;
  int num_iterations_ = 0, num_steps_ = 0;
};

}  // namespace bough::fe
