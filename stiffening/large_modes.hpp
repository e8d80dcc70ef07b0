#pragma once
/// \file Selection of the large modes of a body of third order.
#include "stiffening/stages.hpp"

namespace bough::stiffening {

/// Max number of large modes if the body file selects none.
constexpr int kDefaultLargeModes = 6;

/// Modes that [body.stiffening] large selects, from 0, ascending; empty: none. Throws reduce.bad-order.
std::vector<int> find_named_large_modes(const BodyRequest& request, int num_modes);

/// Diagonal of the box around the grids [L]; 0 without grids.
double calc_model_size(const fe::Model& model);

/// Largest translation of a grid in each mode.
VectorXd calc_largest_ways(const fe::Model& model, const MatrixXd& Phi);

/// The soft normal modes (docs/theory/third-order.md, "Large modes"): those that a reference load moves by more than
/// bending of the others does; at most kDefaultLargeModes, from 0, ascending. Phi: num_gdofs x n, of unit strain
/// energy; gradient: of V₃ by the amplitudes, n x monomials of degree 2 of all modes.
std::vector<int> find_default_large_modes(const fe::Model& model, const MatrixXd& Phi, const MatrixXd& gradient,
                                          const std::vector<records::ModeKind>& kind);

}  // namespace bough::stiffening
