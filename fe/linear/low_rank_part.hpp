#pragma once
/// \file Symmetric matrices of low rank, U W Uᵀ.
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

namespace bough::linear {

/// U W Uᵀ, n x n, the same on every rank.
struct LowRankPart {
  Eigen::SparseMatrix<double> U;  ///< n x k
  Eigen::MatrixXd W, W_inverse;   ///< k x k, symmetric
  int num_positive = 0;           ///< eigenvalues of W above zero; the others are below

  /// Number k of columns of U.
  int rank() const { return static_cast<int>(W.rows()); }

  /// U W Uᵀ X.
  Eigen::MatrixXd multiply(const Eigen::Ref<const Eigen::MatrixXd>& X) const { return U * (W * (U.transpose() * X)); }
  Eigen::VectorXd calc_diagonal() const;  ///< O(entries of U, times its rank where columns are dense)
};

/// X K Xᵀ, K symmetric; eigenvalues of K that are roundoff are left out.
LowRankPart make_form_part(const Eigen::SparseMatrix<double>& X, const Eigen::MatrixXd& K);
/// V Dᵀ + D Vᵀ + D K Dᵀ of sparse D and V, n x r, and a symmetric K. Where a column of V and that of K are zero, that
/// of D is left out; without V the rank is that of K, else twice the columns.
LowRankPart make_product_part(const Eigen::SparseMatrix<double>& D, const Eigen::SparseMatrix<double>& V,
                              const Eigen::MatrixXd& K);
/// factor A, the factor not zero.
LowRankPart scale(const LowRankPart& part, double factor);
/// factor_a A + factor_b B, the factors not zero.
LowRankPart join(const LowRankPart& a, double factor_a, const LowRankPart& b, double factor_b);
/// Rows and columns `kept` of A, ascending.
LowRankPart take_kept(const LowRankPart& part, const std::vector<int>& kept);

}  // namespace bough::linear
