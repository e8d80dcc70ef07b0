#include "solver/hinges/revolute.hpp"

namespace bough::solver {

void RevoluteHinge::calc_position(const double* q, HingeMotion& motion) const {
  motion.R_HpHc = Eigen::AngleAxisd(q[0], axis_).toRotationMatrix();
  motion.H.col(0).tail<3>() = axis_;
}

}  // namespace bough::solver
