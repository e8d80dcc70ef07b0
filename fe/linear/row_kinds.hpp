#pragma once
/// \file Kinds of rows of a stiffness matrix, forces and moments: they differ by a length, so their ratio depends on
/// the units.
#include <vector>

#include <Eigen/Dense>

namespace bough::linear {

enum class RowKind : char { Translation, Rotation, Scalar };
/// One per row; empty: the rows are of one kind.
using RowKinds = std::vector<RowKind>;

/// The diagonal D (n), each entry above zero: where a row has below 1e-14 of the largest of its kind, which is
/// round-off of none, that largest takes its place (that of all rows where its kind has none). With K → S K S, S the
/// same for all rows of a kind, D → S D S.
Eigen::VectorXd fill_diagonal(Eigen::VectorXd D, const RowKinds& kinds);

/// D with every entry raised to `share` of the largest of its kind.
Eigen::VectorXd raise_diagonal(Eigen::VectorXd D, const RowKinds& kinds, double share);

}  // namespace bough::linear
