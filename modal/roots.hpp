#pragma once
/// \file The search that modes, modes of a held interface and load factors share: solve, look for a gap, count.
#include <functional>
#include <string>

#include <Eigen/Dense>

namespace bough {
class Diagnostics;
}

namespace bough::modal::detail {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Computed eigenvalues in the order of the request (see add), and their eigenvectors.
struct Roots {
  VectorXd value;
  MatrixXd X;  ///< n x value.size()
  /// Number of eigenvalues.
  int size() const { return static_cast<int>(value.size()); }
  /// Keeps the first `count` eigenvalues and vectors.
  void keep(int count);
  /// Ascending afterwards, or by ascending magnitude.
  void add(const VectorXd& values, MatrixXd vectors, bool by_magnitude = false);
};

/// Number of missed eigenvalues that are sought together, with two more to show the gap: mostly copies of one, which a
/// block of as many columns finds in a few solutions.
constexpr int kMaxMissing = 46, kMaxMissingColumns = kMaxMissing + 2;

/// A request for eigenvalues of one kind of problem. Positions count the eigenvalues without the known motions.
struct RootSearch {
  int requested = 0;
  int num_available = 0;      ///< no more roots than this exist
  bool by_magnitude = false;  ///< order
  bool counts = true;         ///< Sylvester: no root missed below the highest
  double lowest = 0;          ///< no root is below it
  double shift = 0;           ///< distances are relative to value + shift
  /// Appends up to `number` further eigenpairs, orthogonal to the known ones; none if there are no more.
  std::function<void(Roots& roots, int number)> solve;
  /// Relative distance to the next root within which root i and the next may be copies.
  std::function<double(const Roots& roots, int i)> closeness;
  std::function<double(const Roots& roots, int i)> roundoff;  ///< relative error of root i by roundoff
  std::function<int(double mu)> count;                        ///< eigenvalues below mu; -1 if the factor fails
};

struct RootSearchResult {
  int cut = 0;                 ///< the roots before it are complete: a gap follows, or nothing
  int count = -1;              ///< of the inertia below that gap, at least `cut`; -1: not made, or not to be trusted
  int doubtful = -1;           ///< the inertia count if it is below `cut` or above the number of eigenvalues
  bool is_missing = false;     ///< the inertia counts roots that the solver does not find
  std::string no_memory = {};  ///< reason if memory was short for the factor of the inertia count
};

/// Repeats solve, gap, count until the first `requested` roots are complete or the solver has no more. An inertia below
/// what was found is tried again further into the gap; roots with separate vectors prove it wrong, not the roots.
RootSearchResult search_roots(const RootSearch& search, Roots& roots);

/// Throws ComputationError("modal.missed-modes") if eigenvalues are missing; warns "modal.uncertain-count" if the
/// requested count is unreliable, "modal.not-counted" if memory was short. `name`: "modes", "load factors";
/// `num_known`: motions counted in addition to them.
void report_count(const RootSearchResult& result, int num_known, const std::string& name, bool counts,
                  Diagnostics& diagnostics);

/// Returns [A B], of equal numbers of rows.
MatrixXd join(const MatrixXd& A, const MatrixXd& B);

}  // namespace bough::modal::detail
