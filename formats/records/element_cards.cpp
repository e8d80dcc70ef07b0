#include "formats/records/element_cards.hpp"

#include <algorithm>

namespace bough::records {

namespace {

constexpr unsigned kRotations = 0b111000;

/// A row: role, access to the vector, and what a card of it adds to the view. Id, property and location are set before.
template <class Access, class Describe>
ElementKind make_kind(ElementRole role, const Access& access, const Describe& describe) {
  ElementKind kind;
  kind.role = role;
  kind.count = [access](const Deck& deck) { return access(deck).size(); };
  kind.visit = [access, describe](const Deck& deck, const std::function<void(const ElementView&)>& f) {
    ElementView view;  // one for all cards: its lists keep their memory
    for (const auto& card : access(deck)) {
      view.grids.clear(), view.dependent.clear(), view.spokes.clear();
      view.is_grounded = view.has_moments = false;
      view.centre = view.orientation = view.property = 0;
      if constexpr (requires { card.id; })
        view.id = card.id;
      else
        view.id = card.sid;
      if constexpr (requires { card.pid; }) view.property = card.pid;
      view.at = card.at;
      describe(card, view);
      f(view);
    }
  };
  kind.visit_properties = [access](const Deck& deck, const std::function<void(int, int)>& f) {
    for (const auto& card : access(deck)) {
      if constexpr (requires { card.id, card.pid; }) f(card.id, card.pid);
    }
  };
  kind.keep = [access](Deck& deck, const std::function<bool()>& is_kept) {
    std::erase_if(access(deck), [&](const auto&) { return !is_kept(); });
  };
  return kind;
}

void set_line(ElementView& view, int a, int b) {
  view.grids = {a, b};
  view.num_corners = 2;
  view.shape = ElementShape::Line;
}

void set_scalar(ElementView& view, const char* family, bool by_points, int g1, int g2) {
  view.card = family + std::string(by_points ? (view.property > 0 ? "3" : "4") : (view.property > 0 ? "1" : "2"));
  set_line(view, g1, g2);
}

void set_corners(ElementView& view, ElementShape shape, const std::vector<int>& corners,
                 const std::vector<int>& midsides) {
  view.shape = shape;
  view.grids = corners;
  view.num_corners = corners.size();
  view.grids.insert(view.grids.end(), midsides.begin(), midsides.end());
}

template <class Terms>
std::vector<int> list_grids(const Terms& terms) {
  std::vector<int> grids;
  for (const auto& term : terms) grids.push_back(term.g);
  return grids;
}

template <class Terms>
void add_dependent(const Terms& terms, ElementView& view) {
  for (const auto& term : terms) view.dependent.emplace_back(term.g, static_cast<unsigned>(term.c));
}

// Access to a vector of a constant deck and of one that is changed.
#define BOUGH_CARDS(member) \
  [](auto& deck) -> auto& { return deck.member; }

std::vector<ElementKind> make_kinds() {
  using View = ElementView;
  using enum ElementRole;
  std::vector<ElementKind> kinds;
  // Kinds of which every card becomes an element.
  const auto add_made = [&](const auto& access, const auto& describe) {
    kinds.push_back(make_kind(Element, access, describe));
    kinds.back().is_always_made = true;
  };
  const auto add = [&](ElementRole role, const auto& access, const auto& describe) {
    kinds.push_back(make_kind(role, access, describe));
  };
  add(Element, BOUGH_CARDS(beams), [](const BeamElement& e, View& v) {
    v.card = e.is_cbeam ? "CBEAM" : "CBAR";
    set_line(v, e.ga, e.gb);
    v.grids.insert(v.grids.end(), {e.sa, e.sb});
    v.orientation = e.g0;
    v.has_moments = true;
  });
  add(Element, BOUGH_CARDS(crod), [](const Crod& e, View& v) { v.card = "CROD", set_line(v, e.ga, e.gb); });
  add(Element, BOUGH_CARDS(conrod), [](const Conrod& e, View& v) { v.card = "CONROD", set_line(v, e.ga, e.gb); });
  add(Element, BOUGH_CARDS(ctube), [](const Ctube& e, View& v) { v.card = "CTUBE", set_line(v, e.ga, e.gb); });
  add(Element, BOUGH_CARDS(special.cbend), [](const Cbend& e, View& v) {
    v.card = "CBEND";
    v.grids = {e.ga, e.gb};
    v.orientation = e.g0;
    v.has_moments = true;
  });
  add(Element, BOUGH_CARDS(springs), [](const ScalarSpring& e, View& v) {
    set_scalar(v, "CELAS", e.by_scalar_points, e.g1, e.g2);
    v.is_grounded = e.g1 == 0 || e.g2 == 0;
    v.has_moments = e.c1 > 3 || e.c2 > 3;
  });
  add(Element, BOUGH_CARDS(cbush), [](const Cbush& e, View& v) {
    v.card = "CBUSH";
    set_line(v, e.ga, e.gb);
    v.orientation = e.g0;
    v.is_grounded = e.gb == 0;
    v.has_moments = true;
  });
  add_made(BOUGH_CARDS(cbush1d), [](const Cbush1d& e, View& v) {
    v.card = "CBUSH1D";
    set_line(v, e.ga, e.gb);
    v.is_grounded = e.gb == 0;
  });
  add(Element, BOUGH_CARDS(dampers), [](const ScalarDamper& e, View& v) {
    set_scalar(v, "CDAMP", e.by_scalar_points, e.g1, e.g2);
    v.is_grounded = e.g1 == 0 || e.g2 == 0;
  });
  add(Element, BOUGH_CARDS(cvisc), [](const Cvisc& e, View& v) { v.card = "CVISC", set_line(v, e.ga, e.gb); });
  add(Element, BOUGH_CARDS(special.cgap), [](const Cgap& e, View& v) {
    v.card = "CGAP";
    v.grids = {e.ga, e.gb};
    v.orientation = e.g0;
  });
  add_made(BOUGH_CARDS(special.cfast), [](const Cfast& e, View& v) {
    v.card = "CFAST";
    v.grids = {e.gs, e.ga, e.gb};
  });
  add_made(BOUGH_CARDS(special.cweld), [](const Cweld& e, View& v) {
    v.card = "CWELD";
    v.grids = {e.gs, e.ga, e.gb};
    v.grids.insert(v.grids.end(), e.grids_a.begin(), e.grids_a.end());
    v.grids.insert(v.grids.end(), e.grids_b.begin(), e.grids_b.end());
    v.has_moments = e.format == "ALIGN";
  });
  add_made(BOUGH_CARDS(shells), [](const ShellElement& e, View& v) {
    v.card = e.card;
    set_corners(v, ElementShape::Surface, e.grids, e.midsides);
    v.has_moments = true;
  });
  add_made(BOUGH_CARDS(shear_panels), [](const ShearPanel& e, View& v) {
    v.card = "CSHEAR";
    set_corners(v, ElementShape::Surface, {e.grids.begin(), e.grids.end()}, {});
  });
  add_made(BOUGH_CARDS(solids), [](const SolidElement& e, View& v) {
    v.card = e.card;
    set_corners(v, ElementShape::Solid, e.corners, e.midsides);
  });
  add(Element, BOUGH_CARDS(special.genel), [](const Genel& e, View& v) {
    v.card = "GENEL";
    v.grids = list_grids(e.ui);
    const auto dependent = list_grids(e.ud);
    v.grids.insert(v.grids.end(), dependent.begin(), dependent.end());
    v.has_moments = true;
  });
  add(Element, BOUGH_CARDS(scalar_masses), [](const ScalarMass& e, View& v) {
    set_scalar(v, "CMASS", e.by_scalar_points, e.g1, e.g2);
    v.shape = ElementShape::None;
  });
  add(Element, BOUGH_CARDS(conm1), [](const Conm1& e, View& v) { v.card = "CONM1", v.grids = {e.g}; });
  add(Element, BOUGH_CARDS(conm2), [](const Conm2& e, View& v) { v.card = "CONM2", v.grids = {e.g}; });
  add(Drawn, BOUGH_CARDS(plotel), [](const Plotel& e, View& v) { v.card = "PLOTEL", set_line(v, e.ga, e.gb); });

  add(Rigid, BOUGH_CARDS(rbe2), [](const Rbe2& e, View& v) {
    v.card = "RBE2";
    v.grids = {e.gn};
    v.grids.insert(v.grids.end(), e.gm.begin(), e.gm.end());
    v.has_moments = (e.cm & kRotations) != 0;
    for (const int g : e.gm) v.dependent.emplace_back(g, e.cm);
    v.centre = e.gn, v.spokes = e.gm;
  });
  add(Rigid, BOUGH_CARDS(rbe3), [](const Rbe3& e, View& v) {
    v.card = "RBE3";
    for (const auto& group : e.groups) v.spokes.insert(v.spokes.end(), group.grids.begin(), group.grids.end());
    v.grids = {e.ref_grid};
    v.grids.insert(v.grids.end(), v.spokes.begin(), v.spokes.end());
    v.has_moments = true;
    if (e.um.empty()) v.dependent.emplace_back(e.ref_grid, e.ref_c);
    add_dependent(e.um, v);
    v.centre = e.ref_grid;
  });
  add(Rigid, BOUGH_CARDS(rbar), [](const Rbar& e, View& v) {
    v.card = "RBAR";
    v.grids = {e.ga, e.gb};
    v.has_moments = ((e.cna | e.cnb | e.cma | e.cmb) & kRotations) != 0;
    v.dependent = {{e.ga, e.cma}, {e.gb, e.cmb}};
    v.centre = e.ga, v.spokes = {e.gb};
  });
  add(Rigid, BOUGH_CARDS(rrod), [](const Rrod& e, View& v) {
    v.card = "RROD";
    v.grids = {e.ga, e.gb};
    v.dependent = {{e.cma > 0 ? e.ga : e.gb, 1U << (std::max(e.cma, e.cmb) - 1)}};
    v.centre = e.ga, v.spokes = {e.gb};
  });
  add(Rigid, BOUGH_CARDS(rbe1), [](const Rbe1& e, View& v) {
    v.card = "RBE1";
    v.grids = list_grids(e.independent);
    v.spokes = list_grids(e.dependent);
    v.grids.insert(v.grids.end(), v.spokes.begin(), v.spokes.end());
    v.has_moments = true;
    add_dependent(e.dependent, v);
    v.centre = e.independent.empty() ? 0 : e.independent.front().g;
  });
  add(Rigid, BOUGH_CARDS(special.rspline), [](const Rspline& e, View& v) {
    v.card = "RSPLINE";
    v.grids = list_grids(e.points);
    v.has_moments = true;
    add_dependent(e.points, v);
  });
  add(Rigid, BOUGH_CARDS(mpc), [](const Mpc& e, View& v) {
    v.card = "MPC";
    v.grids = list_grids(e.terms);
    if (!e.terms.empty() && e.terms.front().c > 0) v.dependent = {{e.terms.front().g, 1U << (e.terms.front().c - 1)}};
  });
  return kinds;
}

#undef BOUGH_CARDS

bool has_role(const std::vector<ElementRole>& roles, ElementRole role) {
  return std::find(roles.begin(), roles.end(), role) != roles.end();
}

}  // namespace

const std::vector<ElementKind>& list_element_kinds() {
  static const auto kinds = make_kinds();
  return kinds;
}

void visit_elements(const Deck& deck, const std::vector<ElementRole>& roles,
                    const std::function<void(const ElementView&)>& f) {
  for (const auto& kind : list_element_kinds())
    if (has_role(roles, kind.role)) kind.visit(deck, f);
}

std::size_t count_elements(const Deck& deck, ElementRole role) {
  std::size_t count = 0;
  for (const auto& kind : list_element_kinds())
    if (kind.role == role) count += kind.count(deck);
  return count;
}

void keep_elements(Deck& deck, const std::vector<ElementRole>& roles, const std::vector<char>& is_kept) {
  std::size_t next = 0;
  for (const auto& kind : list_element_kinds())
    if (has_role(roles, kind.role)) kind.keep(deck, [&] { return is_kept[next++] != 0; });
}

void clear_elements(Deck& deck, ElementRole role) {
  for (const auto& kind : list_element_kinds())
    if (kind.role == role) kind.keep(deck, [] { return false; });
}

}  // namespace bough::records
