#pragma once
/// \file Symmetric matrices that are sparse but for a part of low rank, A = A_0 + U W Uᵀ, as PETSc matrices of their
/// own type (docs/adr/0013-wide-constraints.md).
///
/// PETSc multiplies vectors by them and refuses all else, so nothing takes the sparse part for the whole unseen: it
/// goes through the functions here and in factor.hpp.
#include <vector>

#include <Eigen/SparseCore>

#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// U W Uᵀ of an n x n matrix, the same on every rank.
struct LowRankPart {
  Eigen::SparseMatrix<double> U;  ///< n x k
  Eigen::MatrixXd W, W_inverse;   ///< k x k, symmetric
  int num_positive = 0;           ///< eigenvalues of W above zero; the others are below

  int rank() const { return static_cast<int>(W.rows()); }

  /// U W Uᵀ X.
  Eigen::MatrixXd multiply(const Eigen::Ref<const Eigen::MatrixXd>& X) const { return U * (W * (U.transpose() * X)); }
  Eigen::VectorXd calc_diagonal() const;  ///< O(entries of U, times its rank where columns are dense)
};

/// X K Xᵀ, K symmetric; what of K is roundoff beside the rest is left out.
LowRankPart make_form_part(const Eigen::SparseMatrix<double>& X, const Eigen::MatrixXd& K);
/// V Dᵀ + D Vᵀ + D K Dᵀ of sparse D and V, n x r, and a symmetric K. Where a column of V and that of K are zero, that
/// of D is left out; without V the rank is that of K, else twice the columns.
LowRankPart make_product_part(const Eigen::SparseMatrix<double>& D, const Eigen::SparseMatrix<double>& V,
                              const Eigen::MatrixXd& K);
/// Both parts, each times a factor that is not zero.
LowRankPart join(const LowRankPart& a, double factor_a, const LowRankPart& b, double factor_b);

/// A_0 + U W Uᵀ; A_0 itself where the part has rank zero.
PetscMat make_sum(PetscMat sparse, LowRankPart part);
/// A_0 and U W Uᵀ of any matrix: itself and nullptr when it is sparse alone. They live as long as A.
Mat get_sparse(Mat A);
const LowRankPart* find_low_rank(Mat A);

/// A copy, to be changed by get_sparse(); it has A's row groups.
PetscMat copy(Mat A);
/// A + factor B, symmetric, with the row groups of A.
PetscMat add(Mat A, double factor, Mat B);
/// A + diag(d), d replicated.
PetscMat add_diagonal(Mat A, const Eigen::VectorXd& d);
/// factor A.
PetscMat scale(Mat A, double factor);
/// Rows and columns `kept` of A, ascending.
PetscMat take_kept(Mat A, const std::vector<int>& kept);

}  // namespace bough::fe
