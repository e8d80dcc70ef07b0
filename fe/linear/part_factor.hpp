#pragma once
/// \file One subdomain of a positive definite matrix, with the separator rows.
///
/// Internal to linear.
#include <vector>

#include "fe/linear/cholmod_factor.hpp"
#include "fe/linear/cholmod_view.hpp"
#include "fe/linear/dissection.hpp"
#include "fe/linear/supernodes.hpp"

namespace bough::linear {

/// Factor of one subdomain with the separator rows: its LLᵀ by CHOLMOD, and the trailing block of that as a dense
/// matrix (substructures: Przemieniecki, AIAA J. 1 (1963) 138).
class PartFactor {
 public:
  PartFactor() {
    start_in_order(common_);
    common_.final_ll = 1;
    common_.quick_return_if_not_posdef = 1;
  }
  PartFactor(const PartFactor&) = delete;
  PartFactor& operator=(const PartFactor&) = delete;
  ~PartFactor() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }

  /// (K_pp, K_ps; K_sp, D_p), D_p = K_ss / num_parts + δ, in the order of `own`, postordered, then `between`, in which
  /// what does not couple is sorted too. A: size x size. False where CHOLMOD wants another order or no supernodes.
  bool analyse(const MatrixRows& A, PetscInt size, std::vector<PetscInt> own, const std::vector<PetscInt>& between,
               const Eigen::VectorXd& delta, int num_parts);
  /// Number of entries of L; after analyse().
  double num_entries() const { return common_.lnz; }
  /// False: not positive definite.
  bool factor();
  /// L_ss L_ssᵀ = D_p - K_sp K_pp⁻¹ K_ps, once after factor(): L_ss is not kept, since no solution needs it.
  Eigen::MatrixXd take_schur();
  /// K_pp z = B_p as far as L goes; `carried`, kNarrowRhs or kWideRhs x separator rows, becomes K_sp K_pp⁻¹ B_p.
  void forward(const Eigen::Ref<const Eigen::MatrixXd>& B, Eigen::MatrixXd& carried);
  /// Then X_p, from the solution of the separator rows.
  void backward(const Eigen::MatrixXd& X_s, Eigen::Ref<Eigen::MatrixXd> X);

 private:
  /// The lower triangle of `rows`, of which the first are the interior rows.
  void take(const MatrixRows& A, const std::vector<PetscInt>& rows, std::size_t num_own, const Eigen::VectorXd& delta,
            double share);
  /// Stores the columns of the interior rows, packed, and those of the separator rows as L_ss_.
  void pack();

  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  std::vector<int> start_, row_;
  std::vector<double> value_;
  std::vector<PetscInt> rows_;  ///< of A, in the order of L; those of the part alone
  Eigen::Index num_between_ = 0;
  std::vector<int> between_;  ///< for each of the last rows of L its index among the separator rows
  Supernodes supernodes_;     ///< (L_pp; L_sp), in the memory of factor_
  Eigen::MatrixXd L_ss_;      ///< lower
  Eigen::MatrixXd Z_;         ///< right-hand sides x rows of L
};

/// L of the symmetric S in its place (lower); false: not positive definite.
bool factor_dense(Eigen::MatrixXd& S);
/// X becomes (L Lᵀ)⁻¹ X.
void solve_dense(const Eigen::MatrixXd& L, Eigen::MatrixXd& X);
/// Shift δ_i = √A_ii Σ_j |A_ij| / √A_jj of the separator rows, j in `rows`: diag δ - A_ss is semidefinite, since A_ss
/// scaled to a unit diagonal is dominated by its row sums. The shift scales with the rows, so that translations and
/// rotations lose equally few digits to it in any unit of length.
/// \param A  size x size, symmetric.
/// \return one per row of `rows`; 0 if the diagonal entry is not positive (A is not definite then).
Eigen::VectorXd calc_separator_shift(const MatrixRows& A, const std::vector<PetscInt>& rows, PetscInt size);

}  // namespace bough::linear
