#include "fe/linear/blas.hpp"

// First: the BLAS header needs PETSc's own names.
#include <petscsys.h>

#include <petscblaslapack.h>

#include <algorithm>

#include "base/diagnostic.hpp"
#include "fe/linear/threads.hpp"
#include "fe/linear/wide.hpp"

namespace bough::linear {

namespace {

using Block = Eigen::Ref<const Eigen::MatrixXd>;
using Eigen::Index;

/// A few columns of A, the same rows of B, and `rows` rows of C.
struct Strip {
  const double *A, *B;
  double* C;
  Index lda, ldb, ldc, rows;
};

/// C += A B, K columns of A and M of B and C.
template <int W, int K, int M>
BOUGH_INLINE void add_columns(const Strip& s) {
  using V = typename Register<W>::type;
  double factor[K][M];
  for (int k = 0; k < K; ++k)
    for (int m = 0; m < M; ++m) factor[k][m] = s.B[k + m * s.ldb];
  Index i = 0;
  for (; i + W <= s.rows; i += W) {
    V a[K];
    for (int k = 0; k < K; ++k) __builtin_memcpy(&a[k], s.A + i + k * s.lda, sizeof(V));
    for (int m = 0; m < M; ++m) {
      V c;
      __builtin_memcpy(&c, s.C + i + m * s.ldc, sizeof(V));
      for (int k = 0; k < K; ++k) c += a[k] * factor[k][m];
      __builtin_memcpy(s.C + i + m * s.ldc, &c, sizeof(V));
    }
  }
  for (; i < s.rows; ++i)
    for (int m = 0; m < M; ++m)
      for (int k = 0; k < K; ++k) s.C[i + m * s.ldc] += s.A[i + k * s.lda] * factor[k][m];
}

template <int W, int K>
BOUGH_INLINE void add_strip(Strip s, Index num) {
  for (; num >= 4; num -= 4, s.B += 4 * s.ldb, s.C += 4 * s.ldc) add_columns<W, K, 4>(s);
  for (; num > 0; --num, s.B += s.ldb, s.C += s.ldc) add_columns<W, K, 1>(s);
}

/// C += A B: strips of C stay in the cache while four columns of A after the other pass by.
template <int W>
BOUGH_INLINE void add_tall(const Block& A, const Block& B, Eigen::Ref<Eigen::MatrixXd>& C) {
  constexpr Index kRows = 2048;
  for (Index first = 0; first < C.rows(); first += kRows) {
    Strip s{A.data() + first,
            B.data(),
            C.data() + first,
            A.outerStride(),
            B.outerStride(),
            C.outerStride(),
            std::min(kRows, C.rows() - first)};
    Index k = 0;
    for (; k + 4 <= A.cols(); k += 4, s.A += 4 * s.lda, s.B += 4) add_strip<W, 4>(s, C.cols());
    for (; k < A.cols(); ++k, s.A += s.lda, ++s.B) add_strip<W, 1>(s, C.cols());
  }
}

using AddTall = void (*)(const Block&, const Block&, Eigen::Ref<Eigen::MatrixXd>&);
void add_tall_narrow(const Block& A, const Block& B, Eigen::Ref<Eigen::MatrixXd>& C) { add_tall<2>(A, B, C); }
#ifdef BOUGH_AVX2
BOUGH_AVX2 void add_tall_wide(const Block& A, const Block& B, Eigen::Ref<Eigen::MatrixXd>& C) { add_tall<4>(A, B, C); }
AddTall get_add_tall() { return platform::has_avx2() ? add_tall_wide : add_tall_narrow; }
#else
AddTall get_add_tall() { return add_tall_narrow; }
#endif

void multiply(bool transposed, const Block& A, const Block& B, double beta, Eigen::Ref<Eigen::MatrixXd> C) {
  const auto as_blas = [](Eigen::Index i) { return static_cast<PetscBLASInt>(i); };
  const PetscBLASInt m = as_blas(C.rows()), n = as_blas(C.cols()), k = as_blas(B.rows());
  const PetscBLASInt lda = as_blas(std::max<Eigen::Index>(1, A.outerStride()));
  const PetscBLASInt ldb = as_blas(std::max<Eigen::Index>(1, B.outerStride()));
  const PetscBLASInt ldc = as_blas(C.outerStride());
  const double one = 1;
  // OpenBLAS copies A, which takes longer than the product where B is narrow (72 by 4 columns of 240,000 rows: 17 ms,
  // here 11 ms).
  constexpr Index kNarrow = 8, kMinRows = 2000;
  if (!transposed && B.cols() <= kNarrow && C.rows() >= kMinRows && (beta == 0 || beta == 1)) {
    if (beta == 0) C.setZero();
    return get_add_tall()(A, B, C);
  }
  BLASgemm_(transposed ? "T" : "N", "N", &m, &n, &k, &one, A.data(), &lda, B.data(), &ldb, &beta, C.data(), &ldc);
}

/// C = AᵀB of few columns, a few thousand rows at a time: OpenBLAS multiplies what is that small without a copy of A
/// (40 by 4 columns of 240,000 rows: 5.9 ms, at once 9.8 ms).
void multiply_in_slices(const Block& A, const Block& B, double beta, Eigen::Ref<Eigen::MatrixXd> C) {
  constexpr double kSmall = 6e5;  // products; up to 1e6 are small to OpenBLAS
  constexpr Eigen::Index kMinSlice = 512;
  const auto slice = static_cast<Eigen::Index>(kSmall / static_cast<double>(C.size()));
  if (slice < kMinSlice || slice >= A.rows()) return multiply(true, A, B, beta, C);
  for (Eigen::Index first = 0; first < A.rows(); first += slice) {
    const auto num = std::min(slice, A.rows() - first);
    multiply(true, A.middleRows(first, num), B.middleRows(first, num), first == 0 ? beta : 1, C);
  }
}

/// Fewer rows are done before a thread has started.
constexpr Eigen::Index kTall = 50000;

}  // namespace

void multiply_dense(bool transposed, const Eigen::Ref<const Eigen::MatrixXd>& A,
                    const Eigen::Ref<const Eigen::MatrixXd>& B, double beta, Eigen::Ref<Eigen::MatrixXd> C) {
  BOUGH_DEMAND((transposed ? A.rows() : A.cols()) == B.rows() && (transposed ? A.cols() : A.rows()) == C.rows() &&
               B.cols() == C.cols());
  if (C.size() == 0) return;
  if (A.rows() < kTall || get_num_threads() < 2)
    return transposed ? multiply_in_slices(A, B, beta, C) : multiply(false, A, B, beta, C);
  // Tall matrices wait for the memory, which gives two cores more than one.
  const Eigen::Index top = A.rows() / 2, bottom = A.rows() - top;
  if (transposed) {
    Eigen::MatrixXd half(C.rows(), C.cols());
    do_both([&] { multiply_in_slices(A.topRows(top), B.topRows(top), beta, C); },
            [&] { multiply_in_slices(A.bottomRows(bottom), B.bottomRows(bottom), 0, half); });
    C += half;
  } else {
    do_both([&] { multiply(false, A.topRows(top), B, beta, C.topRows(top)); },
            [&] { multiply(false, A.bottomRows(bottom), B, beta, C.bottomRows(bottom)); });
  }
}

Eigen::MatrixXd calc_inner_products(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                    const Eigen::Ref<const Eigen::MatrixXd>& B) {
  Eigen::MatrixXd C(A.cols(), B.cols());
  multiply_dense(true, A, B, 0, C);
  return C;
}

}  // namespace bough::linear
