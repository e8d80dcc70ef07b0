#pragma once
/// \file The rows of a large matrix cut among the ranks, products with what each keeps, and LLᵀ by substructures.
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/SparseCore>

// First: the BLAS header of its own includes needs PETSc's own names.
#include "fe/linear/petsc.hpp"

#include "base/diagnostic.hpp"
#include "fe/linear/dissection.hpp"

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
  bool by_parts = false;                      ///< a rank's rows are those that PETSc gives it

  PetscInt num_inner() const { return static_cast<PetscInt>(inner.size()); }
  PetscInt num_between() const { return static_cast<PetscInt>(between.size()); }
  PetscInt num_own() const { return num_inner() + num_shared; }
  /// The row of A that is the i-th own one.
  PetscInt get_row(PetscInt i) const { return i < num_inner() ? inner[i] : between[first_shared + i - num_inner()]; }

  PetscInt find_first_row() const;  ///< the lowest own one

  /// The own rows of a replicated X, and the replicated one of own rows. The latter is collective.
  Eigen::MatrixXd take_own(const Eigen::Ref<const Eigen::MatrixXd>& X) const;
  Eigen::MatrixXd replicate(const Eigen::MatrixXd& own) const;
  /// The same of vectors as find_own_rows() has them of the matrix that is cut: by parts nothing is sent.
  Eigen::MatrixXd from_rows(const Eigen::Ref<const Eigen::MatrixXd>& X) const;
  Eigen::MatrixXd to_rows(const Eigen::MatrixXd& own) const;
};

/// Of A and B together, which may couple other rows each. As many parts as ranks, of a cut edge one end lies between:
/// the parts of the model where the rows are dealt out by them (ordering.hpp), else by METIS from the graph of the row
/// groups of A on the first rank; the inner rows by nested dissection on each. Collective. Empty, alike on every rank:
/// one process, no groups, a low-rank part, less than `least` rows, or so many between that their dense block costs
/// more than the parts save. A keeps them for B.
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
  MatrixRows as_rows() const { return {rows_.outerIndexPtr(), rows_.innerIndexPtr(), rows_.valuePtr()}; }

 private:
  const Subdomains& domains_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows_;  ///< num_inner + num_between, square
};

/// Throws where the ranks of one machine together need more memory than it has free for factors, `otherwise` on those
/// that cannot say why. Collective.
void require_memory_of_ranks(double num_rows, double num_entries, const ComputationError& otherwise);

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
