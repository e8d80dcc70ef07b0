#pragma once
/// \file Polynomials of modal amplitudes, with gradients and rates (docs/theory/third-order.md; packed as
/// records::ThirdOrder).
#include <vector>

#include "formats/records/third_order.hpp"
#include "solver/bodies/spatial.hpp"

namespace bough::solver {

/// Monomials of all n amplitudes to degree 1 and of the large ones to a higher degree, as gradients of polynomials have
/// them.
class MonomialList {
 public:
  static constexpr int kMaxSize = 2048;  ///< 8 large modes of 64
  /// On the stack.
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxSize, 1>;

  MonomialList() = default;
  /// Lists the monomials of n amplitudes up to `degree`; `large`: modes of degrees above 1, ascending.
  MonomialList(int n, const std::vector<int>& large, int degree);

  /// Number n of amplitudes.
  int num_modes() const { return n_; }
  /// Indices of the large modes, ascending.
  const std::vector<int>& large() const { return large_; }
  /// Highest degree.
  int degree() const { return static_cast<int>(first_.size()) - 1; }
  /// Number of monomials of degrees 1 to `degree`.
  int size(int degree) const { return first_[static_cast<std::size_t>(degree)]; }
  int size() const { return first_.back(); }
  /// Position of the monomial whose factors are these modes, ascending.
  int find(const std::vector<int>& factors) const;

  /// Values z, the first size(degree) of them.
  void calc(const ConstVectorRef& eta, int degree, double* z) const;
  /// ż, after calc.
  void calc_rates(const ConstVectorRef& eta, const ConstVectorRef& eta_dot, int degree, const double* z,
                  double* z_dot) const;

 private:
  int n_ = 0;
  std::vector<int> large_;
  std::vector<int> first_{0};       ///< [k]: number of monomials of degrees 1 to k
  std::vector<int> parent_, last_;  ///< z_i = z_parent η_last; those of degree 1: -1
  std::vector<std::vector<int>> factors_;
};

/// m polynomials without terms of degrees 0 and 1, by their gradients: one product gives J = ∂p/∂η.
class Polynomials {
 public:
  Polynomials() = default;
  /// stride: rows per mode, 0: m, padded (kernels.hpp).
  Polynomials(const MonomialList& list, int m, int max_degree, Eigen::Index stride = 0);

  /// Adds c (monomials of the degree in the modes `variables`, packed, x m).
  void add(const MonomialList& list, int degree, const std::vector<int>& variables, const MatrixXd& c);

  /// Returns true if no term has been added.
  bool empty() const { return degree_ == 0; }
  /// Multiplies all coefficients.
  Polynomials& operator*=(double factor) {
    G_ *= factor;
    return *this;
  }
  /// Returns true if every coefficient is 0.
  bool is_zero() const { return G_.isZero(0); }
  /// Number m of polynomials.
  int num_values() const { return m_; }
  Eigen::Index stride() const { return stride_; }  ///< rows of J, padded
  /// Highest degree of the polynomials; 0 without terms.
  int degree() const { return degree_; }

  /// J (stride x n) and the values (m). z: the list's, to degree() - 1. No allocation.
  void calc(const MonomialList& list, const ConstVectorRef& eta, const double* z, double* J, double* value) const;
  /// J̇η̇: the values' second derivatives by time at η̈ = 0 (m). Scratch J_dot: stride x n. No allocation.
  void calc_bias(const MonomialList& list, const ConstVectorRef& eta_dot, const double* z_dot, double* J_dot,
                 double* bias) const;

 private:
  int m_ = 0, n_ = 0, degree_ = 0;
  Eigen::Index stride_ = 0;
  MatrixXd G_;  ///< (stride n) x monomials: row q + stride j is ∂p_q/∂η_j
};

}  // namespace bough::solver
