#include "fe/cards/beam_placement.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace bough::fe {
namespace {

/// Columns x (along), y (in the plane of x and v), z; nothing when v is parallel to x or zero.
std::optional<Matrix3d> calc_element_axes(const Vector3d& along, const Vector3d& v) {
  const Vector3d ex = along.normalized();
  Vector3d ez = ex.cross(v);
  if (!(ez.norm() > 1e-6 * v.norm())) return std::nullopt;
  ez.normalize();
  Matrix3d R;
  R << ex, ez.cross(ex), ez;
  return R;
}

}  // namespace

bool has_valid_offt(const records::BeamElement& card) {
  const auto is_frame = [](char c, const char* allowed) { return std::string(allowed).find(c) != std::string::npos; };
  return card.offt.size() == 3 && is_frame(card.offt[0], "GB") && is_frame(card.offt[1], "GOE") &&
         is_frame(card.offt[2], "GOE");
}

Vector3d calc_orientation(const records::BeamElement& card, const BeamEnd& a, const Vector3d* g0) {
  if (g0) return *g0 - a.x;
  return card.offt[0] == 'B' ? card.v : Vector3d(a.R_basic_cd * card.v);
}

BeamFault place_beam(const records::BeamElement& card, const BeamEnd& a, const BeamEnd& b, const Vector3d& orientation,
                     BeamGeometry& geometry) {
  const Vector3d chord = b.x - a.x;
  const bool element_frame = (card.offt[1] != 'G' && !card.wa.isZero(0)) || (card.offt[2] != 'G' && !card.wb.isZero(0));
  if (element_frame && chord.isZero(0)) return BeamFault::CoincidentGrids;
  if (element_frame) {
    const auto axes = calc_element_axes(chord, orientation);
    if (!axes) return BeamFault::Orientation;
    if (card.offt[1] != 'G') geometry.wa = *axes * card.wa;
    if (card.offt[2] != 'G') geometry.wb = *axes * card.wb;
  }
  if (card.offt[1] == 'G') geometry.wa = a.R_basic_cd * card.wa;
  if (card.offt[2] == 'G') geometry.wb = b.R_basic_cd * card.wb;

  const Vector3d along = chord + geometry.wb - geometry.wa;
  geometry.length = along.norm();
  const double size = std::max({a.x.norm(), b.x.norm(), geometry.wa.norm(), geometry.wb.norm()});
  if (!(geometry.length > 1e-12 * size)) return BeamFault::ZeroLength;
  const auto axes = calc_element_axes(along, orientation);
  if (!axes) return BeamFault::Orientation;
  geometry.R_basic_element = *axes;
  return BeamFault::None;
}

}  // namespace bough::fe
