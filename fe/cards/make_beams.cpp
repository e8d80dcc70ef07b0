#include <optional>

#include "fe/cards/make_beam_properties.hpp"
#include "fe/elements/beam.hpp"

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

/// Orientation vector in basic: from GA to G0, or v in the displacement axes of GA (OFFT G) or basic (B).
std::optional<Vector3d> calc_orientation(Maker& maker, const records::BeamElement& card, const std::string& who,
                                         const Node& a) {
  if (card.g0 > 0) {
    const int g0 = maker.find_grid(card.g0, who, card.at);
    if (g0 < 0) return std::nullopt;
    return maker.nodes().node(g0).x - a.x;
  }
  return card.offt[0] == 'B' ? card.v : Vector3d(a.R_basic_cd * card.v);
}

void make_beam(Maker& maker, BeamProperties& properties, BeamFields& fields, const records::BeamElement& card) {
  const std::string name = card.is_cbeam ? "CBEAM" : "CBAR", who = name + " " + std::to_string(card.id);
  auto property = properties.find(card, who);
  const int a = maker.find_grid(card.ga, who, card.at), b = maker.find_grid(card.gb, who, card.at);
  if (a < 0 || b < 0) return;
  if (a == b) {
    maker.error("fe.zero-length", card.at, who + " has grid " + std::to_string(card.ga) + " at both ends",
                "correct GA or GB; offsets give it a length, but no part that bends");
    return;
  }
  const Node& node_a = maker.nodes().node(a);
  const Node& node_b = maker.nodes().node(b);
  const auto is_frame = [](char c, const char* allowed) { return std::string(allowed).find(c) != std::string::npos; };
  if (card.offt.size() != 3 || !is_frame(card.offt[0], "GB") || !is_frame(card.offt[1], "GOE") ||
      !is_frame(card.offt[2], "GOE")) {
    maker.error("fe.bad-offt", card.at,
                who + " has OFFT '" + card.offt +
                    "', expected GGG, BGG, GGO, BGO, GOG, BOG, "
                    "GOO or BOO",
                "correct the field");
    return;
  }
  if ((card.pin_a | card.pin_b) >> 6) {
    maker.error("fe.bad-component", card.at, who + " has a pin flag other than 1 to 6", "correct PA and PB");
    return;
  }
  const auto orientation = calc_orientation(maker, card, who, node_a);
  if (!orientation) return;
  const auto bad_orientation = [&] {
    maker.error("fe.bad-orientation", card.at,
                who + " has its orientation vector (" + show((*orientation)[0]) + ", " + show((*orientation)[1]) +
                    ", " + show((*orientation)[2]) + " in basic) " +
                    (orientation->isZero(0) ? "zero" : "along its axis"),
                "give a vector or G0 that is not on the line of the element");
  };

  BeamGeometry geometry;
  const Vector3d chord = node_b.x - node_a.x;
  const bool element_frame = (card.offt[1] != 'G' && !card.wa.isZero(0)) || (card.offt[2] != 'G' && !card.wb.isZero(0));
  if (element_frame && chord.isZero(0)) {
    maker.error("fe.zero-length", card.at, who + " has coincident grids, so offsets in element axes mean nothing",
                "give the offsets in the displacement system (OFFT G)");
    return;
  }
  if (element_frame) {
    const auto axes = calc_element_axes(chord, *orientation);
    if (!axes) return bad_orientation();
    if (card.offt[1] != 'G') geometry.wa = *axes * card.wa;
    if (card.offt[2] != 'G') geometry.wb = *axes * card.wb;
  }
  if (card.offt[1] == 'G') geometry.wa = node_a.R_basic_cd * card.wa;
  if (card.offt[2] == 'G') geometry.wb = node_b.R_basic_cd * card.wb;

  const Vector3d along = chord + geometry.wb - geometry.wa;
  geometry.length = along.norm();
  const double size = std::max({node_a.x.norm(), node_b.x.norm(), geometry.wa.norm(), geometry.wb.norm()});
  if (!(geometry.length > 1e-12 * size)) {
    maker.error("fe.zero-length", card.at, who + " has zero length between its (offset) ends",
                "its two ends coincide: move one or delete the element");
    return;
  }
  const auto axes = calc_element_axes(along, *orientation);
  if (!axes) return bad_orientation();
  geometry.R_basic_element = *axes;
  geometry.pin_a = card.pin_a;
  geometry.pin_b = card.pin_b;
  if (card.sa != 0 || card.sb != 0)
    maker.diagnostics().warning("fe.warping-ignored", maker.deck().locate(card.at),
                                who + " has warping points SA, SB, which are not used");
  if (!property) return;
  const double ge = property->material.ge;
  auto field = fields.find(property, geometry.length);
  maker.add(std::make_unique<Beam>(card.id, name, std::vector{a, b}, maker.list_gdofs({a, b}), std::move(property),
                                   geometry, std::move(field)),
            ge);
}

}  // namespace

void make_beams(Maker& maker) {
  BeamProperties properties(maker);
  BeamFields fields;
  for (const records::BeamElement& card : maker.deck().beams) make_beam(maker, properties, fields, card);
}

}  // namespace bough::fe
