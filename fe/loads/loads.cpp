#include "fe/loads/loads.hpp"

#include <algorithm>

#include "fe/loads/inertial_loads.hpp"
#include "fe/loads/load_sets.hpp"
#include "fe/model/named_grid.hpp"
#include "formats/records/selection.hpp"

namespace bough::fe {

int LoadTarget::find_grid(int id, const std::string& card, const records::CardLocation& at) const {
  return find_named_six(model, id, card, deck.locate(at), diagnostics);
}

namespace {

bool add_directed_loads(const LoadTarget& t) {
  bool is_found = false;
  for (const auto& load : t.deck.load_cards.directed) {
    if (load.sid != t.set) continue;
    is_found = true;
    const std::string card = std::string(load.is_moment ? "MOMENT" : "FORCE") + (load.is_cross ? "2" : "1");
    const int index = t.find_grid(load.g, card, load.at);
    std::array<Vector3d, 4> x;
    bool is_valid = index >= 0;
    FollowerForce moving{index, load.is_moment, load.is_cross, t.scale * load.f, {}};
    for (std::size_t i = 0; i < (load.is_cross ? 4u : 2u); ++i) {
      const int k = t.find_grid(load.grids[i], card, load.at);
      is_valid = is_valid && k >= 0;
      moving.nodes[i] = k;
      if (k >= 0) x[i] = t.model.node(k).x;
    }
    if (!is_valid) continue;
    Vector3d direction = x[1] - x[0];
    double size = direction.norm();
    if (load.is_cross) {
      size *= (x[3] - x[2]).norm();
      direction = direction.cross(x[3] - x[2]).eval();
    }
    if (!(direction.norm() > 1e-12 * size)) {
      t.diagnostics.error("fe.no-direction", t.deck.locate(load.at),
                          card + " at grid " + std::to_string(load.g) + " has no direction: its grids " +
                              (load.is_cross ? "give two parallel vectors" : "coincide"),
                          "name other grids");
      continue;
    }
    t.F.segment<3>(t.model.node(index).first_gdof + (load.is_moment ? 3 : 0)) +=
        t.scale * load.f * direction.normalized();
    if (t.moving) t.moving->forces.push_back(moving);
  }
  return is_found;
}

bool add_scalar_loads(const LoadTarget& t) {
  bool is_found = false;
  for (const auto& load : t.deck.load_cards.scalar) {
    if (load.sid != t.set) continue;
    is_found = true;
    const int index = t.model.find_node(load.point);
    if (index >= 0) {
      // At a grid: along the first displacement axis (Quick Reference Guide, SLOAD).
      const Node& node = t.model.node(index);
      if (node.num_dofs == 1)
        t.F[node.first_gdof] += t.scale * load.f;
      else
        t.F.segment<3>(node.first_gdof) += t.scale * load.f * node.R_basic_cd.col(0);
      continue;
    }
    if (t.model.is_refused(load.point)) continue;
    t.diagnostics.error("fe.missing-grid", t.deck.locate(load.at),
                        "SLOAD names point " + std::to_string(load.point) + ", which the deck does not define",
                        "add the SPOINT or GRID, or correct the id");
  }
  return is_found;
}

/// Warnings of terms of a LOAD card that Nastran ignores, or rejects and Bough adds up.
void report_terms(const records::Deck& deck, const records::LoadCombination& card, Diagnostics& diagnostics) {
  for (const auto& [scale, sid] : card.terms)
    if (!has_load_cards(deck, sid) && find_combination(deck, sid))
      diagnostics.warning("fe.nested-load", deck.locate(card.at),
                          "LOAD " + std::to_string(card.sid) + " names set " + std::to_string(sid) +
                              ", which is a LOAD card itself; the sets of that card are added, as MSC Nastran does",
                          "name plain load sets: other Nastrans stop here");
}

}  // namespace

bool add_point_loads(const LoadTarget& t) {
  bool is_found = false;
  for (const auto& load : t.deck.point_loads) {
    if (load.sid != t.set) continue;
    is_found = true;
    const int index = t.find_grid(load.g, load.is_moment ? "MOMENT" : "FORCE", load.at);
    if (index < 0) continue;
    const Node& node = t.model.node(index);
    const Matrix3d R = t.model.calc_axes(load.cid, node.x, t.deck.locate(load.at), t.diagnostics);
    t.F.segment<3>(node.first_gdof + (load.is_moment ? 3 : 0)) += t.scale * load.f * (R * load.n);
  }
  const bool has_directed = add_directed_loads(t), has_scalar = add_scalar_loads(t);
  return is_found || has_directed || has_scalar;
}

bool report_unread_loads(const records::Deck& deck, const std::string& command, int set, Diagnostics& diagnostics) {
  bool is_found = false;
  for (const auto& load : deck.unread_loads) {
    if (load.set != set || load.command != command) continue;
    is_found = true;
    diagnostics.error("fe.unread-load", deck.locate(load.at),
                      load.card + " of set " + std::to_string(set) + " is not read, and " + command + " selects it",
                      "give the load by other cards, or --ignore " + load.card + " to compute without it");
  }
  return is_found;
}

FollowerLoads find_follower_loads(const Model& model, const records::Deck& deck, int set) {
  FollowerLoads moving;
  AppliedLoad ignored;
  ignored.F = VectorXd::Zero(model.num_gdofs());
  Diagnostics ignored_diagnostics;
  for_each_plain_set(deck, set, [&](int sid, double scale, const records::CardLocation&) {
    const LoadTarget target{
        model, deck, sid, scale, ignored.F, ignored_diagnostics, ignored.A_I, ignored.arms, ignored.followers, &moving};
    add_point_loads(target);
    add_surface_loads(target);
  });
  return moving;
}

VectorXd calc_load(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics) {
  return calc_applied_load(model, deck, set, diagnostics).F;
}

AppliedLoad calc_applied_load(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics) {
  AppliedLoad load;
  load.F = VectorXd::Zero(model.num_gdofs());
  if (const auto* card = find_combination(deck, set)) {
    report_terms(deck, *card, diagnostics);
    if (has_loading_cards(deck, set))
      diagnostics.error("fe.duplicate-set", deck.locate(card->at),
                        "LOAD " + std::to_string(set) + " has the id of load cards, which it would leave out",
                        "give the LOAD card or these cards another id");
  }
  const auto sets = list_plain_sets(deck, set);
  std::vector<PlainLoadSet> missing;
  const bool has_part_loads = add_part_loads(model, set, load);
  bool is_accelerated = false;
  for (const auto& plain : sets) {
    if (plain.enforced_only) continue;
    if (plain.is_circle) {
      diagnostics.error("fe.load-circle", deck.locate(plain.at),
                        "LOAD " + std::to_string(plain.sid) + " goes in a circle: this card names it again",
                        "name sets of FORCE, MOMENT, PLOAD and the like");
      continue;
    }
    const LoadTarget target{model,       deck,     plain.sid, plain.scale,   load.F,
                            diagnostics, load.A_I, load.arms, load.followers};
    const bool found[] = {add_point_loads(target), add_body_loads(target),         add_surface_loads(target),
                          add_beam_loads(target),  add_superelement_loads(target), has_enforced(deck, plain.sid)};
    const auto& fields = deck.special.accelerations;
    is_accelerated = is_accelerated ||
                     std::any_of(fields.begin(), fields.end(), [&](const auto& card) { return card.sid == plain.sid; });
    if (report_unread_loads(deck, "LOAD", plain.sid, diagnostics)) continue;
    const bool is_of_part = has_part_loads && plain.sid == set;
    if (!is_of_part && std::find(std::begin(found), std::end(found), true) == std::end(found)) missing.push_back(plain);
  }
  // A LOAD card of which something is left loads the structure, as in Nastran.
  const auto severity = missing.size() < sets.size() ? Severity::Warning : Severity::Error;
  for (const auto& plain : missing)
    diagnostics.add(
        {severity, "fe.missing-load",
         deck.locate(plain.at.line > 0 ? plain.at : records::find_selection(deck, "LOAD", set)),
         "load set " + std::to_string(plain.sid) + " has no FORCE, MOMENT, GRAV, PLOAD or LOAD card" +
             (severity == Severity::Warning ? "; LOAD " + std::to_string(set) + " is taken without it" : ""),
         "correct the set id or add its cards"});
  is_accelerated = is_accelerated || !load.A_I.isZero(0);
  if (!load.A_I.isZero(0)) {
    load.F += calc_inertial_loads(model, model.mass_kind(), load.A_I);
    // Nastran: loads of the interior come with the matrices or the section of the superelement; gravity is such a load.
    if (const auto without = list_without_gravity(model, deck); !without.empty())
      load.F -= calc_superelement_loads(model, model.mass_kind(), load.A_I, without).col(0);
  }
  if (is_accelerated) report_gravity(model, deck, set, diagnostics);
  return load;
}

}  // namespace bough::fe
