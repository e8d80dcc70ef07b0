#include "solver/hinges/prismatic.hpp"

namespace bough::solver {

void PrismaticHinge::calc_position(const double* q, HingeMotion& motion) const {
  motion.p_HpHc = q[0] * axis_;
  motion.H.col(0).head<3>() = axis_;
}

}  // namespace bough::solver
