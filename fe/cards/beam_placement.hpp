#pragma once
/// \file Element axes and offsets of CBAR and CBEAM from the card and its grids.
#include "fe/elements/beam.hpp"
#include "formats/records/deck.hpp"

namespace bough::fe {

/// A grid of a beam, in basic.
struct BeamEnd {
  Vector3d x;
  Matrix3d R_basic_cd;  ///< columns: axes of its displacement system
};

enum class BeamFault { None, CoincidentGrids, ZeroLength, Orientation };

/// Returns true if OFFT has three letters, each of a frame that there is.
bool has_valid_offt(const records::BeamElement& card);

/// Orientation vector in basic: from GA to G0 (`g0`, a position; nullptr without one), or v in the displacement axes of
/// GA (OFFT G) or in basic (OFFT B). \pre has_valid_offt().
Vector3d calc_orientation(const records::BeamElement& card, const BeamEnd& a, const Vector3d* g0);

/// Offsets, length and axes of the element in basic; pin flags are not set. \pre has_valid_offt().
BeamFault place_beam(const records::BeamElement& card, const BeamEnd& a, const BeamEnd& b, const Vector3d& orientation,
                     BeamGeometry& geometry);

}  // namespace bough::fe
