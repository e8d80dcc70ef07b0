#include "solver/bodies/kernels.hpp"

#include <cmath>

#include "base/platform.hpp"

// Wide registers are handed to inlined functions only: no ABI is at stake.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace bough::solver {

using Eigen::Index;

namespace {

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));

template <int W>
struct Register {
  using type = Four;
};
template <>
struct Register<2> {
  using type = Two;
};
// Doubles at any address: compilers differ in the alignment that they assume of a vector by reference.
template <int W>
BOUGH_INLINE typename Register<W>::type load(const double* p) {
  typename Register<W>::type v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
template <int W>
BOUGH_INLINE void store(double* p, const typename Register<W>::type& v) {
  __builtin_memcpy(p, &v, sizeof v);
}
BOUGH_INLINE double sum(const Two& x) { return x[0] + x[1]; }
BOUGH_INLINE double sum(const Four& x) { return (x[0] + x[1]) + (x[2] + x[3]); }

// R registers of rows times C columns: out += sign A B over k < num.
template <int W, int R, int C>
BOUGH_INLINE void accumulate(const double* A, Index lda, const double* B, Index next_k, Index next_column, Index num,
                             double sign, double* out, Index ldo) {
  using V = typename Register<W>::type;
  V acc[C][R];
  for (int c = 0; c < C; ++c) {
    for (int r = 0; r < R; ++r) acc[c][r] = V{};
  }
  for (Index k = 0; k < num; ++k) {
    const double* a = A + k * lda;
    for (int c = 0; c < C; ++c) {
      const double b = B[k * next_k + c * next_column];
      for (int r = 0; r < R; ++r) acc[c][r] += load<W>(a + W * r) * b;
    }
  }
  for (int c = 0; c < C; ++c) {
    for (int r = 0; r < R; ++r) {
      double* to = out + c * ldo + W * r;
      store<W>(to, load<W>(to) + sign * acc[c][r]);
    }
  }
}

// All row blocks of C columns.
template <int W, int C>
BOUGH_INLINE void accumulate_rows(const double* A, Index lda, const double* B, Index next_k, Index next_column,
                                  Index num, double sign, double* out, Index ldo, Index rows) {
  constexpr int R = C == 1 ? 4 : 2;
  Index i = 0;
  for (; i + W * R <= rows; i += W * R)
    accumulate<W, R, C>(A + i, lda, B, next_k, next_column, num, sign, out + i, ldo);
  for (; i < rows; i += W) accumulate<W, 1, C>(A + i, lda, B, next_k, next_column, num, sign, out + i, ldo);
}

// Columns j .. j+C-1 of [L; ...], after the update by those before; rows from j on, C of them the triangle.
template <int W, int C>
BOUGH_INLINE void factor_panel(double* A, Index ld, Index rows) {
  double inverse[C];
  for (int c = 0; c < C; ++c) {
    for (int k = 0; k < c; ++k) A[c + c * ld] -= A[c + k * ld] * A[c + k * ld];
    A[c + c * ld] = std::sqrt(A[c + c * ld]);
    inverse[c] = 1 / A[c + c * ld];
    for (int r = c + 1; r < C; ++r) {
      for (int k = 0; k < c; ++k) A[r + c * ld] -= A[r + k * ld] * A[c + k * ld];
      A[r + c * ld] *= inverse[c];
    }
  }
  using V = typename Register<W>::type;
  Index i = C;
  for (; i < rows && i % W != 0; ++i) {
    for (int c = 0; c < C; ++c) {
      for (int k = 0; k < c; ++k) A[i + c * ld] -= A[i + k * ld] * A[c + k * ld];
      A[i + c * ld] *= inverse[c];
    }
  }
  for (; i < rows; i += W) {
    V x[C];
    for (int c = 0; c < C; ++c) {
      x[c] = load<W>(A + i + c * ld);
      for (int k = 0; k < c; ++k) x[c] -= x[k] * A[c + k * ld];
      x[c] *= inverse[c];
      store<W>(A + i + c * ld, x[c]);
    }
  }
}

template <int W, int C>
BOUGH_INLINE void factor_columns(double* A, Index ld, Index j) {
  accumulate_rows<W, C>(A + j, ld, A + j, ld, 1, j, -1, A + j + j * ld, ld, ld - j);
  factor_panel<W, C>(A + j + j * ld, ld, ld - j);
}

template <int W, int C>
BOUGH_INLINE void solve_columns(const double* L, Index ld, Index n, Index j, double* z) {
  double inverse[C];
  for (int c = 0; c < C; ++c) inverse[c] = 1 / L[(j + c) * (ld + 1)];
  double x[C];
  for (int c = 0; c < C; ++c) {
    x[c] = z[j + c];
    for (int k = 0; k < c; ++k) x[c] -= x[k] * L[j + c + (j + k) * ld];
    z[j + c] = x[c] *= inverse[c];
  }
  Index i = j + C;
  using V = typename Register<W>::type;
  for (; i + W <= n; i += W) {
    V out = load<W>(z + i);
    for (int c = 0; c < C; ++c) out -= load<W>(L + i + (j + c) * ld) * x[c];
    store<W>(z + i, out);
  }
  for (; i < n; ++i) {
    for (int c = 0; c < C; ++c) z[i] -= L[i + (j + c) * ld] * x[c];
  }
}

template <int W, int C>
BOUGH_INLINE void solve_columns_transposed(const double* L, Index ld, Index n, Index j, double* z) {
  double inverse[C];
  for (int c = 0; c < C; ++c) inverse[c] = 1 / L[(j + c) * (ld + 1)];
  using V = typename Register<W>::type;
  V sums[C];
  for (int c = 0; c < C; ++c) sums[c] = V{};
  Index i = j + C;
  for (; i + W <= n; i += W) {
    for (int c = 0; c < C; ++c) sums[c] += load<W>(L + i + (j + c) * ld) * load<W>(z + i);
  }
  double x[C];
  for (int c = 0; c < C; ++c) {
    x[c] = z[j + c] - sum(sums[c]);
    for (Index r = i; r < n; ++r) x[c] -= L[r + (j + c) * ld] * z[r];
  }
  for (int c = C - 1; c >= 0; --c) {
    for (int k = c + 1; k < C; ++k) x[c] -= L[j + k + (j + c) * ld] * x[k];
    z[j + c] = x[c] *= inverse[c];
  }
}

template <int W>
struct Kernels {
  static BOUGH_INLINE void multiply(const double* A, Index rows, Index cols, const double* x, double* y) {
    for (Index i = 0; i < rows; ++i) y[i] = 0;
    accumulate_rows<W, 1>(A, rows, x, 1, 0, cols, 1, y, rows, rows);
  }

  // C columns at once: sums of two registers each.
  template <int C>
  static BOUGH_INLINE void multiply_columns(const double* A, Index rows, const double* x, double* y) {
    using V = typename Register<W>::type;
    V s[C], t[C];
    for (int c = 0; c < C; ++c) s[c] = t[c] = V{};
    Index i = 0;
    for (; i + 2 * W <= rows; i += 2 * W) {
      for (int c = 0; c < C; ++c) {
        s[c] += load<W>(A + c * rows + i) * load<W>(x + i);
        t[c] += load<W>(A + c * rows + i + W) * load<W>(x + i + W);
      }
    }
    for (int c = 0; c < C; ++c) {
      if (i < rows) s[c] += load<W>(A + c * rows + i) * load<W>(x + i);
      y[c] = sum(V(s[c] + t[c]));
    }
  }

  static BOUGH_INLINE void multiply_transposed(const double* A, Index rows, Index cols, const double* x, double* y) {
    Index k = 0;
    for (; k + 3 <= cols; k += 3) multiply_columns<3>(A + k * rows, rows, x, y + k);
    for (; k < cols; ++k) multiply_columns<1>(A + k * rows, rows, x, y + k);
  }

  // R registers of every row, from `in` and `out` on. F factors, 0: N.
  template <int R, int F>
  static BOUGH_INLINE void contract_part(const double* in, Index stride, const int* offset, Index num, const double* x,
                                         Index N, double* out) {
    using V = typename Register<W>::type;
    const Index num_factors = F > 0 ? F : N;
    for (Index t = 0; t < num; ++t, offset += num_factors, out += stride) {
      V acc[R];
      for (int r = 0; r < R; ++r) acc[r] = V{};
      for (Index f = 0; f < num_factors; ++f) {
        const double* a = in + offset[f];
        for (int r = 0; r < R; ++r) acc[r] += load<W>(a + W * r) * x[f];
      }
      for (int r = 0; r < R; ++r) store<W>(out + W * r, acc[r]);
    }
  }

  template <int F>
  static BOUGH_INLINE void contract_rows(const double* in, Index stride, const int* offset, Index num, const double* x,
                                         Index N, double* out) {
    Index i = 0;
    for (; i + 4 * W <= stride; i += 4 * W) contract_part<4, F>(in + i, stride, offset, num, x, N, out + i);
    for (; i + 2 * W <= stride; i += 2 * W) contract_part<2, F>(in + i, stride, offset, num, x, N, out + i);
    for (; i < stride; i += W) contract_part<1, F>(in + i, stride, offset, num, x, N, out + i);
  }

  static BOUGH_INLINE void contract(const double* in, Index stride, const int* offset, Index num, const double* x,
                                    Index N, double* out) {
    if (N == 6) return contract_rows<6>(in, stride, offset, num, x, N, out);  // the default number of large modes
    contract_rows<0>(in, stride, offset, num, x, N, out);
  }

  static BOUGH_INLINE void add_scaled(double a, const double* x, double b, const double* y, Index rows, double* out) {
    for (Index i = 0; i < rows; i += W) store<W>(out + i, load<W>(out + i) + load<W>(x + i) * a + load<W>(y + i) * b);
  }

  static BOUGH_INLINE void add_product(const double* A, Index rows, Index r, const double* B, Index m, double* C) {
    Index k = 0;
    for (; k + 3 < m; k += 4) accumulate_rows<W, 4>(A, rows, B + k * r, 1, r, r, 1, C + k * rows, rows, rows);
    for (; k + 2 < m; k += 3) accumulate_rows<W, 3>(A, rows, B + k * r, 1, r, r, 1, C + k * rows, rows, rows);
    for (; k < m; ++k) accumulate_rows<W, 1>(A, rows, B + k * r, 1, r, r, 1, C + k * rows, rows, rows);
  }

  static BOUGH_INLINE void add_square(const double* A, const double* V0, Index rows, double* C) {
    for (Index k = 0; k < rows; k += 4) {
      for (int c = 0; c < 4; ++c) {
        for (Index i = k; i < rows; i += W) store<W>(C + (k + c) * rows + i, load<W>(A + (k + c) * rows + i));
      }
      accumulate_rows<W, 4>(V0 + k, rows, V0 + k, rows, 1, 12, 1, C + k * rows + k, rows, rows - k);
    }
  }

  static BOUGH_INLINE void factor_trapezoid(double* A, Index rows, Index n) {
    Index j = 0;
    for (; j + 4 <= n; j += 4) factor_columns<W, 4>(A, rows, j);
    if (n - j == 1) factor_columns<W, 1>(A, rows, j);
    if (n - j == 2) factor_columns<W, 2>(A, rows, j);
    if (n - j == 3) factor_columns<W, 3>(A, rows, j);
  }

  static BOUGH_INLINE void solve_lower(const double* L, Index ld, Index n, double* z) {
    Index j = 0;
    for (; j + 4 <= n; j += 4) solve_columns<W, 4>(L, ld, n, j, z);
    for (; j < n; ++j) solve_columns<W, 1>(L, ld, n, j, z);
  }

  static BOUGH_INLINE void solve_lower_transposed(const double* L, Index ld, Index n, double* z) {
    const Index blocks = n / 4 * 4;
    for (Index j = n - 1; j >= blocks; --j) solve_columns_transposed<W, 1>(L, ld, n, j, z);
    for (Index j = blocks - 4; j >= 0; j -= 4) solve_columns_transposed<W, 4>(L, ld, n, j, z);
  }
};

#ifdef BOUGH_AVX2
const bool kHasWide = platform::has_avx2();
#define BOUGH_KERNEL(name, parameters, arguments)                        \
  BOUGH_AVX2 void name##_wide parameters { Kernels<4>::name arguments; } \
  void name##_narrow parameters { Kernels<2>::name arguments; }
#define BOUGH_CALL(name, arguments) kHasWide ? name##_wide arguments : name##_narrow arguments
#else
#define BOUGH_KERNEL(name, parameters, arguments) \
  void name##_narrow parameters { Kernels<2>::name arguments; }
#define BOUGH_CALL(name, arguments) name##_narrow arguments
#endif

BOUGH_KERNEL(multiply, (const double* A, Index rows, Index cols, const double* x, double* y), (A, rows, cols, x, y))
BOUGH_KERNEL(multiply_transposed, (const double* A, Index rows, Index cols, const double* x, double* y),
             (A, rows, cols, x, y))
BOUGH_KERNEL(add_product, (const double* A, Index rows, Index r, const double* B, Index m, double* C),
             (A, rows, r, B, m, C))
BOUGH_KERNEL(contract,
             (const double* in, Index stride, const int* offset, Index num, const double* x, Index N, double* out),
             (in, stride, offset, num, x, N, out))
BOUGH_KERNEL(add_scaled, (double a, const double* x, double b, const double* y, Index rows, double* out),
             (a, x, b, y, rows, out))
BOUGH_KERNEL(add_square, (const double* A, const double* V, Index rows, double* C), (A, V, rows, C))
BOUGH_KERNEL(factor_trapezoid, (double* A, Index rows, Index n), (A, rows, n))
BOUGH_KERNEL(solve_lower, (const double* L, Index ld, Index n, double* z), (L, ld, n, z))
BOUGH_KERNEL(solve_lower_transposed, (const double* L, Index ld, Index n, double* z), (L, ld, n, z))

}  // namespace

void multiply(const double* A, Index rows, Index cols, const double* x, double* y) {
  BOUGH_CALL(multiply, (A, rows, cols, x, y));
}
void multiply_transposed(const double* A, Index rows, Index cols, const double* x, double* y) {
  BOUGH_CALL(multiply_transposed, (A, rows, cols, x, y));
}
void add_product(const double* A, Index rows, Index r, const double* B, Index m, double* C) {
  if (r == 0) return;  // nothing is added, and there may be no A and B
  BOUGH_CALL(add_product, (A, rows, r, B, m, C));
}
void contract(const double* in, Index stride, const int* offset, Index num, const double* x, Index N, double* out) {
  BOUGH_CALL(contract, (in, stride, offset, num, x, N, out));
}
void add_scaled(double a, const double* x, double b, const double* y, Index rows, double* out) {
  BOUGH_CALL(add_scaled, (a, x, b, y, rows, out));
}
void add_square(const double* A, const double* V, Index rows, double* C) { BOUGH_CALL(add_square, (A, V, rows, C)); }
void factor_trapezoid(double* A, Index rows, Index n) { BOUGH_CALL(factor_trapezoid, (A, rows, n)); }
void solve_lower(const double* L, Index ld, Index n, double* z) { BOUGH_CALL(solve_lower, (L, ld, n, z)); }
void solve_lower_transposed(const double* L, Index ld, Index n, double* z) {
  BOUGH_CALL(solve_lower_transposed, (L, ld, n, z));
}

}  // namespace bough::solver

#pragma GCC diagnostic pop
