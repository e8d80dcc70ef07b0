#pragma once
/// \file Two angles of a hinge about one axis: the hinge loses a direction, rates and forces along it go to infinity.
#include <string>

#include "solver/tree/data.hpp"

namespace bough::solver {

/// The two axes of a hinge with three angles or more (a gimbal) that are nearest to each other.
struct NearestAxes {
  int first = -1, second = -1;  ///< columns of H; -1: there are no three angles
  double sine = 1;              ///< of the angle between them
};
/// After Stage::Position.
NearestAxes find_nearest_axes(const TreeBody& tb, const BodyData& d);

/// "gimbal lock: the axes of coordinates 1 and 3 of hinge 'h' have come within 0.01 degrees of each other, by its
/// coordinate 2"; empty if they are farther apart than `sine`.
std::string describe_gimbal_lock(const TreeBody& tb, const BodyData& d, double sine);
/// The first hinge of the tree in gimbal lock, with its message; `lock.empty()`: none.
struct GimbalLock {
  int body = -1;
  std::string lock;
};
/// Checks each hinge at the present position. \param sine  largest sine of the angle between axes that counts as
/// locked.
GimbalLock find_gimbal_lock(const Tree& tree, const TreeData& data, double sine);

inline constexpr const char* kGimbalAdvice =
    "use a hinge with a quaternion (rotations = \"q\"), or another order of rotations, which locks elsewhere";

}  // namespace bough::solver
