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

}  // namespace bough::solver
