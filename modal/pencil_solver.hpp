#pragma once
/// \file Roots of K x = λ M x from the lowest up, some at a time.
#include <optional>

#include "fe/linear/factor.hpp"
#include "fe/linear/row_kinds.hpp"
#include "modal/extraction.hpp"
#include "modal/low_rank.hpp"
#include "modal/roots.hpp"
#include "modal/solver_use.hpp"

namespace bough::modal::detail {

struct PencilProblem {
  linear::SymmetricMatrix K, M;
  VectorXd M_diagonal;
  linear::RowKinds kinds;             ///< of the rows
  MatrixXd rigid;                     ///< n x k, M-orthonormal zero-energy motions, known; kept out
  linear::SymmetricMatrix supported;  ///< K with a spring for each rigid-body motion, statically determinate
  bool is_complete = false;           ///< every zero-energy motion is in `rigid`: no look for another
  const linear::SymmetricFactor* factor = nullptr;  ///< of K, where the caller has it
  double tolerance = 1e-12;
  std::string solver = {};  ///< EPS type that is asked for (EigenProblem)
  std::function<void(int converged, int requested)> progress = {};
  std::function<void()> release = {}, restore = {};  ///< of K, where it may be away (EigenProblem)
};

class PencilSolver {
 public:
  /// `request`: as many roots as the caller may ask for at first. Where M has a rank not much above it, the rank is
  /// found (factor_low_rank).
  PencilSolver(const PencilProblem& problem, int request);

  /// Upper bound of the number of elastic eigenvalues; exact if the rank of M is known.
  int num_available() const { return num_available_; }
  /// Returns true if M = C Cᵀ has been found, so that its rank is known.
  bool knows_rank() const { return C_.has_value(); }
  /// Solvers that were used, of all solutions.
  const std::vector<SolverUse>& get_uses() const { return uses_; }

  /// Adds the next `number` roots above those in `roots`, the last `num_guard` of them rough; all that exist where
  /// there are fewer. K + shift M is factored. False where that is singular, or with `definite_only` not definite.
  /// With `supported` that is factored instead, and shift is 0: M x of what is orthogonal to the rigid-body motions is
  /// in balance, so the springs see no force, and their share of the rigid-body motions is projected out of the
  /// solution.
  ///
  /// With M = C Cᵀ of low rank all of them are found again each time, `roots` with them.
  bool solve(double shift, int number, int num_guard, bool definite_only, Roots& roots);

 private:
  void drop_rough(Extraction& result) const;

  PencilProblem problem_;
  std::optional<Eigen::SparseMatrix<double>> C_;
  int num_available_ = 0;
  int round_ = 0;
  FactoredHandle factored_;  ///< of last_shift_, from the second solution on: roots were missed, more may be
  double last_shift_ = 0;
  int num_at_shift_ = 0;  ///< solutions with it
  std::vector<SolverUse> uses_;
};

/// Roots of K x = λ M x below mu by the inertia of K - μM, moved a little where a pivot is zero; -1 where it stays so.
int count_roots_below(const linear::SymmetricMatrix& K, const linear::SymmetricMatrix& M, double mu);

}  // namespace bough::modal::detail
