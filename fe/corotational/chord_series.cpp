#include "fe/corotational/chord_series.hpp"

namespace bough::fe {
namespace {

SeriesVector scale(double factor, SeriesVector v) {
  for (auto& order : v) order *= factor;
  return v;
}

void add(const SeriesVector& v, SeriesVector& sum) {
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += v[k];
}

SeriesVector multiply_constant(const Matrix3d& A, SeriesVector v) {
  for (auto& order : v) order = A * order;
  return v;
}

SeriesVector turn_constant(const SeriesMatrix& R, const Vector3d& x) {
  SeriesVector v;
  for (std::size_t k = 0; k < v.size(); ++k) v[k] = R[k] * x;
  return v;
}

}  // namespace

ChordSeries::ChordSeries(const CarriedMass& carried, const Eigen::Ref<const MatrixXd>& u)
    : carried_(carried), field_(carried.fields.front()) {
  theta_a_ = get_vector(u, 3);
  theta_b_ = get_vector(u, 9);
  R_a_ = calc_exponential(theta_a_);
  u_a_ = get_vector(u, 0);
  add(calc_arm_motion(theta_a_, field_.arms[0]), u_a_);
  c_ = get_vector(u, 6);
  add(calc_arm_motion(theta_b_, field_.arms[1]), c_);
  add(scale(-1, u_a_), c_);
  c_[0] = field_.chord;
  rho_ = calc_logarithm(multiply(transpose(R_a_), calc_exponential(theta_b_)));
  R_ = multiply(R_a_, calc_exponential(scale(0.5, rho_)));
  d_ = multiply(transpose(R_), c_);
  d_[0].setZero();
}

SeriesVector ChordSeries::combine(const Eigen::Matrix<double, 3, 12>& A) const {
  SeriesVector sum = multiply_constant(0.5 * (A.rightCols<3>() - A.middleCols<3>(3)), rho_);
  add(multiply_constant(A.middleCols<3>(6), d_), sum);
  return sum;
}

ChordSeries::Seen ChordSeries::look_at(std::size_t p) const {
  const CarriedPoint& at = point(p);
  const Vector3d X = at.is_place ? Vector3d(at.x - field_.x_a) : at.x;
  Seen seen{combine(field_.moved[p].motion), make_zero_vector()};
  if (!at.is_place) {
    seen.tau = combine(field_.moved[p].turn);
    add(turn_constant(calc_exponential(seen.tau), X), seen.y);
    for (std::size_t k = 0; k < seen.y.size(); ++k) seen.y[k] -= seen.tau[k].cross(X);
  } else {
    seen.y[0] += X;
  }
  return seen;
}

SeriesVector ChordSeries::calc_motion(std::size_t p) const {
  SeriesVector motion = multiply(R_, look_at(p).y);
  if (point(p).is_place) add(u_a_, motion);
  motion[0].setZero();
  return motion;
}

MatrixXd ChordSeries::calc_forces(const std::vector<SeriesVector>& forces) const {
  // On u_a, on the spin of R, on ρ and d.
  SeriesVector total = make_zero_vector(), moment = total, on_rho = total, on_d = total;
  const SeriesMatrix R_t = transpose(R_);
  for (std::size_t p = 0; p < forces.size(); ++p) {
    const CarriedPoint& at = point(p);
    const auto& moved = field_.moved[p];
    const Seen seen = look_at(p);
    const auto add_seen = [&](const Eigen::Matrix<double, 3, 12>& A, const SeriesVector& g) {
      add(multiply_constant(0.5 * (A.rightCols<3>() - A.middleCols<3>(3)).transpose(), g), on_rho);
      add(multiply_constant(A.middleCols<3>(6).transpose(), g), on_d);
    };
    if (at.is_place) add(forces[p], total);
    add(cross(multiply(R_, seen.y), forces[p]), moment);
    const SeriesVector g = multiply(R_t, forces[p]);
    add_seen(moved.motion, g);
    if (at.is_place) continue;
    const SeriesVector arm = turn_constant(calc_exponential(seen.tau), at.x);
    SeriesVector on_tau = apply_tangent_transpose(seen.tau, cross(arm, g));
    for (std::size_t k = 0; k < on_tau.size(); ++k) on_tau[k] -= at.x.cross(g[k]);
    add_seen(moved.turn, on_tau);
  }
  const SeriesVector on_b = multiply(R_, on_d);
  SeriesVector on_a = scale(-1, on_b);
  add(total, on_a);
  add(scale(-1, cross(c_, on_b)), moment);
  add(scale(0.5, apply_tangent_transpose(scale(0.5, rho_), multiply(transpose(R_a_), moment))), on_rho);
  const SeriesVector spin_b = multiply(R_a_, apply_inverse_tangent_transpose(rho_, on_rho));
  SeriesVector spin_a = scale(-1, spin_b);
  add(moment, spin_a);
  const auto add_arm = [](const SeriesVector& theta, const Vector3d& arm, const SeriesVector& force,
                          const SeriesVector& spin) {
    SeriesVector result = apply_tangent_transpose(theta, spin);
    add(calc_arm_moment(theta, arm, force), result);
    return result;
  };
  MatrixXd f(12, kSeriesTop);
  put_vector(on_a, 0, f);
  put_vector(add_arm(theta_a_, field_.arms[0], on_a, spin_a), 3, f);
  put_vector(on_b, 6, f);
  put_vector(add_arm(theta_b_, field_.arms[1], on_b, spin_b), 9, f);
  return f;
}

}  // namespace bough::fe
