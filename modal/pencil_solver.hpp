#pragma once
/// \file Roots of K x = λ M x from the lowest up: a mass matrix of low rank solved whole, any other by Krylov.
#include <optional>

#include "fe/linear/factor.hpp"
#include "fe/linear/own_rows.hpp"
#include "fe/linear/row_kinds.hpp"
#include "modal/krylov.hpp"
#include "modal/low_rank.hpp"
#include "modal/roots.hpp"

namespace bough::modal::detail {

struct PencilProblem {
  Mat K = nullptr, M = nullptr;
  VectorXd M_diagonal;                          ///< whole, as what follows
  fe::RowKinds kinds;                           ///< of the rows
  fe::OwnRows rows;                             ///< of vectors
  MatrixXd rigid;                               ///< rows.num x k, M-orthonormal motions without strain, known; kept out
  Mat supported = nullptr;                      ///< K with a spring for each rigid motion, statically determinate
  bool is_complete = false;                     ///< every motion without strain is in `rigid`: no look for another
  const fe::SymmetricFactor* factor = nullptr;  ///< of K, where the caller has it
  double tolerance = 1e-12;
  KrylovMethod method = KrylovMethod::Fastest;
  std::function<void(int converged, int wanted)> progress = {};
  std::function<void()> release = {}, restore = {};  ///< of K, where it may be away (KrylovProblem)
};

class PencilSolver {
 public:
  /// `request`: as many roots as the caller may ask for at first. Where M has a rank not much above it, the rank is
  /// found (factor_low_rank).
  PencilSolver(const PencilProblem& problem, int request);

  /// No more roots than this exist beside the rigid motions; exact where the rank of M is known.
  int num_available() const { return num_available_; }
  bool knows_rank() const { return C_.has_value(); }

  /// Adds the next `number` roots above those in `roots`, the last `num_guard` of them rough; all that exist where
  /// there are fewer. K + shift M is factored. False where that is singular, or with `definite_only` not definite.
  /// With `supported` that is factored instead, and shift is 0: M x of what is orthogonal to the rigid motions is in
  /// balance, so the springs see no force, and what they hold of the rigid motions is taken out of the solution.
  ///
  /// With M = C Cᵀ of low rank the roots are those of CᵀA⁻¹C y = θ y, A = K + shift M, x = A⁻¹C y / θ, λ = 1/θ - shift:
  /// as many as C has columns, and every x is in the range of A⁻¹M. Else Krylov (solve_krylov).
  bool solve(double shift, int number, int num_guard, bool definite_only, Roots& roots);

 private:
  bool solve_whole(double shift, int number, bool definite_only, Roots& roots);
  void drop_rough(KrylovResult& result) const;
  Roots solve_stage(const fe::SymmetricFactor& factor, double shift, const MatrixXd& known, int number);

  PencilProblem problem_;
  std::optional<Eigen::SparseMatrix<double>> C_;
  int num_available_ = 0;
  int round_ = 0;
};

/// Roots of K x = λ M x below mu by the inertia of K - μM, moved a little where a pivot is zero; -1 where it stays so.
int count_roots_below(Mat K, Mat M, double mu);

}  // namespace bough::modal::detail
