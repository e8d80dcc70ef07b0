#pragma once
/// \file Selection of the large modes of a body of third order.
#include "stiffening/stages.hpp"

namespace bough::stiffening {

/// Length that makes a displacement of a rotation, in sizes of the model.
constexpr double kTurnedShare = 0.1;
/// Max number of large modes if the body file selects none.
constexpr int kDefaultLargeModes = 6;

/// Modes that [body.stiffening] large selects, from 0, ascending; empty: none. Throws reduce.bad-order.
std::vector<int> find_named_large_modes(const BodyRequest& request, int num_modes);

/// Largest translation of a grid in each mode, or rotation times `arm` [L] if that is more.
VectorXd calc_largest_ways(const fe::Model& model, const MatrixXd& Phi, double arm = 0);

/// Combinations of shapes, orthonormal under K, from the most compliant: n x n. The compliance of a shape is the mean
/// square displacement of the grids and that of the interface nodes, rotations times a tenth of the size of the model,
/// over its strain energy. Phi: num_gdofs x n; K: n x n, their stiffness.
MatrixXd calc_compliant_directions(const fe::Model& model, const MatrixXd& Phi, const MatrixXd& K,
                                   const std::vector<int>& interface_nodes);

/// The soft ones of the modes `large` (docs/theory/third-order.md, "Large modes"): those that a reference load moves by
/// more than bending of the others does; at most kDefaultLargeModes, ascending. Phi: num_gdofs x n, of unit strain
/// energy; gradient: of V₃ by the amplitudes, n x monomials of degree 2 of all modes; counts_rotations: as
/// calc_compliant_directions does.
std::vector<int> find_default_large_modes(const fe::Model& model, const MatrixXd& Phi, const MatrixXd& gradient,
                                          std::vector<int> large, bool counts_rotations);

}  // namespace bough::stiffening
