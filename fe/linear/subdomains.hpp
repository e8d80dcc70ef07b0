#pragma once
/// \file The rows of a large matrix cut among the ranks, products with what each keeps, and LLᵀ by substructures.
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include "fe/linear/petsc.hpp"

namespace bough::fe {

class PartFactor;

/// Smaller matrices are solved sooner than they are cut.
constexpr PetscInt kLeastSubdomainRows = 5000;

/// `inner` rows of one rank couple to none of another rank; `between` lie those that couple ranks. A rank keeps of
/// vectors its own rows: the inner ones, then its share of those between.
struct Subdomains {
  std::vector<PetscInt> inner;                ///< this rank's, in the order of their elimination
  std::vector<PetscInt> between;              ///< the same on every rank
  PetscInt first_shared = 0, num_shared = 0;  ///< the share of `between`
  PetscInt size = 0;                          ///< rows on all ranks

  PetscInt num_inner() const { return static_cast<PetscInt>(inner.size()); }
  PetscInt num_between() const { return static_cast<PetscInt>(between.size()); }
  PetscInt num_own() const { return num_inner() + num_shared; }
  /// The row of A that is the i-th own one.
  PetscInt get_row(PetscInt i) const { return i < num_inner() ? inner[i] : between[first_shared + i - num_inner()]; }

  /// The own rows of a replicated X, and the replicated one of own rows. The latter is collective.
  Eigen::MatrixXd take_own(const Eigen::Ref<const Eigen::MatrixXd>& X) const;
  Eigen::MatrixXd replicate(const Eigen::MatrixXd& own) const;
};

/// Of A and B together, which may couple other rows each. By METIS from the graph of the row groups of A (ordering.hpp)
/// on the first rank: as many parts as ranks, of a cut edge one
/// end lies between; the inner rows by nested dissection on each. Collective. Empty, alike on every rank: one process,
/// no groups, a low-rank part, less than `least` rows, or so many between that their dense block costs more than the
/// parts save.
std::optional<Subdomains> find_subdomains(Mat A, Mat B, PetscInt least = kLeastSubdomainRows);

/// What a rank keeps of a symmetric A, which couples no inner rows of two ranks: its inner rows, and of those between
/// the block A_ss, both with columns in the order inner, between.
class SubdomainMatrix {
 public:
  /// Collective, as all that follows.
  SubdomainMatrix(Mat A, const Subdomains& domains);
  /// Own rows of A X of own rows X: two sums over ranks of as many rows as lie between.
  Eigen::MatrixXd multiply(const Eigen::Ref<const Eigen::MatrixXd>& X) const;
  const Eigen::SparseMatrix<double, Eigen::RowMajor>& rows() const { return rows_; }

 private:
  const Subdomains& domains_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows_;  ///< num_inner + num_between, square
};

/// LLᵀ of a positive definite A: each rank eliminates its inner rows, the Schur complement of the rows between is
/// summed and factored as a dense matrix by all alike (supernodal_factor.hpp has two threads for the ranks).
class SubdomainFactor {
 public:
  /// Throws "fe.out-of-memory".
  SubdomainFactor(Mat A, const Subdomains& domains);
  ~SubdomainFactor();
  SubdomainFactor(const SubdomainFactor&) = delete;
  SubdomainFactor& operator=(const SubdomainFactor&) = delete;

  bool is_definite() const { return is_definite_; }  ///< alike on every rank
  /// Own rows of X with A X = B of own rows B.
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const;

 private:
  const Subdomains& domains_;
  std::unique_ptr<PartFactor> part_;
  Eigen::MatrixXd L_;
  bool is_definite_ = false;
};

}  // namespace bough::fe
