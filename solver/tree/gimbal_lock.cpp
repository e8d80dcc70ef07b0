#include "solver/tree/gimbal_lock.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

namespace bough::solver {

NearestAxes find_nearest_axes(const TreeBody& tb, const BodyData& d) {
  NearestAxes nearest;
  if (!tb.hinge->has_independent_coordinates()) return nearest;
  const int n = tb.num_hinge_u();
  const auto turns = [&](int i) { return d.hinge.H.col(i).tail<3>().squaredNorm() > 0; };
  int num_angles = 0;
  for (int i = 0; i < n; ++i) num_angles += turns(i) ? 1 : 0;
  if (num_angles < 3) return nearest;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (!turns(i) || !turns(j)) continue;
      const Vector3d a = d.hinge.H.col(i).tail<3>().normalized(), b = d.hinge.H.col(j).tail<3>().normalized();
      const double sine = a.cross(b).norm();
      if (sine < nearest.sine || nearest.first < 0) nearest = {i, j, sine};
    }
  }
  return nearest;
}

std::string describe_gimbal_lock(const TreeBody& tb, const BodyData& d, double sine) {
  const NearestAxes axes = find_nearest_axes(tb, d);
  if (axes.first < 0 || axes.sine > sine) return {};
  std::ostringstream what;
  what.precision(2);
  what << "gimbal lock: the axes of coordinates " << axes.first + 1 << " and " << axes.second + 1 << " of hinge '"
       << tb.hinge_name << "' have come within " << std::asin(axes.sine) * 180 / std::numbers::pi
       << " degrees of each other";
  for (int i = axes.first + 1; i < axes.second; ++i) what << ", by its coordinate " << i + 1;
  return what.str();
}

GimbalLock find_gimbal_lock(const Tree& tree, const TreeData& data, double sine) {
  for (int b = 0; b < tree.size(); ++b) {
    std::string lock = describe_gimbal_lock(tree[b], data[b], sine);
    if (!lock.empty()) return {b, std::move(lock)};
  }
  return {};
}

}  // namespace bough::solver
