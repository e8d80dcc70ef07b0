#pragma once
/// \file Size of the terms that the displacements of a body leave out (docs/theory/third-order.md, "Next order").
#include "solver/bodies/body.hpp"

namespace bough::solver {

/// Estimates the first order that the body leaves out, relative to the deflection of the node, from the orders that it
/// has. Order 3: r⁴, r the largest ratio of two orders next to each other, (|u_k|/|u_1|)^(1/(k-1)) of the node's
/// displacements and (|V_k|/V_2)^(1/(k-2)) of the strain energy. Order 2: the largest of (|u_1|/size)², of what
/// SoftEnergy::calc_error gives if the body has that energy, and at a node with locators of 3 |u_2|²/|u_1|² (this and
/// the first: error of a cantilever) and 2 ρ², ρ the coupling by the stress of the deflection (strips).
/// \param eta   n amplitudes.
/// \param size  [L] size of the body.
/// \return 0 for a node at rest. \note No allocation.
double calc_next_order(const Body& body, const Node& node, const ConstVectorRef& eta, double size);

/// Estimates the error due to the part of a deflection whose V_4 the body lacks: of order 2 the modes outside
/// SoftEnergy, of order 3 the small ones. Its share of ηᵀKη times x/(1 + x), x the mean of 2 V_4/V_2 of the softest
/// modes or directions that have V_4, at an amplitude that moves some node as far as the deflection. Example: bodies
/// that joints hold at several nodes, which bend by residual vectors.
/// \return 0 if that share is below 1e-3, or without soft modes. \note No allocation.
double calc_small_error(const Body& body, const ConstVectorRef& eta);

}  // namespace bough::solver
