// The torque-free asymmetric top in closed form (Landau & Lifshitz, Mechanics, §37): rates by Jacobi's functions, the
// attitude by Euler's angles about the momentum, of which precession is an integral of them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "tests/solver/support/jacobi.hpp"
#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

class Top {
 public:
  static constexpr double J1 = 1, J2 = 2, J3 = 3;

  /// Starts with w2 = 0.
  Top(double w1, double w3)
      : M_(std::hypot(J1 * w1, J3 * w3)), E2_(J1 * w1 * w1 + J3 * w3 * w3), about_3_(M_ * M_ > E2_ * J2) {
    const double low = M_ * M_ - E2_ * J1, high = E2_ * J3 - M_ * M_;
    first_ = std::sqrt(high / (J1 * (J3 - J1)));
    third_ = std::sqrt(low / (J3 * (J3 - J1)));
    double k2 = 0;
    if (about_3_) {
      second_ = std::sqrt(high / (J2 * (J3 - J2)));
      pace_ = std::sqrt((J3 - J2) * low / (J1 * J2 * J3));
      k2 = (J2 - J1) * high / ((J3 - J2) * low);
    } else {
      second_ = std::sqrt(low / (J2 * (J2 - J1)));
      pace_ = std::sqrt((J2 - J1) * high / (J1 * J2 * J3));
      k2 = (J3 - J2) * low / ((J2 - J1) * high);
    }
    k_ = std::sqrt(k2);
  }
  Vector3d rate(double t) const {
    const Jacobi j = calc_jacobi(pace_ * t, k_);
    return {first_ * (about_3_ ? j.cn : j.dn), second_ * j.sn, third_ * (about_3_ ? j.dn : j.cn)};
  }
  double period() const {
    double a = 1, b = std::sqrt(1 - k_ * k_);
    for (int i = 0; i < 12; ++i) std::tie(a, b) = std::make_pair(0.5 * (a + b), std::sqrt(a * b));
    return 2 * std::numbers::pi / a / pace_;
  }
  /// Attitude of the body in axes whose z is the momentum, precession 0 at t = 0: Rz(φ) Rx(θ) Rz(ψ).
  Matrix3d attitude(double t, double precession) const {
    const Vector3d m = Vector3d(J1, J2, J3).cwiseProduct(rate(t)) / M_;  // sin θ sin ψ, sin θ cos ψ, cos θ
    const double sine = std::hypot(m.x(), m.y());
    Matrix3d theta, psi;
    theta << 1, 0, 0, 0, m.z(), -sine, 0, sine, m.z();
    psi << m.y(), -m.x(), 0, m.x(), m.y(), 0, 0, 0, sine;
    return calc_rotation_exp(Vector3d(0, 0, precession)) * theta * psi / sine;
  }
  double precession_rate(double t) const {
    const Vector3d w = rate(t);
    const double x = J1 * w.x(), y = J2 * w.y();
    return M_ * (x * w.x() + y * w.y()) / (x * x + y * y);
  }

 private:
  double M_, E2_;
  bool about_3_;
  double first_, second_ = 0, third_, pace_ = 0, k_ = 0;
};

/// ∫ f from a to b, Gauss's five points in each of `parts`.
template <class F>
double integrate(const F& f, double a, double b, int parts) {
  const double x[] = {0, 0.5384693101056831, 0.9061798459386640};
  const double w[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double h = (b - a) / parts / 2;
  double sum = 0;
  for (int p = 0; p < parts; ++p) {
    const double middle = a + (2 * p + 1) * h;
    sum += w[0] * f(middle);
    for (int i = 1; i < 3; ++i) sum += w[i] * (f(middle + x[i] * h) + f(middle - x[i] * h));
  }
  return sum * h;
}

// About the axis of largest and that of least inertia, and next to the separatrix: 1.5 periods or more.
TEST(AsymmetricTop, TurnsByJacobisFunctions) {
  for (const auto& [w1, w3] : {std::pair{0.4, 2.0}, {2.0, 0.3}, {1.7319, 1.0}, {1.7322, 1.0}}) {
    const Top top(w1, w3);
    auto spec = make_one_body(records::HingeType::Free);
    spec.bodies[0].inertia = Vector3d(Top::J1, Top::J2, Top::J3).asDiagonal();
    spec.hinges[0].position = {0.8, 0.2, -0.4, 0.4, 1, 2, 3};  // a quaternion of length 1
    spec.hinges[0].rate = {w1, 0, w3, 0.1, -0.2, 0.3};
    spec.simulation.duration = 1.5 * top.period();
    spec.simulation.output_step = spec.simulation.duration / 60;
    spec.simulation.integrator = "rk";
    spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-13;
    const MemorySink sink = run_kept(spec, 1e-11);
    const VectorXd t = sink.time();
    const MatrixXd w = sink.get("/hinges/hinge/qdot"), q = sink.get("/bodies/body/quaternion"),
                   p = sink.get("/bodies/body/position"), angular = sink.get("/momentum/angular");
    const auto R = [&](int i) { return Eigen::Quaterniond(q(i, 0), q(i, 1), q(i, 2), q(i, 3)).toRotationMatrix(); };
    const Matrix3d from_momentum = R(0) * top.attitude(0, 0).transpose();
    double precession = 0, worst_rate = 0, worst_attitude = 0;
    for (int i = 0; i < t.size(); ++i) {
      if (i > 0) precession += integrate([&](double x) { return top.precession_rate(x); }, t[i - 1], t[i], 8);
      worst_rate = std::max(worst_rate, (Vector3d(w.row(i).head<3>()) - top.rate(t[i])).norm());
      worst_attitude = std::max(worst_attitude, (R(i) - from_momentum * top.attitude(t[i], precession)).norm());
      EXPECT_LT((Vector3d(p.row(i)) - Vector3d(1, 2, 3) - t[i] * Vector3d(0.1, -0.2, 0.3)).norm(), 1e-10);
    }
    EXPECT_LT(worst_rate, 1e-9) << w1;
    EXPECT_LT(worst_attitude, 1e-9) << w1;
    EXPECT_LT((angular.rowwise() - angular.row(0)).cwiseAbs().maxCoeff(), 1e-10);
  }
}

}  // namespace
}  // namespace bough::solver::testing
