#include "solver/forces/bushing.hpp"

#include <cmath>
#include <sstream>

namespace bough::solver {

namespace {

constexpr double kLargestTurn = 3.0;  // θ flips at π

Vector3d calc_rotation_vector(const Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  const double s = q.vec().norm(), sign = q.w() < 0 ? -1 : 1;
  if (s < 1e-8) return 2 * sign * q.vec();
  return sign * 2 * std::atan2(s, std::abs(q.w())) / s * q.vec();
}

}  // namespace

std::vector<ForceChannel> BushingElement::channels() const {
  return {{"displacement", 3, "position of the second end in the axes of the first", "L"},
          {"rotation", 3, "rotation vector of the second end from the first, in its axes", "1"},
          {"force", 3, "force on the second end, in the axes of the first", "F"},
          {"moment", 3, "moment on the second end, in the axes of the first", "F L"}};
}

ForceResult BushingElement::calc(const Tree& tree, const TreeData& data, Loads* loads) const {
  const MarkerInWorld a = calc_marker_in_world(data, tree, from_), b = calc_marker_in_world(data, tree, to_);
  const Vector3d d = b.place - a.place;
  Vector6d x, x_dot;
  x << a.R.transpose() * d, calc_rotation_vector(a.R.transpose() * b.R);
  const Vector3d theta = x.tail<3>();
  if (theta.norm() > kLargestTurn) {
    std::ostringstream what;
    what << "bushing '" << name() << "' is turned by more than 172 degrees at t = " << data.t;
    throw ComputationError(
        "solver.bushing-past-half-turn", at_, what.str(),
        "its moment follows the rotation vector, which flips at half a turn: use a hinge with springs "
        "where bodies turn further");
  }
  const Matrix3d T_inverse = calc_rotation_tangent(theta).inverse();
  x_dot << a.R.transpose() * (b.v - a.v - a.w.cross(d)), T_inverse * (a.R.transpose() * (b.w - a.w));

  const Vector6d elastic = K_ * x, damper = C_ * x_dot;
  const Vector6d along = -elastic - damper;
  const Vector3d f = along.head<3>(), t = T_inverse.transpose() * along.tail<3>();
  if (loads != nullptr) {
    const Vector3d f_W = a.R * f, t_W = a.R * t;
    loads->add_wrench(to_, f_W, t_W);
    loads->add_wrench(from_, -f_W, -t_W - d.cross(f_W));
  }
  ForceResult result;
  result.strain = 0.5 * x.dot(elastic);
  result.power = -elastic.dot(x_dot);
  result.dissipated = damper.dot(x_dot);
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<size_t>(i);
    result.values[at] = x[i];
    result.values[at + 3] = theta[i];
    result.values[at + 6] = f[i];
    result.values[at + 9] = t[i];
  }
  return result;
}

}  // namespace bough::solver
