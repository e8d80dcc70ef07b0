#pragma once
/// \file The external superelements of a deck as elements.
#include "fe/elements/element.hpp"

namespace bough::fe {

/// An element for each superelement, and one for each grid and element that it recovers. `origin`: Bo in basic, as the
/// nodes'. PARAM,WTMASS is not for its mass: another run wrote the matrices. Reports
/// fe.superelement-boundary (no point to join, another kind of point, another place).
ElementList make_superelements(const records::Deck& deck, const NodeTable& nodes, const Vector3d& origin, double wtmass,
                               Diagnostics& diagnostics);

}  // namespace bough::fe
