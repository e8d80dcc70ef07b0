#pragma once
/// \file Polynomials of modal amplitudes, with gradients and rates (docs/theory/third-order.md; packed as
/// records::ThirdOrder).
#include <array>
#include <utility>
#include <vector>

#include "formats/records/third_order.hpp"
#include "solver/bodies/spatial.hpp"

namespace bough::solver {

/// Numbers of the large amplitudes among those of all modes, or N combinations of these.
struct LargeAmplitudes {
  std::vector<int> modes;
  MatrixXd directions;  ///< N x n, as of records::ThirdOrder; empty: the modes

  LargeAmplitudes() = default;
  /// The amplitudes of these modes.
  LargeAmplitudes(std::vector<int> large) : modes(std::move(large)) {}
  /// Large amplitudes of a body of third order.
  explicit LargeAmplitudes(const records::ThirdOrder& third) : modes(third.large), directions(third.directions) {}
  /// Number N of large amplitudes.
  Eigen::Index size() const { return static_cast<Eigen::Index>(modes.size()); }
  /// Values of N amplitudes from those of all modes. No allocation.
  void get(const ConstVectorRef& all, double* values) const;
};

/// m polynomials of degrees 2 (all n amplitudes) to 4 (the N large ones), by their symmetric derivative tensors.
///
/// Degree 4: its third derivatives D4 η, from them the second ones, gradients and values by Euler, each a sum over N
/// rows per entry; so for degree 3. Rows are `stride` doubles, one per polynomial.
class Polynomials {
 public:
  static constexpr int kMaxDegree = 4, kMaxStride = 128;
  /// Rows of scratch at most: C(N + 2, 3) + 3 C(N + 1, 2) + 2 N of 8 large modes.
  static constexpr int kMaxScratchRows = 244;

  Polynomials() = default;
  Polynomials(int n, LargeAmplitudes large, int m);

  /// Adds c (monomials of the degree in the modes `variables`, packed, x m). Degrees 3 and 4: the large modes.
  void add(int degree, const std::vector<int>& variables, const MatrixXd& c);

  /// Returns true if there are no polynomials.
  bool empty() const { return m_ == 0; }
  /// Returns true if every coefficient is 0.
  bool is_zero() const { return G2_.isZero(0) && D3_.isZero(0) && D4_.isZero(0); }
  /// Number m of polynomials.
  int num_values() const { return m_; }
  Eigen::Index stride() const { return stride_; }  ///< rows of J: m, padded (kernels.hpp)
  /// Number of doubles that calc() needs as scratch.
  Eigen::Index scratch_size() const { return stride_ * scratch_rows_; }

  /// J = ∂p/∂η (stride x n) and the values (m). scratch: scratch_size(); begins with the second derivatives of degrees
  /// 3 and 4 by two large modes f ≤ g, stride x pairs in lexical order. No allocation.
  void calc(const ConstVectorRef& eta, double* J, double* value, double* scratch) const;
  /// J̇η̇: the values' second derivatives by time at η̈ = 0 (stride). scratch: of the last calc(). No allocation.
  void calc_bias(const ConstVectorRef& eta_dot, const double* scratch, double* bias) const;

 private:
  int m_ = 0, n_ = 0, scratch_rows_ = 0;
  Eigen::Index stride_ = 0;
  LargeAmplitudes large_;
  MatrixXd G2_;       ///< (stride n) x n: row q + stride j of column k is ∂²p_q/∂η_j∂η_k
  MatrixXd D3_, D4_;  ///< stride x entries i ≤ j ≤ k (≤ l) in lexical order; empty: no such degree
  std::array<std::vector<int>, 3> to_;  ///< [r]: entry of each of r + 1 sorted factors and one more, N per entry
};

/// A polynomial of degrees 2 (all n amplitudes) to max_degree (the N large ones) by its gradient.
class Potential {
 public:
  Potential() = default;
  Potential(int n, LargeAmplitudes large, int max_degree);

  /// Adds c (monomials of the degree in the modes `variables`, packed). Degrees from 3 on: the large modes.
  void add(int degree, const std::vector<int>& variables, const VectorXd& c);

  /// Returns true if there is no polynomial.
  bool empty() const { return n_ == 0; }
  /// Multiplies all coefficients.
  Potential& operator*=(double factor);

  /// Value, and its gradient (n). No allocation.
  double calc(const ConstVectorRef& eta, double* gradient) const;

 private:
  /// Monomials of the degrees 2 to 5 in 8 large modes, each degree padded.
  static constexpr int kMaxMonomials = 36 + 120 + 332 + 792;

  /// Monomials of one degree in lexical order of their sorted factors, for the gradient of the next degree.
  struct Degree {
    int first = 0, size = 0, padded = 0;  ///< among all monomials
    std::vector<int> start;               ///< N: first monomial without factors before this mode
    MatrixXd G;                           ///< padded x N: ∂/∂η_f of the terms of one degree more
  };
  int n_ = 0;
  LargeAmplitudes large_;
  MatrixXd G2_;                  ///< n x n, second derivatives; empty: zero
  std::vector<Degree> degrees_;  ///< of monomials, 1 to max_degree - 1
};

}  // namespace bough::solver
