#pragma once
/// \file Parts of the second route (dense_route.hpp): kinematics, inertia and constraints; forces; signals.
#include <array>
#include <map>
#include <string>
#include <vector>

#include "tests/solver/support/dense_route.hpp"
#include "tests/solver/support/time_series.hpp"

namespace bough::solver::testing::dense_route {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/// Motion of all bodies: poses in W, and η.
struct Motion {
  std::vector<Pose> X;
  std::vector<Series<Eigen::Dynamic, 1>> eta;
};

/// Generalized forces and power of what acts at the state of a Route.
struct Acting {
  VectorXd force;         ///< num_u
  double power = 0;       ///< of all but springs, dampers and gravity
  double dissipated = 0;  ///< by dampers
};

inline bool has_quaternion(records::HingeType type) {
  return type == records::HingeType::Spherical || type == records::HingeType::Free;
}

/// d/ds f(s) at 0, exact for polynomials of degree 8.
template <class F>
auto differentiate(const F& f, double h) -> decltype(f(h)) {
  const double weight[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  auto sum = decltype(f(h))(weight[0] * (f(h) - f(-h)));
  for (int k = 2; k <= 4; ++k) sum += weight[k - 1] * (f(k * h) - f(-k * h));
  return decltype(f(h))(sum / h);
}

/// y of a table at x: straight lines, or the cubic spline without a knot at the second and the last point but one.
double calc_table(const records::FunctionRecord& table, double x);
/// Mass matrix about Bo of what is in a tank: sums over discs.
Matrix6d calc_content(const records::TankRecord& tank, const records::BodyRecord& body, double mass);
/// Mass matrix of a rigid body about Bo.
Matrix6d make_rigid_mass(double mass, const Vector3d& cg, const Matrix3d& inertia);

class Route {
 public:
  Route(const records::SystemSpec& spec, const std::map<std::string, records::FlexBody>& flex, const System& system,
        const DiscreteState& discrete, const History& history, double t, const VectorXd& x);
  DenseDerivative calc();

 private:
  const records::HingeRecord& get_hinge(int b) const { return spec_.hinges[static_cast<size_t>(b)]; }
  const records::BodyRecord& get_body(int b) const { return spec_.bodies[static_cast<size_t>(b)]; }
  int find_body(const std::string& name) const { return system_.find_body(name); }
  VectorXd get_eta(int b, const VectorXd& q) const { return q.segment(tree_[b].eta_offset(), tree_[b].num_modes()); }
  const records::FunctionRecord& find_function(const std::string& name) const;
  /// Value, rate, acceleration.
  Vector3d calc_function(const std::string& name) const;

  // Kinematics
  Pose calc_hinge(const records::HingeRecord& h, const double* q, const double* u, const double* a) const;
  /// Frame of a node in B.
  Pose calc_node(int b, int id, const Series<Eigen::Dynamic, 1>& eta) const;
  /// In W. b: -1 for ground.
  Pose calc_marker(int b, int id, const Vector3d& p, const Matrix3d& R, const Motion& poses) const;
  Pose calc_end(const records::EndRecord& end, const Motion& poses) const {
    return calc_marker(find_body(end.body), end.node, end.position, end.rotation, poses);
  }
  Motion calc_poses(const VectorXd& q, const VectorXd& u, const VectorXd& a) const;
  VectorXd displace(const VectorXd& q, int b, int i, double s) const;
  VectorXd calc_rates() const;

  // Inertia
  MatrixXd calc_mass(int b, const VectorXd& eta) const;
  /// [v; ω; η̇] in B, and its derivative.
  std::array<VectorXd, 2> calc_velocity(int b, const Motion& poses) const;
  void add_inertia(int b, const Motion& motion, LongMatrix& mass, LongVector& force, double& dissipated) const;
  void add_motors(LongMatrix& mass, LongVector& force) const;

  // Constraints
  /// First and second derivatives of what a constraint keeps constant.
  std::vector<Eigen::Vector2d> calc_rows(const records::ConstraintRecord& c, const ConstraintState& state,
                                         const Motion& poses) const;
  void calc_constraints(const Motion& motion, LongMatrix& G, LongVector& gamma) const;

  // Forces
  void add_forces(const Motion& motion, Acting& to) const;
  void add_hinge(int b, Acting& to) const;
  void add_hinge_law(int b, int i, Acting& to) const;
  /// Energy of the springs of a hinge.
  double calc_spring_energy(int b, const VectorXd& q) const;
  double calc_central_energy(const records::ForceElementRecord& field, const Motion& poses, const VectorXd& q) const;
  void add_central(const records::ForceElementRecord& field, Acting& to) const;
  void add_spring(const records::ForceElementRecord& element, const Motion& motion, Acting& to) const;
  void add_bushing(const records::ForceElementRecord& element, const Motion& motion, Acting& to) const;
  void add_contact(const records::ForceElementRecord& element, const Motion& motion, Acting& to) const;
  void add_drag(const records::ForceElementRecord& element, const Motion& motion, Acting& to) const;
  /// A force at the origin of a frame and a moment, in W. Returns their power.
  template <class Frame>
  double add_wrench(const Frame& get_frame, const Motion& motion, const Vector3d& f, const Vector3d& m,
                    VectorXd& to) const {
    const auto calc_power = [&](const Pose& X) {
      return f.dot(X.p.d1) + m.dot(get_axial(X.R.d1 * X.R.at.transpose()));
    };
    for (int i = 0; i < to.size(); ++i) to[i] += calc_power(get_frame(units_[static_cast<size_t>(i)]));
    return calc_power(get_frame(motion));
  }

  // Signals
  /// Rows of z, by controller and actuator; tanks from them.
  void lay_out_states();
  /// A signal now, or at a time of the history.
  double calc_signal(const std::string& name, int component = 0) const;
  VectorXd calc_sampled(const records::ControllerRecord& law, long last) const;
  Route at_sample(double time) const;
  VectorXd calc_inputs(const records::ControllerRecord& law) const;
  /// Command i of an actuator, shaped and lagged; ż of its lag.
  double calc_command(const records::ActuatorRecord& actuator, int row, int i, VectorXd& z_dot) const;
  void add_signals(const Motion& motion, Acting& to, VectorXd& z_dot) const;
  void add_actuator(size_t index, const Motion& motion, Acting& to, VectorXd& z_dot) const;
  void add_wheel(const records::ActuatorRecord& r, int row, double command, const Motion& motion, Acting& to,
                 VectorXd& z_dot) const;
  void add_gyro(const records::ActuatorRecord& r, int row, const Vector3d& rates, const Motion& motion, Acting& to,
                VectorXd& z_dot) const;
  void add_engine(const records::ActuatorRecord& r, int row, double thrust, const Motion& motion, Acting& to,
                  VectorXd& z_dot) const;
  /// Adds propellant that leaves a tank by a nozzle at `exit` in B. thrust: in W.
  void add_outflow(size_t tank, double flow, const Vector3d& exit, double radius, const Vector3d& axis,
                   const Vector3d& thrust, const Motion& motion, Acting& to, VectorXd& z_dot) const;
  /// Kinetic and potential energy of the body of a tank, as functions of its mass alone.
  double calc_tank_energy(size_t tank, double mass, const Motion& motion) const;

  const records::SystemSpec& spec_;
  const std::map<std::string, records::FlexBody>& flex_;
  const System& system_;
  const DiscreteState& discrete_;
  const History& history_;
  double t_;
  const Tree& tree_;
  VectorXd q_, u_, u_dot_, z_;
  std::vector<int> law_row_, actuator_row_;  ///< first rows in z
  std::vector<double> tank_mass_;
  std::vector<Motion> units_;  ///< motions of unit speeds
};

}  // namespace bough::solver::testing::dense_route
