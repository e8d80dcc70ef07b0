#include "solver/hinges/cylindrical.hpp"

namespace bough::solver {

void CylindricalHinge::calc_position(const double* q, HingeMotion& motion) const {
  motion.R_HpHc = Eigen::AngleAxisd(q[0], axis_).toRotationMatrix();
  motion.p_HpHc = q[1] * axis_;
  motion.H.col(0).tail<3>() = axis_;
  motion.H.col(1).head<3>() = axis_;
}

}  // namespace bough::solver
