#include "solver/hinges/hinge.hpp"

#include <algorithm>

namespace bough::solver {

void Hinge::calc_q_dot(const double*, const double* u, double* q_dot) const { std::copy_n(u, num_u_, q_dot); }

void Hinge::set_neutral(double* q) const { std::fill_n(q, num_q_, 0.0); }

void Hinge::set_from_file(const double* file, double* q) const { std::copy_n(file, num_q_, q); }

void Hinge::get_for_file(const double* q, double* file) const { std::copy_n(q, num_q_, file); }

double Hinge::calc_spring(const double* q, const double* q_null, const double* k, double* force) const {
  double energy = 0;
  for (int i = 0; i < num_u_; ++i) {
    const double stretch = q[i] - q_null[i];
    force[i] = -k[i] * stretch;
    energy += 0.5 * k[i] * stretch * stretch;
  }
  return energy;
}

}  // namespace bough::solver
