#include "solver/hinges/screw.hpp"

namespace bough::solver {

void ScrewHinge::calc_position(const double* q, HingeMotion& motion) const {
  motion.R_HpHc = Eigen::AngleAxisd(q[0], axis_).toRotationMatrix();
  motion.p_HpHc = pitch_ * q[0] * axis_;
  motion.H.col(0) << pitch_ * axis_, axis_;
}

}  // namespace bough::solver
