#pragma once
/// \file What all ranks know together: sums, gathered and spread vectors.
#include <functional>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// Sums a replicated matrix over ranks in place.
void sum_over_ranks(Eigen::Ref<Eigen::MatrixXd> values);
/// The same, alike to the last bit on every rank whatever MPI does: for what all decide by.
void sum_alike(Eigen::Ref<Eigen::MatrixXd> values);

/// Sums a replicated matrix onto the first rank; the others' is lost.
void sum_on_first(Eigen::MatrixXd& values);

/// Gathers a distributed vector onto every rank / spreads a replicated one.
Eigen::VectorXd gather(Vec v);
void scatter(const Eigen::Ref<const Eigen::VectorXd>& values, Vec v);

/// What each rank has, one after the other, on every rank; itself in one process. Less than 2^31 of all.
std::vector<int> join_over_ranks(const std::vector<int>& own);
std::vector<double> join_over_ranks(const std::vector<double>& own);
/// The same on the first rank; empty on the others.
std::vector<int> collect_on_first(const std::vector<int>& own);
Eigen::VectorXd collect_on_first(const Eigen::VectorXd& own);
/// The text of the rank `from` on every rank.
std::string spread_text(std::string text, int from);

/// Whether it is true on every rank.
bool are_all(bool is_true);
/// What fails on one rank ends it on all: with the own error, `otherwise` where there is none. Memory that is not there
/// is `otherwise` too.
void do_on_all(const ComputationError& otherwise, const std::function<void()>& act);

}  // namespace bough::fe
