#include "fe/linear/cholmod_factor.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <cholmod.h>

#include "fe/linear/cholmod_view.hpp"
#include "fe/linear/dissection.hpp"
#include "fe/linear/memory_need.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;

/// The upper triangle by rows, which is the lower one by columns.
struct Triangle {
  std::vector<int> start{0}, row;
  std::vector<double> value;

  explicit Triangle(Mat A) {
    visit_rows(A, [&](const MatrixRows& rows, PetscInt size) {
      for (PetscInt i = 0; i < size; ++i) {
        for (PetscInt k = rows.start[i]; k < rows.start[i + 1]; ++k) {
          if (rows.column[k] < i) continue;
          row.push_back(rows.column[k]);
          value.push_back(rows.value[k]);
        }
        start.push_back(static_cast<int>(row.size()));
      }
    });
  }
  cholmod_sparse as_sparse() {
    cholmod_sparse matrix = view_lower(start, row, value.data());
    matrix.sorted = 1;
    return matrix;
  }
};

class CholmodSolver final : public FactorSolver {
 public:
  CholmodSolver() {
    cholmod_start(common_.get());
    common_->print = 0;
    // Without both settings a small matrix gets an LDLᵀ, which accepts negative pivots.
    common_->final_asis = 0;
    common_->final_ll = 1;
  }
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;
  ~CholmodSolver() override {
    cholmod_free_factor(&factor_, common_.get());
    cholmod_finish(common_.get());
  }

  /// False where A is not positive definite.
  bool factor(const SymmetricMatrix& A) {
    Triangle triangle(A.sparse());
    cholmod_sparse matrix = triangle.as_sparse();
    if (const auto order = find_elimination_order(A)) {
      common_->nmethods = 1;  // the order given; by itself CHOLMOD would try its own next to it
      factor_ = cholmod_analyze_p(&matrix, const_cast<int*>(order->data()), nullptr, 0, common_.get());
    } else {
      factor_ = cholmod_analyze(&matrix, common_.get());
    }
    check_cholmod(common_->status);
    if (!factor_) return false;
    // A megabyte is available: the request to the system takes as long as such a factor.
    constexpr double kMinCheckedEntries = 1e5;
    num_entries_ = common_->lnz;
    if (num_entries_ >= kMinCheckedEntries)
      require_memory(static_cast<double>(matrix.nrow), num_entries_, calc_free_memory());
    cholmod_factorize(&matrix, factor_, common_.get());
    check_cholmod(common_->status);
    return common_->status == CHOLMOD_OK && factor_->minor >= factor_->n;
  }

  MatrixXd solve(const Eigen::Ref<const MatrixXd>& B) const override {
    if (B.size() == 0) return B;
    cholmod_dense right{};
    right.nrow = static_cast<std::size_t>(B.rows());
    right.ncol = static_cast<std::size_t>(B.cols());
    right.d = static_cast<std::size_t>(B.outerStride());
    right.nzmax = right.d * right.ncol;
    right.x = const_cast<double*>(B.data());
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* X = cholmod_solve(CHOLMOD_A, factor_, &right, common_.get());
    check_cholmod(common_->status);
    BOUGH_DEMAND(X);
    MatrixXd result = Eigen::Map<const MatrixXd>(static_cast<const double*>(X->x), B.rows(), B.cols());
    cholmod_free_dense(&X, common_.get());
    return result;
  }
  const char* name() const override { return "LLᵀ CHOLMOD"; }
  double num_entries() const override { return num_entries_; }

 private:
  std::unique_ptr<cholmod_common> common_ = std::make_unique<cholmod_common>();  // CHOLMOD writes its workspace
  cholmod_factor* factor_ = nullptr;
  double num_entries_ = 0;
};

}  // namespace

ComputationError make_out_of_memory(const std::string& what) {
  return {"fe.out-of-memory",
          {},
          "the factor of the stiffness matrix does not fit the memory" + what,
          "use a coarser mesh, or run on more processes of a larger machine (mpirun -n 2 bough ...)"};
}

void check_cholmod(int status) {
  if (status == CHOLMOD_OUT_OF_MEMORY) throw make_out_of_memory();
  if (status == CHOLMOD_TOO_LARGE)
    throw ComputationError("fe.out-of-memory", {},
                           "the factor of the stiffness matrix has more than 2^31 entries, more than CHOLMOD counts",
                           "run on two processes or more, where MUMPS factors (mpirun -n 2 bough ...)");
}

FactorSolverHandle factor_by_cholmod(const SymmetricMatrix& A) {
  auto solver = std::make_unique<CholmodSolver>();
  if (!solver->factor(A)) return nullptr;
  return solver;
}

}  // namespace bough::linear
