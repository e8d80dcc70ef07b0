#pragma once
/// \file Canonical eigenvectors, equal for any number of ranks: a basis for each repeated eigenvalue, and signs.
#include <functional>
#include <vector>

#include "fe/linear/symmetric_matrix.hpp"
#include "fe/model/model.hpp"

namespace bough::modal::detail {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Fixed positive weights of the g-dofs: x, y, z translations 1, 2, 3 and rotations 4, 5, 6 times a hundredth of the
/// square of the model's size, each node by its own factor between 1 and 1.5. Pure y and z copies of a bending pair
/// stay pure, y first.
VectorXd calc_basis_weights(const fe::Model& model);

/// The rotation Q that takes the columns of Phi (orthonormal in some inner product) to the eigenvectors of the weights
/// projected on their span, ascending: Phi Q depends on the span alone.
MatrixXd calc_cluster_rotation(const VectorXd& weights, const Eigen::Ref<const MatrixXd>& Phi);

/// Makes the columns of X (ascending), nearly orthonormal in the inner product with Gram matrix G, orthonormal: each by
/// those before it, so that what roundoff left of the others in a low one is none of their forces.
void orthonormalize_ascending(const MatrixXd& G, MatrixXd& X);

/// Projects the M-orthonormal R out of X, twice.
void project_out(const linear::SymmetricMatrix& M, const MatrixXd& R, MatrixXd& X);

/// Makes the component of largest magnitude of each column positive, the first among those within 1e-6 of it.
void fix_signs(MatrixXd& Phi);

/// Largest component of each column; zero for columns without rows.
VectorXd find_largest(const Eigen::Ref<const MatrixXd>& X);

/// One basis of each repeated eigenvalue, fixed by the model alone. `find_end` gives the position after the cluster
/// that starts at one; the columns of X of a cluster are rotated by calc_cluster_rotation() of what `expand` makes of
/// them (displacements of the g-set), and its values become their mean. `rotation`, if any, is rotated with X.
void make_canonical(const VectorXd& weights, int first, const std::function<int(int)>& find_end,
                    const std::function<MatrixXd(const MatrixXd&)>& expand, VectorXd& values, MatrixXd& X,
                    MatrixXd* rotation = nullptr);
/// Makes vectors canonical, with clusters of values within kCloseness of each other.
void make_canonical(const VectorXd& weights, const std::function<MatrixXd(const MatrixXd&)>& expand, VectorXd& values,
                    MatrixXd& X, MatrixXd* rotation = nullptr);

/// End of the cluster that starts at `first`: values that differ from their neighbour by no more than
/// tolerance (|value| + floor) belong together.
int find_cluster_end(const VectorXd& values, int first, double tolerance, double floor);

}  // namespace bough::modal::detail
