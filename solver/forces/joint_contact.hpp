#pragma once
/// \file Joint contact of a hinge coordinate: dry friction (stick-slip) and rigid stops.
#include <limits>
#include <string>

namespace bough::solver {

struct JointContact {
  std::string name;  ///< "coordinate 1 of hinge 'slide'"
  int q_row = 0, u_row = 0;
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
  double restitution = 0;      ///< of its stops: speed after over speed before
  double static_friction = 0;  ///< that holds it at rest; 0: none
  bool is_loaded = false;      ///< friction by bearing load adds to it: TreeData::friction_limit
  /// Returns true if dry friction may hold the coordinate.
  bool has_friction() const { return static_friction > 0 || is_loaded; }
};

}  // namespace bough::solver
