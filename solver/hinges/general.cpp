#include "solver/hinges/general.hpp"

namespace bough::solver {

namespace {
Vector3d get_axis(char letter) { return Vector3d::Unit(letter - 'x'); }
int get_size(const std::string& letters) { return static_cast<int>(letters.size()); }
}  // namespace

GeneralHinge::GeneralHinge(const std::string& rotations, const std::string& translations)
    : Hinge(get_size(rotations + translations), get_size(rotations + translations)),
      rotations_(rotations),
      translations_(translations) {}

void GeneralHinge::calc_position(const double* q, HingeMotion& motion) const {
  Matrix3d R = Matrix3d::Identity();
  int i = 0;
  for (const char axis : rotations_) {
    motion.H.col(i).tail<3>() = R * get_axis(axis);
    R *= Eigen::AngleAxisd(q[i++], get_axis(axis)).toRotationMatrix();
  }
  motion.R_HpHc = R;
  motion.p_HpHc.setZero();
  for (const char axis : translations_) {
    motion.p_HpHc += q[i] * get_axis(axis);
    motion.H.col(i++).head<3>() = get_axis(axis);
  }
}

void GeneralHinge::calc_bias(const double* u, HingeMotion& motion) const {
  motion.bias.setZero();
  const int num = get_size(rotations_);
  for (int i = 0; i < num; ++i) {
    for (int j = i + 1; j < num; ++j)
      motion.bias.tail<3>() +=
          u[i] * u[j] * Vector3d(motion.H.col(i).tail<3>()).cross(Vector3d(motion.H.col(j).tail<3>()));
  }
}

OrientedHinge::OrientedHinge(const std::string& translations)
    : SphericalHinge(4 + get_size(translations), 3 + get_size(translations)), translations_(translations) {}

void OrientedHinge::calc_position(const double* q, HingeMotion& motion) const {
  SphericalHinge::calc_position(q, motion);
  motion.p_HpHc.setZero();
  for (int i = 0; i < num_travels(); ++i) {
    const Vector3d axis = get_axis(translations_[static_cast<size_t>(i)]);
    motion.p_HpHc += q[4 + i] * axis;
    motion.H.col(3 + i).head<3>() = axis;
  }
}

void OrientedHinge::calc_q_dot(const double* q, const double* u, double* q_dot) const {
  SphericalHinge::calc_q_dot(q, u, q_dot);
  for (int i = 0; i < num_travels(); ++i) q_dot[4 + i] = u[3 + i];
}

double OrientedHinge::calc_spring(const double* q, const double* q_null, const double* k, double* force) const {
  double energy = SphericalHinge::calc_spring(q, q_null, k, force);
  for (int i = 0; i < num_travels(); ++i) {
    const double stretch = q[4 + i] - q_null[4 + i];
    force[3 + i] = -k[3 + i] * stretch;
    energy += 0.5 * k[3 + i] * stretch * stretch;
  }
  return energy;
}

}  // namespace bough::solver
