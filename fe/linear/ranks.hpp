#pragma once
/// \file What all ranks know together: sums, gathered and spread vectors.
#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// Sums a replicated matrix over ranks in place.
void sum_over_ranks(Eigen::Ref<Eigen::MatrixXd> values);
/// The same, alike to the last bit on every rank whatever MPI does: for what all decide by.
void sum_alike(Eigen::Ref<Eigen::MatrixXd> values);

/// Gathers a distributed vector onto every rank / spreads a replicated one.
Eigen::VectorXd gather(Vec v);
void scatter(const Eigen::Ref<const Eigen::VectorXd>& values, Vec v);

}  // namespace bough::fe
