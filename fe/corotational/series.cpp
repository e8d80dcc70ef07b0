#include "fe/corotational/series.hpp"

#include "base/rotation.hpp"

namespace bough::fe {

template <std::size_t M>
VectorSeries<M> rotate(const MatrixSeries<M>& A, const VectorSeries<M>& b) {
  VectorSeries<M> product = b;
  for (std::size_t k = 1; k < M; ++k)
    for (std::size_t i = 1; i <= k; ++i) product[k].noalias() += A[i] * b[k - i];
  return product;
}

template <std::size_t M>
VectorSeries<M> rotate_back(const MatrixSeries<M>& A, const VectorSeries<M>& b) {
  VectorSeries<M> product = b;
  for (std::size_t k = 1; k < M; ++k)
    for (std::size_t i = 1; i <= k; ++i) product[k].noalias() += A[i].transpose() * b[k - i];
  return product;
}

template <std::size_t M>
MatrixSeries<M> rotate_back(const MatrixSeries<M>& A, const MatrixSeries<M>& B) {
  MatrixSeries<M> product;
  product[0].setIdentity();
  for (std::size_t k = 1; k < M; ++k) {
    product[k] = A[k].transpose() + B[k];
    for (std::size_t i = 1; i < k; ++i) product[k].noalias() += A[i].transpose() * B[k - i];
  }
  return product;
}

template <std::size_t M>
VectorSeries<M> cross(const VectorSeries<M>& a, const VectorSeries<M>& b) {
  VectorSeries<M> c = make_zero_vector<M>();
  for (std::size_t k = 0; k < M; ++k)
    for (std::size_t i = 0; i <= k; ++i) c[k] += a[i].cross(b[k - i]);
  return c;
}

template <std::size_t M>
VectorSeries<M> solve(const MatrixSeries<M>& A, const Matrix3d& inverse_0, const VectorSeries<M>& b) {
  VectorSeries<M> x;
  for (std::size_t k = 0; k < M; ++k) {
    Vector3d right = b[k];
    for (std::size_t i = 1; i <= k; ++i) right.noalias() -= A[i] * x[k - i];
    x[k] = inverse_0 * right;
  }
  return x;
}

template <std::size_t M>
MatrixSeries<M> subtract_from_trace(const MatrixSeries<M>& A) {
  MatrixSeries<M> B;
  for (std::size_t k = 0; k < M; ++k) B[k] = A[k].trace() * Matrix3d::Identity() - A[k];
  return B;
}

namespace {

template <std::size_t M>
using Numbers = std::array<double, M>;

/// v·v, from order 2 on as v_0 = 0.
template <std::size_t M>
Numbers<M> calc_square(const VectorSeries<M>& v) {
  Numbers<M> square{};
  for (std::size_t k = 2; k < M; ++k)
    for (std::size_t i = 1; i < k; ++i) square[k] += v[i].dot(v[k - i]);
  return square;
}

/// c0 + c1 v² + c2 v⁴. With v_0 = 0 the next power is of order 6.
template <std::size_t M>
Numbers<M> calc_even_function(const std::array<double, 3>& c, const Numbers<M>& square) {
  static_assert(M <= 6);
  Numbers<M> result{};
  result[0] = c[0];
  for (std::size_t k = 2; k < M; ++k) {
    result[k] = c[1] * square[k];
    for (std::size_t i = 2; i + 2 <= k; ++i) result[k] += c[2] * square[i] * square[k - i];
  }
  return result;
}

// In powers of t²: sin t/t, (1 - cos t)/t², (t - sin t)/t³, 1/t² - cot(t/2)/(2t); asin s/s in powers of s².
constexpr std::array kSinc{1.0, -1.0 / 6, 1.0 / 120}, kVersine{1.0 / 2, -1.0 / 24, 1.0 / 720},
    kThird{1.0 / 6, -1.0 / 120, 1.0 / 5040}, kInverse{1.0 / 12, 1.0 / 720, 1.0 / 30240},
    kArcsine{1.0, 1.0 / 6, 3.0 / 40};

/// a v, v_0 = 0.
template <std::size_t M>
VectorSeries<M> scale(const Numbers<M>& a, const VectorSeries<M>& v) {
  VectorSeries<M> product = make_zero_vector<M>();
  for (std::size_t k = 1; k < M; ++k)
    for (std::size_t i = 0; i < k; ++i) product[k] += a[i] * v[k - i];
  return product;
}

/// θ × v, θ_0 = 0.
template <std::size_t M>
VectorSeries<M> turn(const VectorSeries<M>& theta, const VectorSeries<M>& v) {
  VectorSeries<M> c = make_zero_vector<M>();
  for (std::size_t k = 1; k < M; ++k)
    for (std::size_t i = 1; i <= k; ++i) c[k] += theta[i].cross(v[k - i]);
  return c;
}

/// v + θ × (a v) + b θ × (θ × v).
template <std::size_t M>
VectorSeries<M> apply(const Numbers<M>& a, const Numbers<M>& b, const VectorSeries<M>& theta,
                      const VectorSeries<M>& v) {
  const VectorSeries<M> once = turn(theta, v), twice = scale(b, turn(theta, once)), first = scale(a, once);
  VectorSeries<M> result = v;
  for (std::size_t k = 1; k < M; ++k) result[k] += first[k] + twice[k];
  return result;
}

}  // namespace

/// 1 + a θ̃ + b (θ θᵀ - θ² 1).
template <std::size_t M>
MatrixSeries<M> calc_exponential(const VectorSeries<M>& theta) {
  const Numbers<M> square = calc_square(theta), b = calc_even_function(kVersine, square);
  const VectorSeries<M> a_theta = scale(calc_even_function(kSinc, square), theta);
  MatrixSeries<M> second = make_zero_matrix<M>(), R;
  for (std::size_t k = 2; k < M; ++k) {
    for (std::size_t i = 1; i < k; ++i) second[k].noalias() += theta[i] * theta[k - i].transpose();
    second[k].diagonal().array() -= square[k];
  }
  R[0].setIdentity();
  for (std::size_t k = 1; k < M; ++k) {
    R[k] = skew(a_theta[k]);
    for (std::size_t i = 0; i + 2 <= k; ++i) R[k] += b[i] * second[k - i];
  }
  return R;
}

template <std::size_t M>
VectorSeries<M> calc_logarithm(const MatrixSeries<M>& R) {
  VectorSeries<M> axis;
  for (std::size_t k = 0; k < M; ++k)
    axis[k] = 0.5 * Vector3d(R[k](2, 1) - R[k](1, 2), R[k](0, 2) - R[k](2, 0), R[k](1, 0) - R[k](0, 1));
  return scale(calc_even_function(kArcsine, calc_square(axis)), axis);
}

template <std::size_t M>
VectorSeries<M> apply_tangent_transpose(const VectorSeries<M>& theta, const VectorSeries<M>& v) {
  const Numbers<M> square = calc_square(theta);
  Numbers<M> a = calc_even_function(kVersine, square);
  for (double& value : a) value = -value;
  return apply(a, calc_even_function(kThird, square), theta, v);
}

template <std::size_t M>
VectorSeries<M> apply_inverse_tangent_transpose(const VectorSeries<M>& theta, const VectorSeries<M>& v) {
  return apply({0.5}, calc_even_function(kInverse, calc_square(theta)), theta, v);
}

template <std::size_t M>
void find_nearest_rotation(const MatrixSeries<M>& B, const Matrix3d& inverse, MatrixSeries<M>& R, MatrixSeries<M>& H) {
  R[0].setIdentity();
  H[0] = B[0];
  for (std::size_t k = 1; k < M; ++k) {
    Matrix3d even = Matrix3d::Zero(), rest = B[k];
    for (std::size_t i = 1; i < k; ++i) {
      even.noalias() -= 0.5 * (R[i].transpose() * R[k - i]);
      rest.noalias() -= R[i] * H[k - i];
    }
    const Matrix3d odd = rest - even * H[0];
    const Vector3d axis(odd(2, 1) - odd(1, 2), odd(0, 2) - odd(2, 0), odd(1, 0) - odd(0, 1));
    const Vector3d spin = inverse * axis;
    R[k] = even + skew(spin);
    rest.noalias() -= R[k] * H[0];
    H[k] = 0.5 * (rest + rest.transpose());
  }
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
  return apply_tangent_transpose(theta, cross(turned, force));
}

#define BOUGH_SERIES(M)                                                                                        \
  template VectorSeries<M> rotate<M>(const MatrixSeries<M>&, const VectorSeries<M>&);                          \
  template VectorSeries<M> rotate_back<M>(const MatrixSeries<M>&, const VectorSeries<M>&);                     \
  template MatrixSeries<M> rotate_back<M>(const MatrixSeries<M>&, const MatrixSeries<M>&);                     \
  template VectorSeries<M> cross<M>(const VectorSeries<M>&, const VectorSeries<M>&);                           \
  template VectorSeries<M> solve<M>(const MatrixSeries<M>&, const Eigen::Matrix3d&, const VectorSeries<M>&);   \
  template MatrixSeries<M> subtract_from_trace<M>(const MatrixSeries<M>&);                                     \
  template MatrixSeries<M> calc_exponential<M>(const VectorSeries<M>&);                                        \
  template VectorSeries<M> calc_logarithm<M>(const MatrixSeries<M>&);                                          \
  template VectorSeries<M> apply_tangent_transpose<M>(const VectorSeries<M>&, const VectorSeries<M>&);         \
  template VectorSeries<M> apply_inverse_tangent_transpose<M>(const VectorSeries<M>&, const VectorSeries<M>&); \
  template void find_nearest_rotation<M>(const MatrixSeries<M>&, const Eigen::Matrix3d&, MatrixSeries<M>&,     \
                                         MatrixSeries<M>&);

BOUGH_SERIES(3)
BOUGH_SERIES(4)
BOUGH_SERIES(5)
BOUGH_SERIES(6)
#undef BOUGH_SERIES

}  // namespace bough::fe
