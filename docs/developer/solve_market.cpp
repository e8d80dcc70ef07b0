/// Solves K x = f and counts the negative eigenvalues of K - mu M, for matrices in Matrix Market files:
///   solve_market K.mtx [M.mtx mu]
/// f is the sum of the columns of K, so that x is a column of ones.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <unsupported/Eigen/SparseExtra>

#include "fe/linear/factor.hpp"
#include "fe/linear/inertia.hpp"

using bough::linear::SymmetricMatrix;

/// Reads a file of the lower triangle ("symmetric"), as SciPy and Nastran tools write it.
SymmetricMatrix read(const char* path) {
  Eigen::SparseMatrix<double> lower;
  if (!Eigen::loadMarket(lower, path)) throw std::runtime_error(std::string(path) + " is not a Matrix Market file");
  return SymmetricMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(lower.selfadjointView<Eigen::Lower>()));
}

int main(int argc, char** argv) try {
  if (argc != 2 && argc != 4) throw std::runtime_error("usage: solve_market K.mtx [M.mtx mu]");
  bough::linear::initialize_petsc();
  const SymmetricMatrix K = read(argv[1]);
  const bough::linear::SymmetricFactor factor(K, true);
  const Eigen::MatrixXd f = bough::linear::multiply(K, Eigen::MatrixXd::Ones(K.num_rows(), 1));
  Eigen::MatrixXd x = factor.solve(f);
  x += factor.solve(bough::linear::calc_residual(K, x, f));  // one refinement with extended precision
  std::printf("%d rows, %s, %.0f entries, error %.1e\n", K.num_rows(), factor.name(), factor.num_entries(),
              (x.array() - 1).abs().maxCoeff());
  if (argc == 2) return 0;
  const auto count = bough::linear::count_eigenvalues_below(K, read(argv[2]), std::atof(argv[3]));
  std::printf("%d eigenvalues below %s\n", count.value_or(-1), argv[3]);
  return 0;
} catch (const std::exception& failure) {
  std::fprintf(stderr, "error: %s\n", failure.what());
  return 1;
}
