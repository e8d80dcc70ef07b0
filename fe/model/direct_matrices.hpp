#pragma once
/// \file The direct matrices (DMIG) that a subcase selects, as elements.
#include "fe/elements/element.hpp"

namespace bough::fe {

/// Elements of K2GG, M2GG and B2GG of the subcase, times their factors and PARAM CK2, CM2, CB2. PARAM,WTMASS does not
/// act on M2GG (Quick Reference Guide, M2GG). Reports fe.missing-direct, fe.direct-not-symmetric, fe.direct-complex,
/// fe.missing-grid, fe.bad-component, fe.unsupported-param; fe.direct-unused (warning) for a matrix that is not
/// selected.
ElementList make_direct(const records::Deck& deck, const records::Subcase& subcase, const NodeTable& nodes,
                        Diagnostics& diagnostics);

}  // namespace bough::fe
