#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/number_text.hpp"
#include "fe/cards/maker.hpp"
#include "fe/elements/rod.hpp"
#include "fe/shape/gauss.hpp"

namespace bough::fe {
namespace {

/// Common end of every rod card: grids, length, element.
void make_rod(Maker& maker, const char* card_name, int id, int ga, int gb, const records::CardLocation& at,
              const RodProperty* property) {
  const std::string who = std::string(card_name) + " " + std::to_string(id);
  const int a = maker.find_grid(ga, who, at), b = maker.find_grid(gb, who, at);
  if (a < 0 || b < 0) return;
  const Vector3d xa = maker.nodes().node(a).x, xb = maker.nodes().node(b).x;
  if (!((xb - xa).norm() > 0)) {
    maker.error("fe.zero-length", at, who + " has zero length",
                "its two grids coincide: move one or delete the element");
    return;
  }
  if (!property) return;
  maker.add(std::make_unique<Rod>(id, card_name, std::vector{a, b}, maker.list_gdofs({a, b}), *property, xa, xb),
            property->ge);
}

bool check_section(Maker& maker, const std::string& who, double A, double J, double nsm,
                   const records::CardLocation& at) {
  if (A >= 0 && J >= 0 && nsm >= 0) return true;
  maker.error("fe.bad-property", at, who + " has a negative area, torsion constant or nonstructural mass",
              "these are zero or positive");
  return false;
}

RodProperty make_property(const records::Mat1& material, double A, double J, double c, double nsm) {
  const double mass = material.rho * A + nsm;
  return {material.E * A,    material.G * J, mass,      mass, material.alpha, material.tref, material.ge, A,
          J > 0 ? c / J : 0, material.E,     material.G};
}

/// Hollow or solid circular tube, diameter linear from od to od2, constant wall t (t = 0: solid). Axial and torsional
/// compliances ∫dx/A and ∫dx/J are integrated, so the taper is exact.
RodProperty make_tube(const records::Mat1& material, const records::Ptube& tube) {
  const double od2 = tube.od2.value_or(tube.od);
  const auto area = [&](double od) {
    const double id = tube.t > 0 ? od - 2 * tube.t : 0;
    return std::numbers::pi / 4 * (od * od - id * id);
  };
  const auto polar = [&](double od) {
    const double id = tube.t > 0 ? od - 2 * tube.t : 0;
    return std::numbers::pi / 32 * (std::pow(od, 4) - std::pow(id, 4));
  };
  double per_A = 0, per_J = 0;
  for (const GaussPoint& g : get_gauss_points(8)) {
    const double od = tube.od + g.x * (od2 - tube.od);
    per_A += g.weight / area(od);
    per_J += g.weight / polar(od);
  }
  const double min_diameter = std::min(tube.od, od2);
  return {material.E / per_A,
          material.G / per_J,
          material.rho * area(tube.od) + tube.nsm,
          material.rho * area(od2) + tube.nsm,
          material.alpha,
          material.tref,
          material.ge,
          area(min_diameter),
          min_diameter / 2 / polar(min_diameter),
          material.E,
          material.G};
}

}  // namespace

void make_rods(Maker& maker) {
  const auto& deck = maker.deck();
  std::unordered_map<int, std::optional<RodProperty>> made;
  const RecordIndex<records::Prod> prod(deck.prod);
  for (const records::Crod& card : deck.crod) {
    const std::string who = "CROD " + std::to_string(card.id);
    if (!made.contains(card.pid)) {
      const records::Prod* p = prod.find(card.pid);
      if (!p) {
        maker.report_missing_property(card.pid, "PROD", who, card.at);
      } else {
        const std::string name = "PROD " + std::to_string(p->id);
        const records::Mat1* material = maker.find_material(p->mid, name, p->at);
        const bool ok = check_section(maker, name, p->A, p->J, p->nsm, p->at);
        made[card.pid] =
            material && ok ? std::optional(make_property(*material, p->A, p->J, p->c, p->nsm)) : std::nullopt;
      }
    }
    const auto it = made.find(card.pid);
    make_rod(maker, "CROD", card.id, card.ga, card.gb, card.at,
             it != made.end() && it->second ? &*it->second : nullptr);
  }
  for (const records::Conrod& card : deck.conrod) {
    const std::string who = "CONROD " + std::to_string(card.id);
    const records::Mat1* material = maker.find_material(card.mid, who, card.at);
    const bool ok = check_section(maker, who, card.A, card.J, card.nsm, card.at);
    RodProperty property;
    if (material && ok) property = make_property(*material, card.A, card.J, card.c, card.nsm);
    make_rod(maker, "CONROD", card.id, card.ga, card.gb, card.at, material && ok ? &property : nullptr);
  }
  made.clear();
  const RecordIndex<records::Ptube> ptube(deck.ptube);
  for (const records::Ctube& card : deck.ctube) {
    const std::string who = "CTUBE " + std::to_string(card.id);
    if (!made.contains(card.pid)) {
      const records::Ptube* p = ptube.find(card.pid);
      if (!p) {
        maker.report_missing_property(card.pid, "PTUBE", who, card.at);
      } else {
        const std::string name = "PTUBE " + std::to_string(p->id);
        const records::Mat1* material = maker.find_material(p->mid, name, p->at);
        const double smallest = std::min(p->od, p->od2.value_or(p->od));
        const bool ok = smallest > 0 && p->t >= 0 && 2 * p->t <= smallest && p->nsm >= 0;
        if (!ok)
          maker.error("fe.bad-property", p->at,
                      name + " has diameters " + show_number(p->od) + ", " + show_number(p->od2.value_or(p->od)) +
                          " and wall " + show_number(p->t) + ", expected 0 <= 2 t <= diameter",
                      "correct the tube");
        made[card.pid] = material && ok ? std::optional(make_tube(*material, *p)) : std::nullopt;
      }
    }
    const auto it = made.find(card.pid);
    make_rod(maker, "CTUBE", card.id, card.ga, card.gb, card.at,
             it != made.end() && it->second ? &*it->second : nullptr);
  }
}

}  // namespace bough::fe
