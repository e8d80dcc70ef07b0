#include <optional>
#include <string>

#include "base/number_text.hpp"
#include "fe/cards/beam_placement.hpp"
#include "fe/cards/make_beam_properties.hpp"
#include "fe/elements/beam.hpp"

namespace bough::fe {
namespace {

std::optional<Vector3d> find_orientation(Maker& maker, const records::BeamElement& card, const std::string& who,
                                         const BeamEnd& a) {
  if (card.g0 <= 0) return calc_orientation(card, a, nullptr);
  const int g0 = maker.find_grid(card.g0, who, card.at);
  if (g0 < 0) return std::nullopt;
  return calc_orientation(card, a, &maker.nodes().node(g0).x);
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
  if (!has_valid_offt(card)) {
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
  const BeamEnd end_a{node_a.x, node_a.R_basic_cd}, end_b{node_b.x, node_b.R_basic_cd};
  const auto orientation = find_orientation(maker, card, who, end_a);
  if (!orientation) return;
  BeamGeometry geometry;
  switch (place_beam(card, end_a, end_b, *orientation, geometry)) {
    case BeamFault::None:
      break;
    case BeamFault::CoincidentGrids:
      maker.error("fe.zero-length", card.at, who + " has coincident grids, so offsets in element axes mean nothing",
                  "give the offsets in the displacement system (OFFT G)");
      return;
    case BeamFault::ZeroLength:
      maker.error("fe.zero-length", card.at, who + " has zero length between its (offset) ends",
                  "its two ends coincide: move one or delete the element");
      return;
    case BeamFault::Orientation:
      maker.error("fe.bad-orientation", card.at,
                  who + " has its orientation vector (" + show_number((*orientation)[0]) + ", " +
                      show_number((*orientation)[1]) + ", " + show_number((*orientation)[2]) + " in basic) " +
                      (orientation->isZero(0) ? "zero" : "along its axis"),
                  "give a vector or G0 that is not on the line of the element");
      return;
  }
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
