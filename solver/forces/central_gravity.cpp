#include "solver/forces/central_gravity.hpp"

#include <algorithm>
#include <cmath>

namespace bough::solver {

namespace {
// Acceleration by J2 at R from the centre; oblate = ½ μ J2 a².
Vector3d calc_oblate(double oblate, const Vector3d& R, const Vector3d& k) {
  const double r2 = R.squaredNorm(), r5 = r2 * r2 * std::sqrt(r2), z = R.dot(k);
  return -oblate / r5 * (6 * z * k - 15 * z * z / r2 * R + 3 * R);
}
}  // namespace

Matrix3d calc_second_moment(const Matrix3d& J) { return 0.5 * J.trace() * Matrix3d::Identity() - J; }

// Gravity on one body; all in B.
struct CentralGravity::Pull {
  Vector3d c;         // centre of mass from Bo
  Vector3d f;         // at the centre of mass
  Vector3d torque;    // about the centre of mass
  Matrix3d gradient;  // of the spherical field at the centre of mass
  double potential;
};

CentralGravity::Pull CentralGravity::calc_pull(const BodyData& d) const {
  const double m = d.inertia.mass, mu = field_.mu;
  const Vector3d& S = d.inertia.S;
  const Matrix3d J = d.inertia.M6.bottomRightCorner<3, 3>();
  Pull pull;
  pull.c = S / m;
  const Matrix3d P = calc_second_moment(J) - S * pull.c.transpose();
  const Matrix3d& R_WB = d.state.R_WB;
  const Vector3d R = R_WB.transpose() * (d.state.p_WBo - field_.centre) + pull.c;
  const Vector3d k = R_WB.transpose() * field_.axis;
  const double r2 = R.squaredNorm(), r = std::sqrt(r2), r3 = r * r2, r5 = r3 * r2;
  const Vector3d PR = P * R;
  const double RPR = R.dot(PR), trace = P.trace(), z = R.dot(k);
  const double oblate = 0.5 * mu * field_.j2 * field_.equator * field_.equator;
  pull.f = -mu * m / r3 * R;
  pull.f += 0.5 * mu * (6 * PR - 15 * RPR / r2 * R + 3 * trace * R) / r5;
  pull.f += m * calc_oblate(oblate, R, k);
  pull.torque = -3 * mu / r5 * R.cross(PR);
  pull.gradient = mu / r5 * (3 * R * R.transpose() - r2 * Matrix3d::Identity());
  pull.potential = -mu * m / r - 0.5 * mu * (3 * RPR / r5 - trace / r3) + oblate * m / r3 * (3 * z * z / r2 - 1);
  return pull;
}

ForceResult CentralGravity::calc(const Tree& tree, const TreeData& data, Loads* loads) const {
  ForceResult result;
  for (const int b : bodies_) {
    const TreeBody& tb = tree[b];
    const BodyData& d = data[b];
    const double m = d.inertia.mass;
    if (!(m > 0)) continue;
    const Pull pull = calc_pull(d);
    result.potential += pull.potential;
    result.power += pull.f.dot(d.state.v_B + d.state.w_B.cross(pull.c)) + pull.torque.dot(d.state.w_B);
    if (loads != nullptr) loads->add_to_body(b, pull.f, pull.torque + pull.c.cross(pull.f));
    if (!tb.is_flexible()) continue;
    // -∂V/∂η_j = f·S_j/m + ½ gradient : ∂P/∂η_j, S_j = ∂S/∂η_j.
    const LinearField field = tb.body.make_linear_field(pull.gradient, d.inertia);
    const Vector3d at_Bo = pull.f / m - pull.gradient * pull.c;
    for (int j = 0; j < tb.num_modes(); ++j) {
      const double on_mode =
          at_Bo.dot(d.inertia.M_top.col(j).head<3>()) + tb.body.calc_modal_force(field, d.inertia, j);
      result.power += on_mode * data.u[tb.eta_dot_offset() + j];
      if (loads != nullptr) loads->add_to_mode(b, j, on_mode);
    }
  }
  return result;
}

bool CentralGravity::attracts(int body) const {
  return std::find(bodies_.begin(), bodies_.end(), body) != bodies_.end();
}

Vector3d CentralGravity::calc_acceleration(const Vector3d& p_W) const {
  const Vector3d R = p_W - field_.centre;
  const double r2 = R.squaredNorm();
  return -field_.mu / (r2 * std::sqrt(r2)) * R +
         calc_oblate(0.5 * field_.mu * field_.j2 * field_.equator * field_.equator, R, field_.axis);
}

Vector3d CentralGravity::calc_magnetic_field(const Vector3d& p_W) const {
  const Vector3d R = p_W - field_.centre;
  const double r2 = R.squaredNorm();
  return (3 * field_.dipole.dot(R) / r2 * R - field_.dipole) / (r2 * std::sqrt(r2));
}

BodyGravity CentralGravity::calc_on_body(const TreeData& data, int body) const {
  const Pull pull = calc_pull(data[body]);
  return {pull.f / data[body].inertia.mass - pull.gradient * pull.c, pull.gradient};
}

// With P = P_o - S Sᵀ/m, P_o about Bo: dc = (S' - c)/m, dP = P_o' - S' cᵀ - c S'ᵀ + c cᵀ.
double CentralGravity::calc_potential_rate(const BodyData& d, const TankContent& by) const {
  const Pull pull = calc_pull(d);
  const Vector3d& c = pull.c;
  const Vector3d dc = (by.S_m - c) / d.inertia.mass;
  const Matrix3d dP = calc_second_moment(by.J_m) - by.S_m * c.transpose() - c * by.S_m.transpose() + c * c.transpose();
  const Vector3d R = d.state.R_WB.transpose() * (d.state.p_WBo - field_.centre) + c;
  const double r2 = R.squaredNorm(), r = std::sqrt(r2), r3 = r * r2, z = R.dot(d.state.R_WB.transpose() * field_.axis);
  const double oblate = 0.5 * field_.mu * field_.j2 * field_.equator * field_.equator;
  const double by_mass = -field_.mu / r + oblate / r3 * (3 * z * z / r2 - 1);
  const double by_P = -0.5 * field_.mu / r3 * (3 * R.dot(dP * R) / r2 - dP.trace());
  return by_mass + by_P - pull.f.dot(dc);
}

}  // namespace bough::solver
