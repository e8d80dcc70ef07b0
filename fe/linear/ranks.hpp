#pragma once
/// \file Sums over ranks; vectors gathered on every rank, and distributed.
#include <utility>

#include "fe/linear/petsc.hpp"

namespace bough::linear {

/// Sums a replicated matrix over ranks in place. Every rank gets the same bits, whatever MPI does: all decide by them.
void sum_over_ranks(Eigen::Ref<Eigen::MatrixXd> values);

/// Gathers a distributed vector onto every rank / spreads a replicated one.
Eigen::VectorXd gather(Vec v);
void scatter(const Eigen::Ref<const Eigen::VectorXd>& values, Vec v);

/// Rows [first, last) of this rank, of `size` as PETSc distributes them.
std::pair<int, int> split_rows(int size);

}  // namespace bough::linear
