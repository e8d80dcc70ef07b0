#pragma once
/// \file The state of a system. Rows never change their meaning: a hinge coordinate keeps its rows in q and u whether
/// it is free, locked or prescribed, so that locking and releasing one moves nothing else.
#include <vector>

#include <Eigen/Dense>

namespace bough::solver {

using Eigen::VectorXd;

/// Mode of a hinge coordinate: moved by the equations of motion; locked (rate zero); prescribed by a function.
enum class HingeMode : unsigned char { Free, Locked, Prescribed };

/// State of a constraint: closed or open, and its position error when it was closed in the run.
struct ConstraintState {
  bool is_closed = true;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< the child's frame that the constraint sees, in Hc
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector2d gap = Eigen::Vector2d::Zero();  ///< what is kept of the residual of one that is no hinge
  VectorXd q;                                     ///< coordinates of the closing hinge
};

/// Discrete state, which changes at instants only.
struct DiscreteState {
  std::vector<HingeMode> mode;               ///< num_u, by row of u; modal rows are Free
  std::vector<ConstraintState> constraints;  ///< one per constraint; empty: as they were
  VectorXd memory;                           ///< discrete state of controllers, sensors and actuators
  int variant = -1;                          ///< of the fill levels of bodies (System::variants); -1: as it was
  VectorXd slide;  ///< num_u: -1, 1 is the direction in which a coordinate with dry friction slides; empty: as it was
};

/// Rows of the continuous state x = [q; u; z; work; dissipated].
///
/// q: rows of prescribed coordinates are those of their functions. u: likewise; zero where locked. z: of controllers,
/// actuators and sensors. work: done since the start by what is applied, damped or prescribed; dissipated: taken by
/// dampers.
struct StateLayout {
  int num_q = 0, num_u = 0, num_z = 0;
  /// Number of rows of x.
  int size() const { return num_q + num_u + num_z + 2; }
  /// Row of the work.
  int work() const { return num_q + num_u + num_z; }
  /// Row of the dissipated work.
  int dissipated() const { return work() + 1; }
};

/// Segments of x.
template <class X>
auto get_q(const StateLayout& layout, X&& x) {
  return x.head(layout.num_q);
}
template <class X>
auto get_u(const StateLayout& layout, X&& x) {
  return x.segment(layout.num_q, layout.num_u);
}
template <class X>
auto get_z(const StateLayout& layout, X&& x) {
  return x.segment(layout.num_q + layout.num_u, layout.num_z);
}

/// Everything that an evaluation depends on.
struct State {
  double t = 0;
  VectorXd x;  ///< StateLayout
  DiscreteState discrete;
};

}  // namespace bough::solver
