#include "fe/corotational/series.hpp"

#include "base/rotation.hpp"

namespace bough::fe {

SeriesVector make_zero_vector() {
  SeriesVector zero;
  zero.fill(Vector3d::Zero());
  return zero;
}

SeriesMatrix make_zero_matrix() {
  SeriesMatrix zero;
  zero.fill(Matrix3d::Zero());
  return zero;
}

SeriesMatrix transpose(const SeriesMatrix& A) {
  SeriesMatrix T;
  for (std::size_t k = 0; k < A.size(); ++k) T[k] = A[k].transpose();
  return T;
}

SeriesVector multiply(const SeriesMatrix& A, const SeriesVector& b) { return multiply<Vector3d>(A, b); }
SeriesMatrix multiply(const SeriesMatrix& A, const SeriesMatrix& B) { return multiply<Matrix3d>(A, B); }

SeriesVector cross(const SeriesVector& a, const SeriesVector& b) {
  SeriesVector c = make_zero_vector();
  for (std::size_t k = 0; k < c.size(); ++k)
    for (std::size_t i = 0; i <= k; ++i) c[k] += a[i].cross(b[k - i]);
  return c;
}

SeriesVector get_vector(const Eigen::Ref<const Eigen::MatrixXd>& u, Eigen::Index row) {
  SeriesVector v = make_zero_vector();
  for (int k = 1; k <= kSeriesTop; ++k) v[static_cast<std::size_t>(k)] = u.block<3, 1>(row, k - 1);
  return v;
}

void put_vector(const SeriesVector& v, Eigen::Index row, Eigen::Ref<Eigen::MatrixXd> u) {
  for (int k = 1; k <= kSeriesTop; ++k) u.block<3, 1>(row, k - 1) = v[static_cast<std::size_t>(k)];
}

SeriesVector solve(const SeriesMatrix& A, const Matrix3d& inverse_0, const SeriesVector& b) {
  SeriesVector x;
  for (std::size_t k = 0; k < x.size(); ++k) {
    Vector3d right = b[k];
    for (std::size_t i = 1; i <= k; ++i) right -= A[i] * x[k - i];
    x[k] = inverse_0 * right;
  }
  return x;
}

SeriesVector calc_skew_axis(const SeriesMatrix& A) {
  SeriesVector axis;
  for (std::size_t k = 0; k < A.size(); ++k)
    axis[k] = Vector3d(A[k](2, 1) - A[k](1, 2), A[k](0, 2) - A[k](2, 0), A[k](1, 0) - A[k](0, 1));
  return axis;
}

SeriesMatrix subtract_from_trace(const SeriesMatrix& A) {
  SeriesMatrix B;
  for (std::size_t k = 0; k < A.size(); ++k) B[k] = A[k].trace() * Matrix3d::Identity() - A[k];
  return B;
}

namespace {

/// c0 + c1 v² + c2 v⁴. With v_0 = 0 the next power is of order 6.
Series<double> calc_even_function(const std::array<double, 3>& c, const SeriesVector& v) {
  static_assert(kSeriesTop < 6);
  Series<double> square{}, result{};
  for (std::size_t k = 0; k < square.size(); ++k)
    for (std::size_t i = 0; i <= k; ++i) square[k] += v[i].dot(v[k - i]);
  const auto fourth = multiply<double>(square, square);
  result[0] = c[0];
  for (std::size_t k = 0; k < result.size(); ++k) result[k] += c[1] * square[k] + c[2] * fourth[k];
  return result;
}

// In powers of t²: sin t/t, (1 - cos t)/t², (t - sin t)/t³, 1/t² - cot(t/2)/(2t); asin s/s in powers of s².
constexpr std::array kSinc{1.0, -1.0 / 6, 1.0 / 120}, kVersine{1.0 / 2, -1.0 / 24, 1.0 / 720},
    kThird{1.0 / 6, -1.0 / 120, 1.0 / 5040}, kInverse{1.0 / 12, 1.0 / 720, 1.0 / 30240},
    kArcsine{1.0, 1.0 / 6, 3.0 / 40};

/// 1 + a θ̃ + b θ̃².
SeriesMatrix combine(const Series<double>& a, const Series<double>& b, const SeriesVector& theta) {
  SeriesMatrix S;
  for (std::size_t k = 0; k < S.size(); ++k) S[k] = skew(theta[k]);
  SeriesMatrix sum = multiply<Matrix3d>(a, S);
  const SeriesMatrix second = multiply<Matrix3d>(b, multiply(S, S));
  for (std::size_t k = 0; k < S.size(); ++k) sum[k] += second[k];
  sum[0] += Matrix3d::Identity();
  return sum;
}

}  // namespace

SeriesMatrix calc_exponential(const SeriesVector& theta) {
  return combine(calc_even_function(kSinc, theta), calc_even_function(kVersine, theta), theta);
}

SeriesVector calc_logarithm(const SeriesMatrix& R) {
  SeriesVector axis = calc_skew_axis(R);
  for (auto& v : axis) v *= 0.5;
  return multiply<Vector3d>(calc_even_function(kArcsine, axis), axis);
}

SeriesMatrix calc_tangent(const SeriesVector& theta) {
  return combine(calc_even_function(kVersine, theta), calc_even_function(kThird, theta), theta);
}

SeriesMatrix calc_inverse_tangent(const SeriesVector& theta) {
  return combine({-0.5}, calc_even_function(kInverse, theta), theta);
}

SeriesVector calc_arm_motion(const SeriesVector& theta, const Vector3d& arm) {
  const SeriesMatrix R = calc_exponential(theta);
  SeriesVector motion;
  for (std::size_t k = 0; k < motion.size(); ++k) motion[k] = R[k] * arm;
  motion[0].setZero();
  return motion;
}

SeriesVector calc_arm_moment(const SeriesVector& theta, const Vector3d& arm, const SeriesVector& force) {
  const SeriesMatrix R = calc_exponential(theta);
  SeriesVector turned;
  for (std::size_t k = 0; k < turned.size(); ++k) turned[k] = R[k] * arm;
  return multiply(transpose(calc_tangent(theta)), cross(turned, force));
}

}  // namespace bough::fe
