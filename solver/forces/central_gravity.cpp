#include "solver/forces/central_gravity.hpp"

#include <cmath>

namespace bough::solver {

Matrix3d calc_second_moment(const Matrix3d& J) { return 0.5 * J.trace() * Matrix3d::Identity() - J; }

ForceResult CentralGravity::calc(const Tree& tree, const TreeData& data, Loads* loads) const {
  ForceResult result;
  const double mu = field_.mu;
  for (const Attracted& one : bodies_) {
    const TreeBody& tb = tree[one.body];
    const BodyData& d = data[one.body];
    const int n = tb.num_modes();
    const double m = tb.body.mass();
    if (!(m > 0)) continue;
    const auto eta = data.q.segment(tb.eta_offset(), n);
    const Vector3d S = n > 0 ? d.inertia.S : tb.body.first_moment();
    const Vector3d c = S / m;
    Matrix3d P = one.P0;
    for (int j = 0; j < n; ++j) P += eta[j] * one.P1[static_cast<size_t>(j)];
    P -= S * c.transpose();

    // In B
    const Matrix3d& R_WB = d.state.R_WB;
    const Vector3d R = R_WB.transpose() * (d.state.p_WBo - field_.centre) + c;
    const Vector3d k = R_WB.transpose() * field_.axis;
    const double r2 = R.squaredNorm(), r = std::sqrt(r2), r3 = r * r2, r5 = r3 * r2;
    const Vector3d PR = P * R;
    const double RPR = R.dot(PR), trace = P.trace(), z = R.dot(k);
    const double oblate = 0.5 * mu * m * field_.j2 * field_.equator * field_.equator;

    Vector3d f = -mu * m / r3 * R;
    f += 0.5 * mu * (6 * PR - 15 * RPR / r2 * R + 3 * trace * R) / r5;
    f -= oblate / r5 * (6 * z * k - 15 * z * z / r2 * R + 3 * R);
    const Vector3d torque = -3 * mu / r5 * R.cross(PR);  // about the mass centre
    result.potential += -mu * m / r - 0.5 * mu * (3 * RPR / r5 - trace / r3) + oblate / r3 * (3 * z * z / r2 - 1);
    result.power += f.dot(d.state.v_B + d.state.w_B.cross(c)) + torque.dot(d.state.w_B);
    const Vector3d about_Bo = torque + c.cross(f);
    if (loads != nullptr) loads->add_to_body(one.body, f, about_Bo);
    for (int j = 0; j < n; ++j) {
      const Vector3d S_j = d.inertia.M_top.col(j).head<3>();
      const Matrix3d P_j = one.P1[static_cast<size_t>(j)] - S_j * c.transpose() - c * S_j.transpose();
      const double on_mode = f.dot(S_j) / m + 0.5 * mu * (3 * R.dot(P_j * R) / r5 - P_j.trace() / r3);
      result.power += on_mode * data.u[tb.eta_dot_offset() + j];
      if (loads != nullptr) loads->add_to_mode(one.body, j, on_mode);
    }
  }
  return result;
}

}  // namespace bough::solver
