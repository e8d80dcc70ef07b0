#include "fe/linear/supernodes.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "base/diagnostic.hpp"
#include "fe/linear/wide.hpp"

namespace bough::linear {

using Eigen::Index;

namespace {

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
/// \return the end of their entries.
template <int W, int M, int C>
BOUGH_INLINE const double* forward_group(const double* L, Index ld, Index j, double* z) {
  Row<W, M> x[C];
  for (int c = 0; c < C; ++c) {
    load<W, M>(z + (j + c) * M, x[c]);
    for (int p = 0; p < c; ++p) subtract<W, M>(x[c], *L++, x[p]);
    const double inverse = *L++;
    for (int r = 0; r < M / W; ++r) x[c].v[r] *= inverse;
    store<W, M>(z + (j + c) * M, x[c]);
  }
  for (Index i = j + C; i < ld; ++i, L += C) {
    Row<W, M> t;
    load<W, M>(z + i * M, t);
    for (int c = 0; c < C; ++c) subtract<W, M>(t, L[c], x[c]);
    store<W, M>(z + i * M, t);
  }
  return L;
}

/// Solves a group of columns with Lᵀ, from the end of their entries. \return their begin.
template <int W, int M, int C>
BOUGH_INLINE const double* backward_group(const double* L, Index ld, Index j, double* z) {
  Row<W, M> x[C];
  for (int c = 0; c < C; ++c) load<W, M>(z + (j + c) * M, x[c]);
  for (Index i = ld - 1; i >= j + C; --i) {
    L -= C;
    Row<W, M> t;
    load<W, M>(z + i * M, t);
    for (int c = 0; c < C; ++c) subtract<W, M>(x[c], L[c], t);
  }
  for (int c = C - 1; c >= 0; --c) {
    const double inverse = *--L;
    for (int r = 0; r < M / W; ++r) x[c].v[r] *= inverse;
    store<W, M>(z + (j + c) * M, x[c]);
    for (int p = c - 1; p >= 0; --p) subtract<W, M>(x[p], *--L, x[c]);
  }
  return L;
}

template <int W, int M>
struct Kernels {
  static BOUGH_INLINE const double* forward(const double* L, Index ld, Index num, double* z) {
    Index j = 0;
    for (; j + 4 <= num; j += 4) L = forward_group<W, M, 4>(L, ld, j, z);
    if (num - j == 1) L = forward_group<W, M, 1>(L, ld, j, z);
    if (num - j == 2) L = forward_group<W, M, 2>(L, ld, j, z);
    if (num - j == 3) L = forward_group<W, M, 3>(L, ld, j, z);
    return L;
  }
  static BOUGH_INLINE const double* backward(const double* L, Index ld, Index num, double* z) {
    Index j = num / 4 * 4;
    if (num - j == 1) L = backward_group<W, M, 1>(L, ld, j, z);
    if (num - j == 2) L = backward_group<W, M, 2>(L, ld, j, z);
    if (num - j == 3) L = backward_group<W, M, 3>(L, ld, j, z);
    for (j -= 4; j >= 0; j -= 4) L = backward_group<W, M, 4>(L, ld, j, z);
    return L;
  }
};

using Kernel = const double* (*)(const double* L, Index ld, Index num, double* z);

#ifdef BOUGH_AVX2
#define BOUGH_KERNEL(name, M)                                                                 \
  BOUGH_AVX2 const double* name##_wide_##M(const double* L, Index ld, Index num, double* z) { \
    return Kernels<4, M>::name(L, ld, num, z);                                                \
  }                                                                                           \
  const double* name##_narrow_##M(const double* L, Index ld, Index num, double* z) {          \
    return Kernels<2, M>::name(L, ld, num, z);                                                \
  }                                                                                           \
  Kernel get_##name##_##M() { return platform::has_avx2() ? name##_wide_##M : name##_narrow_##M; }
#else
#define BOUGH_KERNEL(name, M)                                                        \
  const double* name##_narrow_##M(const double* L, Index ld, Index num, double* z) { \
    return Kernels<2, M>::name(L, ld, num, z);                                       \
  }                                                                                  \
  Kernel get_##name##_##M() { return name##_narrow_##M; }
#endif
BOUGH_KERNEL(forward, 4)
BOUGH_KERNEL(forward, 8)
BOUGH_KERNEL(backward, 4)
BOUGH_KERNEL(backward, 8)

/// Workspace for the rows of the largest supernode.
std::vector<double> make_room(const Supernodes& L, Index m) {
  int max_rows = 0;
  for (int k = 0; k < L.num; ++k) max_rows = std::max(max_rows, L.row_at[k + 1] - L.row_at[k]);
  return std::vector<double>(static_cast<std::size_t>(max_rows * m));
}

template <int M>
void solve_forward(const Supernodes& L, Kernel forward, double* Z) {
  std::vector<double> room = make_room(L, M);
  double* z = room.data();
  const double* value = L.value;
  for (int k = 0; k < L.num; ++k) {
    const Index num = std::min(L.super[k + 1], L.size) - L.super[k], ld = L.row_at[k + 1] - L.row_at[k];
    const int* row = L.row + L.row_at[k];
    double* own = Z + Index{L.super[k]} * M;
    std::memcpy(z, own, static_cast<std::size_t>(num * M) * sizeof(double));
    std::fill(z + num * M, z + ld * M, 0.0);
    value = forward(value, ld, num, z);
    std::memcpy(own, z, static_cast<std::size_t>(num * M) * sizeof(double));
    for (Index i = num; i < ld; ++i) {
      double* to = Z + Index{row[i]} * M;
      for (int c = 0; c < M; ++c) to[c] += z[i * M + c];
    }
  }
}

template <int M>
void solve_backward(const Supernodes& L, Kernel backward, double* Z) {
  std::vector<double> room = make_room(L, M);
  double* z = room.data();
  const double* value = L.value + L.num_values;
  for (int k = L.num - 1; k >= 0; --k) {
    const Index num = std::min(L.super[k + 1], L.size) - L.super[k], ld = L.row_at[k + 1] - L.row_at[k];
    const int* row = L.row + L.row_at[k];
    for (Index i = 0; i < ld; ++i) std::memcpy(z + i * M, Z + Index{row[i]} * M, M * sizeof(double));
    value = backward(value, ld, num, z);
    std::memcpy(Z + Index{L.super[k]} * M, z, static_cast<std::size_t>(num * M) * sizeof(double));
  }
}

}  // namespace

std::ptrdiff_t pack_supernodes(const Supernodes& L, const int* value_at, double* value) {
  std::vector<double> columns;
  double* to = value;
  for (int k = 0; k < L.num; ++k) {
    const Index num = std::min(L.super[k + 1], L.size) - L.super[k], ld = L.row_at[k + 1] - L.row_at[k];
    for (Index j = 0; j < num; j += 4) {
      const Index width = std::min<Index>(4, num - j);
      // A copy: the packed data may overlap the data still to be read, but not pass it.
      const double* from = value + value_at[k] + j * ld;
      columns.assign(from, from + width * ld);
      for (Index i = 0; i < width; ++i) {
        for (Index c = 0; c < i; ++c) *to++ = columns[static_cast<std::size_t>(j + i + c * ld)];
        *to++ = 1 / columns[static_cast<std::size_t>(j + i + i * ld)];
      }
      for (Index i = j + width; i < ld; ++i)
        for (Index c = 0; c < width; ++c) *to++ = columns[static_cast<std::size_t>(i + c * ld)];
    }
  }
  return to - value;
}

namespace {

/// few() for kNarrowRhs right-hand sides, many() for kWideRhs, which are the rows of Z.
template <class Few, class Many>
void solve_by_width(const Eigen::MatrixXd& Z, const Few& few, const Many& many) {
  BOUGH_DEMAND(Z.rows() == kNarrowRhs || Z.rows() == kWideRhs);
  if (Z.rows() == kNarrowRhs)
    few();
  else
    many();
}

}  // namespace

void solve_lower(const Supernodes& L, Eigen::MatrixXd& Z) {
  solve_by_width(
      Z, [&] { solve_forward<kNarrowRhs>(L, get_forward_4(), Z.data()); },
      [&] { solve_forward<kWideRhs>(L, get_forward_8(), Z.data()); });
}

void solve_lower_transposed(const Supernodes& L, Eigen::MatrixXd& Z) {
  solve_by_width(
      Z, [&] { solve_backward<kNarrowRhs>(L, get_backward_4(), Z.data()); },
      [&] { solve_backward<kWideRhs>(L, get_backward_8(), Z.data()); });
}

}  // namespace bough::linear
