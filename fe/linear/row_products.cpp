#include "fe/linear/row_products.hpp"

#include <algorithm>
#include <cmath>

#include "fe/linear/threads.hpp"
#include "fe/linear/wide.hpp"

#ifdef BOUGH_AVX2
#include <immintrin.h>
#endif

namespace bough::linear {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Matrix = Eigen::Ref<const MatrixXd>;

constexpr Index kAtOnce = 4;         ///< columns: A is read once for them
constexpr int kRowsOfThread = 5000;  ///< fewer are done before a thread has started

/// Rows [first, last) of Y -= A X, four columns of X and Y with those of a row side by side.
using SubtractRows = void (*)(const MatrixRows& A, int first, int last, const double* X, double* Y);

void subtract_narrow(const MatrixRows& A, int first, int last, const double* X, double* Y) {
  for (int row = first; row < last; ++row)
    for (Index c = 0; c < kAtOnce; ++c) {
      double& y = Y[kAtOnce * row + c];
      if constexpr (platform::kHasExtended) {
        long double sum = y;
        for (PetscInt k = A.start[row]; k < A.start[row + 1]; ++k)
          sum -= static_cast<long double>(A.value[k]) * X[kAtOnce * A.column[k] + c];
        y = static_cast<double>(sum);
      } else {
        double sum = y, rest = 0;
        for (PetscInt k = A.start[row]; k < A.start[row + 1]; ++k) {
          const double a = -A.value[k], x = X[kAtOnce * A.column[k] + c];
          const double product = a * x, of_product = std::fma(a, x, -product);
          const double next = sum + product, part = next - sum;
          rest += of_product + ((sum - (next - part)) + (product - part));
          sum = next;
        }
        y = sum + rest;
      }
    }
}

#ifdef BOUGH_AVX2
BOUGH_AVX2 void subtract_wide(const MatrixRows& A, int first, int last, const double* X, double* Y) {
  for (int row = first; row < last; ++row) {
    __m256d sum = _mm256_loadu_pd(Y + kAtOnce * row), rest = _mm256_setzero_pd();
    for (PetscInt k = A.start[row]; k < A.start[row + 1]; ++k) {
      const __m256d a = _mm256_set1_pd(-A.value[k]), x = _mm256_loadu_pd(X + kAtOnce * A.column[k]);
      const __m256d product = _mm256_mul_pd(a, x), of_product = _mm256_fmsub_pd(a, x, product);
      const __m256d next = _mm256_add_pd(sum, product), part = _mm256_sub_pd(next, sum);
      const __m256d of_sum = _mm256_add_pd(_mm256_sub_pd(sum, _mm256_sub_pd(next, part)), _mm256_sub_pd(product, part));
      sum = next;
      rest = _mm256_add_pd(rest, _mm256_add_pd(of_product, of_sum));
    }
    _mm256_storeu_pd(Y + kAtOnce * row, _mm256_add_pd(sum, rest));
  }
}

SubtractRows get_subtract() { return platform::has_avx2() ? subtract_wide : subtract_narrow; }
#else
SubtractRows get_subtract() { return subtract_narrow; }
#endif

/// Packs the columns from `first` on next to each other, with the last one repeated as padding.
void pack(const Matrix& X, Index first, MatrixXd& packed) {
  const double* x[kAtOnce];
  for (Index c = 0; c < kAtOnce; ++c) x[c] = X.data() + std::min(first + c, X.cols() - 1) * X.outerStride();
  do_halves(static_cast<int>(X.rows()), kRowsOfThread, [&](int from, int to) {
    double* at = packed.data() + kAtOnce * from;
    for (int i = from; i < to; ++i)
      for (Index c = 0; c < kAtOnce; ++c) *at++ = x[c][i];
  });
}

}  // namespace

MatrixXd multiply_rows(const MatrixRows& A, const Matrix& X) {
  MatrixXd Y(X.rows(), X.cols());
  do_halves(static_cast<int>(X.rows()), kRowsOfThread, [&](int first, int last) {
    // Side by side, as below, they are no faster here, and take memory.
    for (Index c = 0; c < X.cols(); c += kAtOnce) {
      const double* x[kAtOnce];
      const Index num = std::min(kAtOnce, X.cols() - c);
      for (Index i = 0; i < kAtOnce; ++i) x[i] = X.data() + (c + std::min(i, num - 1)) * X.outerStride();
      for (int row = first; row < last; ++row) {
        double sum[kAtOnce] = {0, 0, 0, 0};
        for (PetscInt k = A.start[row]; k < A.start[row + 1]; ++k)
          for (Index i = 0; i < kAtOnce; ++i) sum[i] += A.value[k] * x[i][A.column[k]];
        for (Index i = 0; i < num; ++i) Y(row, c + i) = sum[i];
      }
    }
  });
  return Y;
}

MatrixXd subtract_precisely(const MatrixRows& A, const Matrix& X, const Matrix& B) {
  const SubtractRows subtract = get_subtract();
  MatrixXd R(B.rows(), B.cols()), x(kAtOnce, X.rows()), r(kAtOnce, B.rows());
  for (Index first = 0; first < B.cols(); first += kAtOnce) {
    pack(X, first, x);
    pack(B, first, r);
    const Index num = std::min(kAtOnce, B.cols() - first);
    do_halves(static_cast<int>(B.rows()), kRowsOfThread, [&](int from, int to) {
      subtract(A, from, to, x.data(), r.data());
      for (Index c = 0; c < num; ++c)
        for (int i = from; i < to; ++i) R(i, first + c) = r(c, i);
    });
  }
  return R;
}

}  // namespace bough::linear
