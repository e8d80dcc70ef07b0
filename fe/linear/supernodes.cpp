#include "fe/linear/supernodes.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "base/diagnostic.hpp"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(BOUGH_NARROW)
#define BOUGH_WIDE __attribute__((target("avx2,fma")))
#endif
#define BOUGH_INLINE inline __attribute__((always_inline))

namespace bough::fe {

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

/// M right-hand sides of one row.
template <int W, int M>
struct Row {
  typename Register<W>::type v[M / W];
};
template <int W, int M>
BOUGH_INLINE void load(const double* p, Row<W, M>& row) {
  __builtin_memcpy(&row.v, p, M * sizeof(double));
}
template <int W, int M>
BOUGH_INLINE void store(double* p, const Row<W, M>& row) {
  __builtin_memcpy(p, &row.v, M * sizeof(double));
}
template <int W, int M>
BOUGH_INLINE void subtract(Row<W, M>& row, double factor, const Row<W, M>& other) {
  for (int r = 0; r < M / W; ++r) row.v[r] -= factor * other.v[r];
}

/// Columns j to j + C of a supernode: their own rows are solved for, the rows below are relieved of them.
template <int W, int M, int C>
BOUGH_INLINE void forward_columns(const double* L, Index ld, Index j, double* z) {
  Row<W, M> x[C];
  for (int c = 0; c < C; ++c) {
    load<W, M>(z + (j + c) * M, x[c]);
    for (int p = 0; p < c; ++p) subtract<W, M>(x[c], L[j + c + (j + p) * ld], x[p]);
    const double inverse = 1 / L[j + c + (j + c) * ld];
    for (int r = 0; r < M / W; ++r) x[c].v[r] *= inverse;
    store<W, M>(z + (j + c) * M, x[c]);
  }
  for (Index i = j + C; i < ld; ++i) {
    Row<W, M> t;
    load<W, M>(z + i * M, t);
    for (int c = 0; c < C; ++c) subtract<W, M>(t, L[i + (j + c) * ld], x[c]);
    store<W, M>(z + i * M, t);
  }
}

template <int W, int M, int C>
BOUGH_INLINE void backward_columns(const double* L, Index ld, Index j, double* z) {
  Row<W, M> x[C];
  for (int c = 0; c < C; ++c) load<W, M>(z + (j + c) * M, x[c]);
  for (Index i = j + C; i < ld; ++i) {
    Row<W, M> t;
    load<W, M>(z + i * M, t);
    for (int c = 0; c < C; ++c) subtract<W, M>(x[c], L[i + (j + c) * ld], t);
  }
  for (int c = C - 1; c >= 0; --c) {
    for (int p = c + 1; p < C; ++p) subtract<W, M>(x[c], L[j + p + (j + c) * ld], x[p]);
    const double inverse = 1 / L[j + c + (j + c) * ld];
    for (int r = 0; r < M / W; ++r) x[c].v[r] *= inverse;
    store<W, M>(z + (j + c) * M, x[c]);
  }
}

template <int W, int M>
struct Kernels {
  static BOUGH_INLINE void forward(const double* L, Index ld, Index num, double* z) {
    Index j = 0;
    for (; j + 4 <= num; j += 4) forward_columns<W, M, 4>(L, ld, j, z);
    for (; j < num; ++j) forward_columns<W, M, 1>(L, ld, j, z);
  }
  static BOUGH_INLINE void backward(const double* L, Index ld, Index num, double* z) {
    const Index blocks = num / 4 * 4;
    for (Index j = num - 1; j >= blocks; --j) backward_columns<W, M, 1>(L, ld, j, z);
    for (Index j = blocks - 4; j >= 0; j -= 4) backward_columns<W, M, 4>(L, ld, j, z);
  }
};

using Kernel = void (*)(const double* L, Index ld, Index num, double* z);

#ifdef BOUGH_WIDE
const bool kHasWide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#define BOUGH_KERNEL(name, M)                                                                                     \
  BOUGH_WIDE void name##_wide_##M(const double* L, Index ld, Index num, double* z) {                              \
    Kernels<4, M>::name(L, ld, num, z);                                                                           \
  }                                                                                                               \
  void name##_narrow_##M(const double* L, Index ld, Index num, double* z) { Kernels<2, M>::name(L, ld, num, z); } \
  Kernel get_##name##_##M() { return kHasWide ? name##_wide_##M : name##_narrow_##M; }
#else
#define BOUGH_KERNEL(name, M)                                                                                     \
  void name##_narrow_##M(const double* L, Index ld, Index num, double* z) { Kernels<2, M>::name(L, ld, num, z); } \
  Kernel get_##name##_##M() { return name##_narrow_##M; }
#endif
BOUGH_KERNEL(forward, 4)
BOUGH_KERNEL(forward, 8)
BOUGH_KERNEL(backward, 4)
BOUGH_KERNEL(backward, 8)

/// Of the rows of the largest supernode.
std::vector<double> make_room(const Supernodes& L, Index m) {
  int most = 0;
  for (int k = 0; k < L.num; ++k) most = std::max(most, L.row_at[k + 1] - L.row_at[k]);
  return std::vector<double>(static_cast<std::size_t>(most * m));
}

}  // namespace

void solve_lower(const Supernodes& L, Eigen::MatrixXd& Z) {
  const Index m = Z.rows();
  BOUGH_DEMAND(m == kFewSides || m == kManySides);
  const Kernel forward = m == kFewSides ? get_forward_4() : get_forward_8();
  std::vector<double> room = make_room(L, m);
  double* z = room.data();
  for (int k = 0; k < L.num; ++k) {
    const Index num = L.super[k + 1] - L.super[k], num_rows = L.row_at[k + 1] - L.row_at[k];
    double* own = Z.data() + L.super[k] * m;
    std::memcpy(z, own, static_cast<std::size_t>(num * m) * sizeof(double));
    std::fill(z + num * m, z + num_rows * m, 0.0);
    forward(L.value + L.value_at[k], num_rows, num, z);
    std::memcpy(own, z, static_cast<std::size_t>(num * m) * sizeof(double));
    const int* row = L.row + L.row_at[k];
    for (Index i = num; i < num_rows; ++i) {
      double* to = Z.data() + row[i] * m;
      for (Index c = 0; c < m; ++c) to[c] += z[i * m + c];
    }
  }
}

void solve_lower_transposed(const Supernodes& L, Eigen::MatrixXd& Z) {
  const Index m = Z.rows();
  BOUGH_DEMAND(m == kFewSides || m == kManySides);
  const Kernel backward = m == kFewSides ? get_backward_4() : get_backward_8();
  std::vector<double> room = make_room(L, m);
  double* z = room.data();
  for (int k = L.num - 1; k >= 0; --k) {
    const Index num = L.super[k + 1] - L.super[k], num_rows = L.row_at[k + 1] - L.row_at[k];
    const int* row = L.row + L.row_at[k];
    for (Index i = 0; i < num_rows; ++i)
      std::memcpy(z + i * m, Z.data() + row[i] * m, static_cast<std::size_t>(m) * sizeof(double));
    backward(L.value + L.value_at[k], num_rows, num, z);
    std::memcpy(Z.data() + L.super[k] * m, z, static_cast<std::size_t>(num * m) * sizeof(double));
  }
}

}  // namespace bough::fe
