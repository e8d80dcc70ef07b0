#pragma once
/// \file The few dense loops that an evaluation of flexible bodies lives in, for matrices of 5 to 100 rows: there a
/// library's packing and blocking cost more than the product (ADR 0017). Columns are contiguous, `ld` apart; where it
/// says padded, rows are a multiple of four, with zeros (or anything, where said) below the last. Compiled for
/// processors with AVX2 and without; which is used is found at the start of the program. No allocation.
#include <Eigen/Core>

namespace bough::solver {

/// Rounds a number of rows up to a multiple of four.
inline Eigen::Index pad(Eigen::Index n) { return (n + 3) / 4 * 4; }

/// y = A x; A: rows (padded) x cols.
void multiply(const double* A, Eigen::Index rows, Eigen::Index cols, const double* x, double* y);

/// y = Aᵀ x; A: rows (padded) x cols, x: rows.
void multiply_transposed(const double* A, Eigen::Index rows, Eigen::Index cols, const double* x, double* y);

/// C += A B; A: rows (padded) x r, B: r x m, C: rows x m.
void add_product(const double* A, Eigen::Index rows, Eigen::Index r, const double* B, Eigen::Index m, double* C);

/// Rows of `stride` (padded) doubles: out_t = Σ_f x_f (row at in + offset[t N + f]) over N factors, for t < num.
void contract(const double* in, Eigen::Index stride, const int* offset, Eigen::Index num, const double* x,
              Eigen::Index N, double* out);

/// out += a x + b y; rows: padded.
void add_scaled(double a, const double* x, double b, const double* y, Eigen::Index rows, double* out);

/// Lower triangle of C = A + V Vᵀ and some of what is above; A, C: rows x rows, V: rows x 12, all padded.
void add_square(const double* A, const double* V, Eigen::Index rows, double* C);

/// Factors the trapezoid [D; Wᵀ] in place: L of D = LLᵀ, and (L⁻¹W)ᵀ below it. D: n x n, its lower triangle is read;
/// `rows` counts all rows, with padding of any value. A pivot that is not positive leaves NaN from its column on.
void factor_trapezoid(double* A, Eigen::Index rows, Eigen::Index n);

/// z = L⁻¹z and z = L⁻ᵀz; L: n x n, its lower triangle is read.
void solve_lower(const double* L, Eigen::Index ld, Eigen::Index n, double* z);
void solve_lower_transposed(const double* L, Eigen::Index ld, Eigen::Index n, double* z);

}  // namespace bough::solver
