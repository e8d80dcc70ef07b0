#include "modal/compare/integrals_check.hpp"

#include <cmath>
#include <limits>

#include "base/rotation.hpp"

namespace bough::modal {

using Eigen::Index;
using records::FlexBody;
using records::MassIntegrals;

namespace {
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr int kExact = 2;
}  // namespace

const MassIntegrals& get_method(const FlexBody& body, int method) {
  return method == 0 ? body.lumped : method == 1 ? body.consistent : body.exact;
}

MatrixXd calc_integral_norms(const MassIntegrals& set) {
  const Index n = set.gamma0.cols();
  MatrixXd norm = MatrixXd::Zero(n, kNumIntegrals);
  for (Index j = 0; j < n; ++j) {
    const auto s = static_cast<std::size_t>(j);
    double four = 0;
    for (const auto& g : set.gamma4[s]) four += g.squaredNorm();
    norm.row(j) << set.gamma0.col(j).norm(), set.gamma1.col(j).norm(), set.gamma2[s].norm(), set.gamma3[s].norm(),
        std::sqrt(four);
  }
  return norm;
}

MatrixXd calc_integral_scale(const FlexBody& body) {
  const Index n = body.num_modes();
  MatrixXd scale(n, kNumIntegrals);
  const double inertia = std::sqrt(body.inertia.trace()), mass = std::sqrt(body.mass);
  const double modes = std::sqrt(body.modal_mass.trace());
  for (Index j = 0; j < n; ++j)
    scale.row(j) = std::sqrt(body.modal_mass(j, j)) *
                   (Eigen::RowVectorXd(kNumIntegrals) << mass, inertia, modes, inertia, modes).finished();
  return scale;
}

MatrixXd calc_integral_differences(const MassIntegrals& a, const MassIntegrals& b, const MatrixXd& largest) {
  constexpr double kFloor = 1e-9;
  const Index n = a.gamma0.cols();
  const MatrixXd size = calc_integral_norms(a).cwiseMax(calc_integral_norms(b));
  MassIntegrals d = a;
  d.gamma0 -= b.gamma0;
  d.gamma1 -= b.gamma1;
  for (std::size_t j = 0; j < d.gamma2.size(); ++j) {
    d.gamma2[j] -= b.gamma2[j];
    d.gamma3[j] -= b.gamma3[j];
    for (std::size_t k = 0; k < d.gamma4[j].size(); ++k) d.gamma4[j][k] -= b.gamma4[j][k];
  }
  MatrixXd difference = calc_integral_norms(d);
  for (Index j = 0; j < n; ++j)
    for (int k = 0; k < kNumIntegrals; ++k)
      difference(j, k) = size(j, k) > kFloor * largest(j, k) ? difference(j, k) / size(j, k) : kNothing;
  return difference;
}

Captured calc_captured(const FlexBody& body, const MassIntegrals& set) {
  const Index n = body.num_modes();
  Captured captured;
  captured.fraction.resize(n, 6);
  captured.rigid.topLeftCorner(3, 3) = body.mass * Eigen::Matrix3d::Identity();
  captured.rigid.bottomLeftCorner(3, 3) = body.mass * skew(body.cg);
  captured.rigid.topRightCorner(3, 3) = captured.rigid.bottomLeftCorner(3, 3).transpose();
  captured.rigid.bottomRightCorner(3, 3) = body.inertia;
  if (n == 0) return captured;
  MatrixXd L(6, n);
  L << set.gamma0, set.gamma1;
  // With M = C Cᵀ the first j columns of L C⁻ᵀ are what the first j modes add, one after the other.
  const Eigen::LLT<MatrixXd> factor(body.modal_mass);
  if (factor.info() != Eigen::Success) {
    captured.fraction.setConstant(kNothing);
    return captured;
  }
  const MatrixXd shares = factor.matrixL().solve(L.transpose()).transpose();
  captured.total = shares * shares.transpose();
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  for (Index j = 0; j < n; ++j) {
    sum += shares.col(j).cwiseAbs2();
    for (int a = 0; a < 6; ++a) {
      const double whole = captured.rigid(a, a);
      captured.fraction(j, a) = whole > 0 ? sum[a] / whole : kNothing;
    }
  }
  return captured;
}

IntegralsCheck check_integrals(const FlexBody& body) {
  IntegralsCheck check;
  if (body.exact.empty()) return check;
  const MatrixXd scale = calc_integral_scale(body);
  for (int m = 0; m < kNumMethods; ++m) {
    const auto& set = get_method(body, m);
    const auto s = static_cast<std::size_t>(m);
    check.has[s] = !set.empty();
    if (set.empty()) continue;
    check.norm[s] = calc_integral_norms(set);
    check.difference[s] = calc_integral_differences(set, get_method(body, kExact), scale);
    check.captured[s] = calc_captured(body, set);
  }
  return check;
}

}  // namespace bough::modal
