#pragma once
/// \file [[orbit]] of a system file: a reference orbit, whose LVLH frame is a parent of hinges.
#include <string>

#include <Eigen/Dense>

#include "base/diagnostic.hpp"

namespace bough::records {

/// Two-body orbit about a gravity_central, given at the start of the run by elements, by position and velocity, or by
/// those of a body.
struct OrbitRecord {
  std::string name, planet;
  std::string body;            ///< its initial position and velocity; empty: given here
  bool has_state = false;      ///< position and velocity are given
  double semi_major_axis = 0;  ///< L
  double eccentricity = 0;     ///< below 1
  double inclination = 0;      ///< rad; inertial axes
  double ascending_node = 0;   ///< rad
  double periapsis = 0;        ///< rad; argument
  double true_anomaly = 0;     ///< rad
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), velocity = position;  ///< inertial
  SourceLocation at;
};

}  // namespace bough::records
