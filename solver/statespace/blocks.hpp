#pragma once
/// \file The block-triangular form of a square matrix, by its zeros alone.
#include <vector>

#include <Eigen/Dense>

namespace bough::statespace {

/// Rows (and columns) that depend on each other, directly or by way of others: the strongly connected components of the
/// graph of a's nonzero entries (Tarjan, SIAM J. Comput. 1 (1972) 146). Each depends only on itself and on those before
/// it, so that the eigenvalues of a are those of the diagonal blocks: a body that floats gives exact zeros.
std::vector<std::vector<int>> find_blocks(const Eigen::MatrixXd& a);

/// a with rows and columns scaled by powers of two, D⁻¹ a D, until they are of like size (Parlett & Reinsch, Numer.
/// Math. 13 (1969) 293); returns the diagonal of D. Eigen's solvers do not do this.
Eigen::VectorXd balance(Eigen::MatrixXd& a);

}  // namespace bough::statespace
