#include "fe/cards/maker.hpp"
#include "fe/elements/bush1d.hpp"
#include "fe/elements/viscous.hpp"

namespace bough::fe {
namespace {

/// From grid a to grid b; false after reporting that they coincide.
bool check_length(Maker& maker, const std::string& who, const Vector3d& line, const std::string& advice,
                  const records::CardLocation& at) {
  if (line.norm() > 0) return true;
  maker.error("fe.zero-length", at, who + " has zero length", advice);
  return false;
}

void make_visc(Maker& maker, const RecordIndex<records::Pvisc>& properties, const records::Cvisc& card) {
  const std::string who = "CVISC " + std::to_string(card.id);
  const records::Pvisc* property = properties.find(card.pid);
  if (!property) maker.report_missing_property(card.pid, "PVISC", who, card.at);
  const int a = maker.find_grid(card.ga, who, card.at), b = maker.find_grid(card.gb, who, card.at);
  if (!property || a < 0 || b < 0) return;
  const Vector3d line = maker.nodes().node(b).x - maker.nodes().node(a).x;
  if (!check_length(maker, who, line, "its two grids coincide: move one, or use CDAMP2", card.at)) return;
  maker.add(std::make_unique<Viscous>(card.id, std::vector{a, b}, maker.list_gdofs({a, b}), property->ce, property->cr,
                                      line.normalized()));
}

void make_bush1d(Maker& maker, const RecordIndex<records::Pbush1d>& properties, const records::Cbush1d& card) {
  const std::string who = "CBUSH1D " + std::to_string(card.id);
  const records::Pbush1d* property = properties.find(card.pid);
  if (!property) maker.report_missing_property(card.pid, "PBUSH1D", who, card.at);
  std::vector<int> nodes{maker.find_grid(card.ga, who, card.at)};
  if (card.gb != 0) nodes.push_back(maker.find_grid(card.gb, who, card.at));
  if (!property || nodes.front() < 0 || nodes.back() < 0) return;
  const Node& first = maker.nodes().node(nodes.front());
  Bush1dData data;
  data.k = property->k;
  data.c = property->c;
  data.mass = property->m;
  if (card.cid) {
    data.axis = maker.nodes().calc_axes(*card.cid, first.x, maker.deck().locate(card.at), maker.diagnostics()).col(0);
  } else {
    const Vector3d line = maker.nodes().node(nodes.back()).x - first.x;
    if (!check_length(maker, who, line, "its two grids coincide: give the axis by CID", card.at)) return;
    data.axis = line.normalized();
    data.length = line.norm();
  }
  std::vector<int> gdofs;
  for (const int node : nodes)
    for (int i = 0; i < 3; ++i) gdofs.push_back(maker.nodes().node(node).first_gdof + i);
  maker.add(std::make_unique<Bush1d>(card.id, std::move(nodes), std::move(gdofs), data));
}

}  // namespace

void make_line_dampers(Maker& maker) {
  const auto& deck = maker.deck();
  const RecordIndex<records::Pvisc> pvisc(deck.pvisc);
  for (const records::Cvisc& card : deck.cvisc) make_visc(maker, pvisc, card);
  const RecordIndex<records::Pbush1d> pbush1d(deck.pbush1d);
  for (const records::Cbush1d& card : deck.cbush1d) make_bush1d(maker, pbush1d, card);
}

}  // namespace bough::fe
