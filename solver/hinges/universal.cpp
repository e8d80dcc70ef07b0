#include "solver/hinges/universal.hpp"

namespace bough::solver {

void UniversalHinge::calc_position(const double* q, HingeMotion& motion) const {
  const Matrix3d R1 = Eigen::AngleAxisd(q[0], axis_).toRotationMatrix();
  const Vector3d axis2_Hp = R1 * axis2_;
  motion.R_HpHc = R1 * Eigen::AngleAxisd(q[1], axis2_).toRotationMatrix();
  motion.H.col(0).tail<3>() = axis_;
  motion.H.col(1).tail<3>() = axis2_Hp;
}

void UniversalHinge::calc_bias(const double* u, HingeMotion& motion) const {
  motion.bias.tail<3>() = u[0] * u[1] * axis_.cross(Vector3d(motion.H.col(1).tail<3>()));
}

}  // namespace bough::solver
