#pragma once
/// \file A System as linearize and equilibrium see it: dofs, inputs, outputs. The one door of solver/linear to the
/// rest of the solver.
///
/// A dof is a free hinge coordinate or a mode, in the order of u. Positions near q are q ⊕ δ, with one δ for each dof:
/// q + δ, and for the orientation of a spherical or free hinge q exp(δ̃) (δ in Hc, as its u). About a motion q(t), u(t)
/// that gives δ̇ = δu, and δ̇ = δu - ω × δ for an orientation that turns at ω: exact to first order.
///
/// Where loops are closed the dofs are independent ones among these, by pivots of G at the start (Wehage & Haug,
/// J. Mech. Design 104 (1982) 247); the others follow: q by assembly, u by G u = 0.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "formats/records/linear_model.hpp"
#include "solver/loops/assemble.hpp"
#include "solver/state/difference.hpp"
#include "solver/state/law_tangents.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

struct SampleTimes;

struct OperatingPoint {
  double t = 0;
  VectorXd q, u;       ///< num_q; one rate for each dof
  VectorXd z, memory;  ///< all of controllers, actuators and sensors
};

/// A scalar that pushes: the value of a [[force]], the command of an actuator, a generalized force on a free hinge
/// coordinate, or what is added to a signal on its way to those that read it.
struct PlantInput {
  std::string name, dims;
  int force = -1;     ///< index into the system's forces
  int actuator = -1;  ///< or: counted in the order of the file
  int row = -1;       ///< or: row of u of the hinge coordinate
  int signal = -1;    ///< or: row of the values of signals
};

class Plant {
 public:
  /// The system was built without errors and must outlive the plant. `is_open`: actuators keep the commands they have
  /// at the operating point, and controllers' states are none of the plant's.
  explicit Plant(const System& system, bool is_open = false);

  /// The system of the constructor.
  const System& system() const { return system_; }
  /// Returns true if actuators keep their commands.
  bool is_open() const { return is_open_; }
  /// Number of independent displacements.
  int num_dofs() const { return static_cast<int>(dofs_.size()); }
  /// "shoulder:1"; "ball:rx" for rotations, "flyer:x" for translations of a spherical or free hinge; "boom:eta3".
  const std::string& dof_name(int i) const { return dofs_[static_cast<size_t>(i)].name; }
  /// Dimensions of a displacement: "1", "L", "by normalisation".
  const std::string& dof_dims(int i) const { return dofs_[static_cast<size_t>(i)].dims; }
  /// Returns true for a modal coordinate.
  bool is_mode(int i) const { return dofs_[static_cast<size_t>(i)].is_mode; }
  /// A displacement that is large but not absurd: 0.1 rad, 5 % of the size of the bodies.
  double step(int i) const { return dofs_[static_cast<size_t>(i)].step; }

  /// Number of states in addition to displacements and rates: signal states, then path coordinates.
  int num_states() const { return num_signal_states() + num_paths(); }
  /// Number of states of controllers, actuators and sensors.
  int num_signal_states() const { return static_cast<int>(state_rows_.size()); }
  /// Number of displacements whose rates follow (nonholonomic constraints): where a rolling body is.
  int num_paths() const { return static_cast<int>(paths_.size()); }
  /// "controller 'pid' (state 1)"; of a path coordinate as dof_name().
  std::string state_name(int i) const;
  /// Dimensions of a state.
  std::string state_dims(int i) const;
  /// The row of z of a signal state.
  int state_row(int i) const { return state_rows_[static_cast<size_t>(i)]; }
  /// A difference of state i that is large but not absurd.
  double state_step(const OperatingPoint& point, int i) const;
  /// Adds h to state i.
  void move_state(OperatingPoint& point, int i, double h) const;
  /// States that are the propellant that a thruster has used, from a tank or from none: they rise as time does.
  std::vector<int> find_used_up();
  /// Sampled controllers and sensors, which stand still in a linear model.
  std::vector<std::string> list_sampled() const;
  /// Label of the first block whose samples have no linear model; empty: none.
  std::string find_opaque() const;

  /// Sets dofs and loops to the modes of hinges and constraints after an event, for the positions (t, q).
  void set_modes(const DiscreteState& discrete, double t, const VectorXd& q);
  /// Returns the start of the run, after initialize_signals().
  OperatingPoint make_initial_point();
  /// Returns the initial state of the system file, before steady lags, samples and switches of the start.
  OperatingPoint get_initial_state() const;
  /// Initializes z and the memory at a point as a run does at its start: steady lags, the samples due, switches.
  /// Throws ComputationError "control.chatter".
  void initialize_signals(OperatingPoint& point);
  /// Switches every block with a positive event function at a point, until none is left.
  ///
  /// \return label of the last block that switched; empty if none did.
  /// \throws ComputationError "control.chatter" if the switches do not end.
  std::string iterate_switches(OperatingPoint& point);
  /// Where is_open: from now on actuators keep the commands they have there.
  void hold_commands(const OperatingPoint& point);
  /// q ⊕ δ; delta: num_dofs. Throws ComputationError "linear.dead-point" where the loops cannot follow.
  VectorXd displace(const VectorXd& q, const VectorXd& delta) const;
  /// num_u of the system, of one value for each dof: zero if a motion is prescribed or loops are closed; and back.
  VectorXd expand(const VectorXd& free) const;
  /// Rows of the dofs, out of the num_u of the system.
  VectorXd restrict(const VectorXd& u) const { return u(rows_); }
  /// All speeds at a point, those that loops give too. Throws ComputationError "linear.dead-point".
  VectorXd calc_speeds(const OperatingPoint& point) const;
  /// ∂δ̇/∂δ about a motion, at fixed rates: zero but for orientations that turn. Displacements of dofs, then path
  /// coordinates: (num_dofs + num_paths)².
  MatrixXd calc_turning(const OperatingPoint& point) const;
  /// The mass matrix of the dofs; where loops are closed what follows moves along. num_dofs².
  MatrixXd calc_mass(const OperatingPoint& point);
  /// Quaternions as the files have them: w, x, y, z.
  VectorXd get_for_file(const VectorXd& q) const;

  /// Every force, then every actuator, then every free hinge coordinate, then components of sensors and controllers
  /// and every [[input]] (by their path, "/sensors/tip:x", where the name alone is taken).
  const std::vector<PlantInput>& inputs() const { return inputs_; }
  /// Number of inputs that are forces; they come first.
  int num_forces() const { return num_forces_; }
  /// Number of inputs that are actuators; they follow the forces.
  int num_actuators() const { return num_actuators_; }
  /// Components of the sensors: "tip:x", or the sensor's name when it is a scalar; then those of controllers and
  /// actuators; then the command of each actuator, "motor:command".
  const records::Signals& outputs() const { return outputs_; }
  /// Number of outputs that are components of sensors; they come first.
  int num_sensor_outputs() const { return num_sensor_outputs_; }
  /// The controller of output i where is_open leaves out states or memory of it; "": none.
  std::string find_frozen_law(int i) const;
  /// Point where a loop may be cut: the output before, and the input after the cut. Throws nothing; -1: no such name.
  /// The output is the value of a signal, or the command of an actuator, without the addition by the input.
  struct Cut {
    int output = -1, input = -1;
  };
  /// Finds the cut by the name of an input.
  Cut find_cut(const std::string& name) const;
  /// Names at which find_cut() finds a point.
  std::vector<std::string> list_cuts() const;

  /// Computes f'(0) of a function that evaluates this plant, as evaluate, sample or sample_all.
  ///
  /// Laws are their tangents at f(0) meanwhile (solver/state/law_tangents.hpp), so that `step` need suit the geometry
  /// only. Difference::kink holds the effect of functions that have two slopes there; `kinks` gains them.
  Difference differentiate(const std::function<VectorXd(double)>& f, double step,
                           std::vector<LawKink>* kinks = nullptr);
  /// [u̇; rates of states; y] with every function of time at its value, and `value` more of one input. May throw
  /// ComputationError.
  VectorXd evaluate(const OperatingPoint& point, const PlantInput* input = nullptr, double value = 0);
  /// Acceleration of a steady spin at the point of the last evaluate: on a hinge to ground with free translations
  /// normal to ω, p̈ = ω × (ṗ - v_c), with v_c the velocity of the centre of mass of all that it carries. Zero at rest
  /// and where nothing spins about an axis off its centre of mass. num_dofs.
  VectorXd calc_spin() const;
  /// u̇ (of the last evaluate) minus calc_spin(). num_dofs.
  VectorXd calc_unsteadiness(const VectorXd& u_dot) const;
  /// Forces that the last evaluate leaves unbalanced in a steady spin, M times calc_unsteadiness: from forces and
  /// inertia loads, not from u̇, whose roundoff is that of a factorization. num_dofs.
  VectorXd calc_imbalance() const;
  /// Round-off of calc_unsteadiness where bodies spin. num_dofs.
  VectorXd calc_spin_rounding(const OperatingPoint& point) const;
  /// Rows of the memory of sampled blocks that change at samples: outputs that are held, and samples in queues.
  const std::vector<int>& sampled_rows() const { return sampled_rows_; }
  /// "controller 'law' (memory 1)".
  std::string sampled_name(int i) const { return sampled_names_[static_cast<size_t>(i)]; }
  /// Instants of samples of all blocks.
  std::vector<SampleTimes> collect_samples() const;
  /// Samples on their way of the longest queue of each period, for the length of a cycle: (period, queue).
  std::vector<std::pair<double, int>> list_cycles() const;
  /// All memory after the samples due at point.t, sensors without noise and quantization. `input` has `before` more
  /// when they begin, and `value` more for what follows it. May throw ComputationError.
  VectorXd sample(const OperatingPoint& point, const PlantInput* input = nullptr, double before = 0, double value = 0);
  /// Sample times of a signal or a command that is cut; period 0 if it also changes between samples.
  SampleTimes find_hold(const PlantInput& input) const;
  /// Value that returns to the cut: find_cut's output, held if it is sampled. May throw ComputationError.
  double calc_return(const OperatingPoint& point, const PlantInput& input, double value);
  /// Samples on their way: rows `first` to first + size * length of sampled_rows, the sample k at k mod length.
  struct Queue {
    int first = 0, size = 0, length = 0;
    double period = 0;
  };
  /// All queues of delayed samples.
  const std::vector<Queue>& list_queues() const { return queues_; }
  /// Rows of the memory that a steady state has to find: what sampled blocks keep and hold. Empty where is_open.
  const std::vector<int>& steady_rows() const { return steady_rows_; }
  /// Name of a steady row, for messages.
  const std::string& steady_name(int i) const { return steady_names_[static_cast<size_t>(i)]; }
  /// All memory after one sample of every block, nothing delayed, sensors as in `sample`. May throw ComputationError.
  VectorXd sample_all(const OperatingPoint& point);
  /// (sample_all - memory) / sample time, of the steady rows: zero where the samples repeat themselves.
  VectorXd calc_sample_rates(const OperatingPoint& point);
  /// Copies the held outputs into the queues.
  void fill_queues(VectorXd& memory) const;
  /// Coordinates of q as the files have them, and dims: "pin:1", "ball:qw", "boom:eta1".
  records::Signals name_positions() const;
  /// Returns true if the dof is an angle with a period of 2 pi.
  bool is_periodic(int i) const { return dofs_[static_cast<size_t>(i)].is_periodic; }
  /// Results of the last evaluate, for a Outputs.
  const SystemData& data() const { return *data_; }

 private:
  struct Dof {
    std::string name, dims;
    bool is_mode = false;
    bool is_periodic = false;
    double step = 0.1;
  };
  void add_hinge(int body);
  void add_modes(int body);
  void add_inputs();
  void add_outputs();
  void add_sampled();
  std::vector<bool> find_in_loop() const;
  /// Kinematics to accelerations and signals, as they are at the point.
  void compute(const OperatingPoint& point, const PlantInput* input, double value, VectorXd& u_dot);
  /// compute() and all signals. \return the motion there.
  Motion gather_signals(const OperatingPoint& point);
  void initialize_lags(OperatingPoint& point);
  VectorXd displace_tree(const VectorXd& q, const VectorXd& step) const;
  // Loops (plant_loops.cpp)
  bool has_loops() const { return !grip_.empty(); }
  void choose_independent(double t, const VectorXd& q);
  void add_dofs();
  MatrixXd calc_follow() const;
  MatrixXd calc_position_follow(const OperatingPoint& point) const;
  VectorXd expand_positions(const VectorXd& delta, const VectorXd& paths) const;
  void close_positions(VectorXd& q) const;
  void close_rates(Eigen::Ref<MatrixXd> rates) const;

  const System& system_;
  std::unique_ptr<SystemData> data_;
  std::unique_ptr<LawTangents> tangents_;
  std::vector<Dof> dofs_;
  bool is_open_ = false;
  std::vector<int> rows_;        ///< of u, one for each dof
  std::vector<int> state_rows_;  ///< of z
  std::vector<PlantInput> inputs_;
  int num_forces_ = 0, num_actuators_ = 0;
  records::Signals outputs_;
  int num_sensor_outputs_ = 0;
  std::vector<int> sampled_rows_;
  std::vector<std::string> sampled_names_;
  std::vector<Queue> queues_;
  std::vector<bool> is_felt_;  ///< by place: the motion depends on it, now or after samples
  std::vector<int> steady_rows_;
  std::vector<std::string> steady_names_;
  std::vector<double> steady_period_;
  std::vector<AssemblyPriority> grip_;           ///< by row of u, where loops are closed: rates that follow are Free
  std::vector<AssemblyPriority> position_grip_;  ///< likewise of positions
  std::vector<Dof> paths_;                       ///< displacements that are free, with rates that follow
  std::vector<int> path_rows_;                   ///< of u
  double t_ = 0;                                 ///< of the last point
};

}  // namespace bough::solver
