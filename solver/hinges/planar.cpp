#include "solver/hinges/planar.hpp"

#include <cmath>

namespace bough::solver {

PlanarHinge::PlanarHinge(const Vector3d& unit_normal) : Hinge(3, 3), normal_(unit_normal) {
  const bool along_x = std::abs(normal_.x()) > 1 - 1e-6;
  const Vector3d guide = along_x ? Vector3d::UnitZ() : Vector3d::UnitX();
  e1_ = (guide - guide.dot(normal_) * normal_).normalized();
  e2_ = normal_.cross(e1_);
}

void PlanarHinge::calc_position(const double* q, HingeMotion& motion) const {
  motion.R_HpHc = Eigen::AngleAxisd(q[2], normal_).toRotationMatrix();
  motion.p_HpHc = q[0] * e1_ + q[1] * e2_;
  motion.H.col(0).head<3>() = e1_;
  motion.H.col(1).head<3>() = e2_;
  motion.H.col(2).tail<3>() = normal_;
}

}  // namespace bough::solver
