#pragma once
/// \file The equations A x = b of a sparse symmetric positive semidefinite A, by least norm where A is singular.
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace bough::solver {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Multifrontal Cholesky factorization (Duff & Reid, ACM TOMS 9 (1983) 302) of A scaled to a unit diagonal, by blocks
/// of rows: in each front pivots are taken by size (Higham, "Accuracy and Stability of Numerical Algorithms", 10.3).
/// Where all blocks meet there is one front, and pivoting is complete; a chain of blocks costs their number. Rows whose
/// pivot is no more than kMinPivot of their diagonal depend on the others. The solution is the one of least norm and
/// least squares in the scaled unknowns and rows.
class SemidefiniteFactor {
 public:
  static constexpr double kMinPivot = 1e-10;

  /// Block i >= block j of A, rows of i by rows of j; on the diagonal the lower triangle is read.
  struct Pair {
    int i = 0, j = 0;
    MatrixXd A;
  };

  /// sizes: rows of each block; meets: pairs of different blocks that A connects. Allocates.
  void arrange(const std::vector<int>& sizes, const std::vector<std::pair<int, int>>& meets);
  /// One block.
  void arrange(int size) { arrange(std::vector<int>{size}, {}); }
  /// Pairs ordered by j, then by i; the first of each j is its diagonal block.
  std::vector<Pair> pairs;
  /// From here on `row` depends on nothing until the next call with false.
  void set_void(int row, bool is_void) { is_void_[static_cast<size_t>(row)] = is_void; }
  /// Factors what pairs hold. Allocates only where more rows depend on others than ever before.
  void compute();
  /// Rank found by compute().
  int rank() const { return rank_; }
  /// Number of rows.
  int size() const { return static_cast<int>(scale_.size()); }
  /// Number of fronts of the elimination.
  int num_fronts() const { return static_cast<int>(fronts_.size()); }
  /// b: size, in and out.
  void solve(Eigen::Ref<VectorXd> b);

 private:
  struct Front {
    std::vector<int> rows;       ///< of A: those eliminated here (in the order of their pivots), then the others
    std::vector<int> to_parent;  ///< of the others: where in the parent's rows
    int parent = -1, num_own = 0, rank = 0;
    MatrixXd F;  ///< lower triangle; after compute the first `rank` columns are L
  };
  struct Place {  ///< of a pair in the lower triangle of its front
    int front = 0, row = 0, column = 0;
  };

  void assemble();
  void eliminate(Front& front);
  void find_null_vectors();
  void remove_null(VectorXd& x);

  std::vector<Front> fronts_;
  std::vector<Place> places_;
  std::vector<int> first_;
  std::vector<std::vector<int>> start_rows_;  ///< Front::rows before any exchange
  std::vector<bool> is_void_;
  VectorXd scale_, x_, share_;
  int rank_ = 0;
  std::vector<std::pair<int, int>> dependent_;  ///< front and local row of those that depend on others
  std::vector<int> zero_;                       ///< rows that are void
  MatrixXd null_, gram_;                        ///< null vectors but for those rows', in columns
  Eigen::LLT<MatrixXd> null_factor_;
};

}  // namespace bough::solver
