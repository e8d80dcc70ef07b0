#include <cmath>
#include <numbers>
#include <optional>

#include "base/number_text.hpp"
#include "fe/cards/make_beam_properties.hpp"
#include "fe/elements/bend.hpp"

namespace bough::fe {
namespace {

/// The arc about `centre` from a towards the side of `hint`; angle by the radii of both ends.
BendGeometry make_arc(const Vector3d& centre, const Vector3d& a, const Vector3d& b, const Vector3d& hint) {
  BendGeometry g;
  g.centre = centre;
  g.radial = a - centre;
  const double radius = g.radial.norm();
  const Vector3d along = hint - hint.dot(g.radial) / (radius * radius) * g.radial;
  g.tangent = radius * along.normalized();
  const Vector3d end = b - centre;
  g.angle = std::atan2(end.dot(g.tangent), end.dot(g.radial));
  if (g.angle <= 0) g.angle += 2 * std::numbers::pi;
  return g;
}

/// Part of v across e.
Vector3d take_across(const Vector3d& v, const Vector3d& e) { return v - v.dot(e) / e.squaredNorm() * e; }

/// The arc of a card (Quick Reference Guide, CBEND); nothing when its data make none. v points from GA to GO.
std::optional<BendGeometry> find_arc(int geom, const Vector3d& a, const Vector3d& b, const Vector3d& v, double radius,
                                     double theta) {
  const Vector3d chord = b - a;
  const double L = chord.norm();
  const Vector3d across = take_across(v, chord);
  if (!(across.norm() > 1e-8 * v.norm())) return std::nullopt;
  if (geom == 1) {  // the centre is on the line along v
    const double along = v.dot(chord);
    if (!(std::abs(along) > 1e-10 * v.norm() * L)) return std::nullopt;
    return make_arc(a + L * L / (2 * along) * v, a, b, chord);
  }
  if (geom == 2) {  // v is the tangent at end A
    const Vector3d inward = take_across(chord, v);
    return make_arc(a + L * L / (2 * chord.dot(inward)) * inward, a, b, v);
  }
  // GO and the arc are on one side of the chord, the centre on the other.
  const double R = geom == 3 ? radius : L / (2 * std::sin(theta / 2));
  if (!(R >= 0.5 * L * (1 - 1e-9)) || (geom == 4 && !(theta > 0 && theta < 2 * std::numbers::pi))) return std::nullopt;
  const double height = geom == 3 ? std::sqrt(std::max(R * R - L * L / 4, 0.0)) : R * std::cos(theta / 2);
  const Vector3d centre = a + chord / 2 - height * across.normalized();
  // Leaving A, the arc goes to the side of GO and along the chord.
  return make_arc(centre, a, b, height >= 0 ? chord : -chord + 2 * L * across.normalized());
}

std::shared_ptr<const BeamProperty> make_property(Maker& maker, const records::Pbend& card) {
  const std::string who = "PBEND " + std::to_string(card.id);
  const records::Mat1* material = maker.find_material(card.mid, who, card.at);
  BeamSection s;
  s.A = card.A, s.I1 = card.I1, s.I2 = card.I2, s.J = card.J, s.nsm = card.nsm;
  if (card.is_pipe) {
    // A thin ring of mean radius r: exact for any wall.
    const double r = card.rm, t = card.t;
    s.A = 2 * std::numbers::pi * r * t;
    s.I1 = s.I2 = std::numbers::pi * r * t * (r * r + t * t / 4);
    s.J = 2 * s.I1;
  }
  const auto fail = [&](const std::string& what, const std::string& advice) {
    maker.error("fe.bad-property", card.at, who + what, advice);
    return nullptr;
  };
  if (card.is_pipe && card.fsi != 1)
    return fail(" has FSI = " + std::to_string(card.fsi) + ", a flexibility factor of curved pipes, expected 1 (none)",
                "give A, I1, I2, J with the factor in them");
  if (card.rc != 0 || card.zc != 0)
    return fail(
        " has RC = " + show_number(card.rc) + ", ZC = " + show_number(card.zc) + ", expected an axis through the grids",
        "put the grids on the axis, with rigid elements where it is off");
  if (!(s.A > 0 && s.I1 > 0 && s.I2 > 0 && s.J > 0 && s.nsm >= 0))
    return fail(" has A = " + show_number(s.A) + ", I1 = " + show_number(s.I1) + ", I2 = " + show_number(s.I2) +
                    ", J = " + show_number(s.J) + ", expected positive values",
                "correct the property");
  if (!material) return nullptr;
  auto property = std::make_shared<BeamProperty>();
  property->material = make_isotropic(*material);
  property->k1 = card.k1, property->k2 = card.k2;
  property->stations = {s};
  return property;
}

}  // namespace

void make_bends(Maker& maker) {
  const RecordIndex<records::Pbend> properties(maker.deck().special.pbend);
  std::unordered_map<int, std::shared_ptr<const BeamProperty>> made;
  for (const auto& card : maker.deck().special.cbend) {
    const std::string who = "CBEND " + std::to_string(card.id);
    const records::Pbend* p = properties.find(card.pid);
    if (!p) maker.report_missing_property(card.pid, "PBEND", who, card.at);
    if (p && made.count(card.pid) == 0) made[card.pid] = make_property(maker, *p);
    const int a = maker.find_grid(card.ga, who, card.at), b = maker.find_grid(card.gb, who, card.at);
    const int g0 = card.g0 > 0 ? maker.find_grid(card.g0, who, card.at) : 0;
    if (!p || a < 0 || b < 0 || g0 < 0) continue;
    const Node& node_a = maker.nodes().node(a);
    const Vector3d x_a = node_a.x, x_b = maker.nodes().node(b).x;
    const Vector3d v = card.g0 > 0 ? Vector3d(maker.nodes().node(g0).x - x_a) : Vector3d(node_a.R_basic_cd * card.v);
    const auto arc = find_arc(card.geom, x_a, x_b, v, p->rb, p->theta_b_deg * std::numbers::pi / 180);
    if (!arc) {
      maker.error(
          "fe.bad-orientation", card.at,
          who + " has no arc: its grids, GO or vector and GEOM " + std::to_string(card.geom) + " do not fit each other",
          "GO must be off the line of the grids; GEOM 3 needs RB of half their distance or more, GEOM 4 THETAB");
      continue;
    }
    if (made[card.pid])
      maker.add(std::make_unique<Bend>(card.id, std::vector{a, b}, maker.list_gdofs({a, b}), made[card.pid], *arc),
                made[card.pid]->material.ge);
  }
}

}  // namespace bough::fe
