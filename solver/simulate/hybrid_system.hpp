#pragma once
/// \file A System as ẏ = f(t, y), y = [q; u; z; work; dissipated]: work integrates the power of all that is applied,
/// damped or prescribed, so that kinetic + strain + potential - work is constant; dissipated is what dampers took of
/// it.
#include <string>

#include "solver/integrate/ode.hpp"
#include "solver/system/impact.hpp"

namespace bough::solver {

class HybridSystem final : public Ode {
 public:
  /// `system` must outlive this. Allocates all results of an evaluation.
  explicit HybridSystem(const System& system);

  int size() const override { return num_q_ + num_u_ + num_z_ + 2; }
  /// The system whose equations these are: that of the constructor, or the variant with the present fill levels.
  const System& system() const { return *system_; }
  /// Number of rows of q.
  int num_q() const { return num_q_; }
  /// Rows of y that are q and u.
  int num_coordinates() const { return num_q_ + num_u_; }
  /// Number of states of controllers, actuators and sensors.
  int num_z() const { return num_z_; }
  /// Also leaves data() at (t, y): kinematics, forces, accelerations. No allocation.
  void calc_derivative(double t, const Eigen::Ref<const VectorXd>& y, Eigen::Ref<VectorXd> y_dot) override;
  bool has_projection() const override { return system_->num_constraints() > 0; }
  void project(double t, Eigen::Ref<VectorXd> y) override;
  void project_error(Eigen::Ref<VectorXd> error) override;
  /// Applies the impacts of all stops reached at (t, y) together; free coordinates follow. The energy loss is
  /// dissipated.
  void strike(double t, std::vector<Impact>& blows, Eigen::Ref<VectorXd> y);
  /// A takes the stiffness and damping of each body's modes, of hinge springs, dampers, stops and friction for linear
  /// and nothing else: (M + γh D + γ²h² K) u̇ by the order-n recursion, in which K and D are blocks of one body.
  void calc_stage(double t, const Eigen::Ref<const VectorXd>& y, double gamma_h, bool is_first,
                  Eigen::Ref<VectorXd> k) override;
  /// Evaluations of the equations of motion so far, by calc_derivative and calc_stage.
  long num_evaluations() const { return num_evaluations_; }
  /// Results of the last evaluation.
  const SystemData& data() const { return *data_; }
  SystemData& data() { return *data_; }
  /// y at the start: the initial state with work and dissipated 0.
  VectorXd make_initial_state() const;
  /// Takes y over the jump at t; `before` is the last moment that sees what was. Describes each jump of a rate.
  std::vector<std::string> cross_jump(double before, double t, Eigen::Ref<VectorXd> y);
  /// Takes y at t from what each coordinate and constraint does to what it does from then on, and to the fill levels
  /// of next.variant. Describes jumps.
  std::vector<std::string> change(double t, const DiscreteState& next, Eigen::Ref<VectorXd> y);
  /// change() for coordinates that stick: the energy lost counts as dissipated. The impulse that stops a remaining rate
  /// also acts on the modes of the body.
  void stick(double t, const DiscreteState& next, Eigen::Ref<VectorXd> y);
  /// stick() with the modes of now: coordinates and rates that are given take their values. No allocation.
  void keep_modes(double t, Eigen::Ref<VectorXd> y);
  /// A constraint closed as it is found at (t, y).
  ConstraintState find_as_closed(double t, const Eigen::Ref<const VectorXd>& y, int constraint);
  /// Modes of each coordinate and constraint, for a checkpoint.
  VectorXd make_memory() const;
  /// Returns true if all that may lock, release, close and open is in the mode of `memory`; the coordinates of closing
  /// hinges follow the motion and do not count, nor do fill levels.
  bool is_alike(const VectorXd& memory) const;
  void get_memory(VectorXd& memory) const;  ///< of that size; no allocation
  /// Restores the modes of hinge coordinates and constraints of get_memory(). Allocates.
  void set_memory(const VectorXd& memory);
  /// Row `work` of y.
  double get_work(const Eigen::Ref<const VectorXd>& y) const { return y[num_coordinates() + num_z_]; }
  /// Row `dissipated` of y.
  double get_dissipated(const Eigen::Ref<const VectorXd>& y) const { return y[num_coordinates() + num_z_ + 1]; }
  /// "body 'boom' (modal rate 2)" for a row of y.
  std::string name_row(int row) const;
  /// Name of the first quantity that is not finite at (t, y): a coordinate, a function of a force or a motion, a load,
  /// an acceleration. Empty if all are finite.
  std::string name_first_non_finite(double t, const Eigen::Ref<const VectorXd>& y);

 private:
  std::string switch_levels(double t, int variant, Eigen::Ref<VectorXd> y);
  /// Takes the equations of a variant, coordinates and constraints in their modes; returns the data before.
  std::unique_ptr<SystemData> set_variant(int variant);
  void calc_tangent();
  void add_stage_forces(double gamma_h, bool is_first);

  const System& start_;
  const System* system_;  ///< start_ or one of its variants
  std::unique_ptr<SystemData> data_;
  int num_q_, num_u_, num_z_;
  bool has_motion_ = false;
  long num_evaluations_ = 0;
  // Vectors of the stages: stiffness and damping along hinge coordinates, first stage and right-hand side in the
  // tangent of q, first stage of u, forces added by the stage, by row of u.
  VectorXd k_, c_, first_delta_, first_u_, delta_, extra_;
};

}  // namespace bough::solver
