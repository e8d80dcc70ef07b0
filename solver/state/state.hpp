#pragma once
/// \file The state of a system. Rows never change their meaning: a hinge coordinate keeps its rows in q and u whether
/// it is free, locked or prescribed, so that locking and releasing one moves nothing else.
#include <vector>

#include <Eigen/Dense>

namespace bough::solver {

using Eigen::VectorXd;

/// What a hinge coordinate does: moves as the equations say; keeps its place (its rate is zero); follows a function.
enum class HingeMode : unsigned char { Free, Locked, Prescribed };

/// A constraint as it stands: closed or open, and how it was found when it was closed in the run.
struct Closing {
  bool is_closed = true;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< the child's frame that the constraint sees, in Hc
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector2d gap = Eigen::Vector2d::Zero();  ///< what is kept of the residual of one that is no hinge
  VectorXd q;                                     ///< coordinates of the closing hinge
};

/// What changes at instants only.
struct Discrete {
  std::vector<HingeMode> mode;    ///< num_u, by row of u; modal rows are Free
  std::vector<Closing> closings;  ///< one per constraint; empty: as they were
  VectorXd memory;  ///< of controllers, sensors and actuators: what they hold between samples and switches
};

struct State {
  double t = 0;
  VectorXd q;  ///< num_q; rows of prescribed coordinates are those of their functions
  VectorXd u;  ///< num_u; likewise; zero where locked
  VectorXd z;  ///< states of controllers
  Discrete discrete;
  double work = 0;  ///< done since the start by what is applied, damped or prescribed
};

}  // namespace bough::solver
