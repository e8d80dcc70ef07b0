#include "solver/hinges/free.hpp"

namespace bough::solver {

void FreeHinge::calc_position(const double* q, HingeMotion& motion) const {
  SphericalHinge::calc_position(q, motion);
  motion.p_HpHc = Vector3d(q[4], q[5], q[6]);
  motion.H.block<3, 3>(0, 3).setIdentity();
}

void FreeHinge::calc_q_dot(const double* q, const double* u, double* q_dot) const {
  SphericalHinge::calc_q_dot(q, u, q_dot);
  for (int i = 0; i < 3; ++i) q_dot[4 + i] = u[3 + i];
}

double FreeHinge::calc_spring(const double* q, const double* q_null, const double* k, double* force) const {
  double energy = SphericalHinge::calc_spring(q, q_null, k, force);
  for (int i = 0; i < 3; ++i) {
    const double stretch = q[4 + i] - q_null[4 + i];
    force[3 + i] = -k[3 + i] * stretch;
    energy += 0.5 * k[3 + i] * stretch * stretch;
  }
  return energy;
}

}  // namespace bough::solver
