#include <algorithm>

#include "base/rotation.hpp"
#include "formats/sid/sid.hpp"

namespace bough::sid {

namespace {

using Eigen::Matrix3d;

double calc_difference(const MatrixXd& a, const MatrixXd& b) {
  if (a.size() == 0) return 0;
  const double largest = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  return largest > 0 ? (a - b).cwiseAbs().maxCoeff() / largest : 0;
}

Matrix3d unpack_inertia(const MatrixXd& J) {
  if (J.cols() == 3) return J;
  Matrix3d full;
  full << J(0), J(3), J(4), J(3), J(1), J(5), J(4), J(5), J(2);
  return full;
}

}  // namespace

Relations calc_relations(const Sid& sid) {
  Relations r;
  const int n = sid.num_modes();
  if (n == 0) return r;
  MatrixXd first_moment = MatrixXd::Zero(3, n), inertia(6, n), gyroscopic(6, n), centrifugal(6, n);
  MatrixXd by_mode(n, 3 * n), by_component(n, 3 * n);
  for (int j = 0; j < n; ++j) {
    const auto s = static_cast<std::size_t>(j);
    if (!sid.mdCM.m1.empty()) first_moment.col(j) = sid.mdCM.m1[s];
    const Matrix3d J = sid.J.m1.empty() ? Matrix3d::Zero() : unpack_inertia(sid.J.m1[s]);
    const Matrix3d G = sid.Gr.m0.middleCols(3 * j, 3), H = 0.5 * (G + G.transpose());
    inertia.col(j) << J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(1, 2), J(0, 2);
    gyroscopic.col(j) << H(0, 0), H(1, 1), H(2, 2), H(0, 1), H(1, 2), H(0, 2);
    centrifugal.col(j) = inertia.col(j).cwiseProduct(-Eigen::Matrix<double, 6, 1>(0.5, 0.5, 0.5, 1, 1, 1));
    for (int i = 0; i < n; ++i) {
      for (int a = 0; a < 3; ++a) {
        const double value = sid.Cr.m1.empty() ? 0 : sid.Cr.m1[s](i, a) - sid.Cr.m1[static_cast<std::size_t>(i)](j, a);
        by_mode(i, 3 * j + a) = by_component(i, a * n + j) = value;
      }
    }
  }
  r.mdCM_Ct = calc_difference(first_moment, sid.Ct.m0.transpose());
  r.Gr_J = calc_difference(gyroscopic, inertia);
  r.Oe_J = calc_difference(sid.Oe.m0.transpose(), centrifugal);
  const double of_mode = calc_difference(sid.Ge.m0, by_mode), of_component = calc_difference(sid.Ge.m0, by_component);
  r.by_component = of_component < of_mode;
  r.Ge_Cr = std::min(of_mode, of_component);
  for (const auto& node : sid.nodes) {
    for (int q = 0; q < n; ++q) {
      const auto s = static_cast<std::size_t>(q);
      const Matrix3d turn = skew(Eigen::Vector3d(node.psi.m0.col(q)));
      r.AP_psi = std::max(r.AP_psi, calc_difference(node.AP.m1.empty() ? MatrixXd::Zero(3, 3) : node.AP.m1[s], turn));
      r.origin_phi = std::max(
          r.origin_phi,
          calc_difference(node.origin.m1.empty() ? MatrixXd::Zero(3, 1) : node.origin.m1[s], node.phi.m0.col(q)));
    }
  }
  return r;
}

}  // namespace bough::sid
