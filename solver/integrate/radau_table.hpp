#pragma once
/// \file Coefficients of Radau IIA collocation, diagonalized.
#include <complex>
#include <vector>

#include <Eigen/Dense>

namespace bough::solver {

/// Radau IIA with s stages, of order 2s - 1, stiffly accurate and L-stable: k_i = f(t + c_i h, y + h Σ A_ij k_j), the
/// solution is the last stage. A⁻¹ has one real eigenvalue and (s - 1)/2 pairs: with Z_i = h Σ A_ij k_j the equations
/// A⁻¹ Z = h F fall apart into λ w = h l F, w = l Z, one for each eigenvalue λ with its left eigenvector l, and
/// Z = Σ w r with the right eigenvectors r, the conjugates included.
/// Source: Hairer and Wanner, "Solving Ordinary Differential Equations II", IV.5 and IV.8.
struct RadauTable {
  /// An eigenvalue of A⁻¹ with positive imaginary part and its eigenvectors, l r = 1.
  struct Pair {
    std::complex<double> value;
    Eigen::RowVectorXcd left;  ///< [1 x s]
    Eigen::VectorXcd right;    ///< [s]
  };

  int stages = 0;
  Eigen::VectorXd c;      ///< [s] nodes, the last is 1
  Eigen::MatrixXd A;      ///< [s x s]
  double real_value = 0;  ///< the real eigenvalue of A⁻¹
  Eigen::RowVectorXd real_left;
  Eigen::VectorXd real_right;
  std::vector<Pair> pairs;
  /// [s] of the error estimate of order s: y* - y = f(t, y) h / real_value + Σ error_i Z_i.
  Eigen::VectorXd error;
  /// [s + 1] barycentric weights of the collocation polynomial, through 0 and the nodes.
  Eigen::VectorXd barycentric;
};

/// \param stages  odd, at least 3.
RadauTable make_radau_table(int stages);

}  // namespace bough::solver
