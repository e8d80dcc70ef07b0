#include "fe/cards/make_beam_properties.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "base/number_text.hpp"
#include "fe/sections/section_library.hpp"

namespace bough::fe {

Isotropic make_isotropic(const records::Mat1& material) {
  return {material.E, material.G, material.rho, material.alpha, material.tref, material.ge};
}

namespace {

bool is_same(const BeamSection& a, const BeamSection& b) {
  return a.A == b.A && a.I1 == b.I1 && a.I2 == b.I2 && a.I12 == b.I12 && a.J == b.J && a.nsm == b.nsm &&
         a.nsi == b.nsi && a.n == b.n && a.m == b.m;
}

/// Equal stations are one uniform section, for which the element has cheaper exact rules.
void simplify(BeamProperty* property) {
  auto& stations = property->stations;
  if (std::all_of(stations.begin(), stations.end(), [&](const auto& s) { return is_same(s, stations.front()); }))
    stations.resize(1);
}

/// Sets the stress points C to F of the deck; none if all are zero.
void set_points(const std::array<Eigen::Vector2d, 4>& a, const std::array<Eigen::Vector2d, 4>& b,
                BeamProperty& property) {
  const auto is_zero = [](const Eigen::Vector2d& p) { return p.isZero(0); };
  if (std::all_of(a.begin(), a.end(), is_zero) && std::all_of(b.begin(), b.end(), is_zero)) return;
  property.points_a.assign(a.begin(), a.end());
  property.points_b.assign(b.begin(), b.end());
}

/// NASTRAN BARMASS = n, n > 0 (Quick Reference Guide, nastran command: system cells).
bool has_barmass(const records::Deck& deck) {
  const auto cell = deck.system_cells.find("BARMASS");
  return cell != deck.system_cells.end() && std::atoi(cell->second.c_str()) > 0;
}

}  // namespace

BeamProperties::BeamProperties(Maker& maker)
    : maker_(maker),
      pbar_(maker.deck().pbar),
      pbarl_(maker.deck().pbarl),
      pbeam_(maker.deck().pbeam),
      pbeaml_(maker.deck().pbeaml),
      pbcomp_(maker.deck().special.pbcomp) {}

std::shared_ptr<const BeamProperty> BeamProperties::find(const records::BeamElement& card, const std::string& who) {
  auto& made = card.is_cbeam ? beams_ : bars_;
  if (const auto it = made.find(card.pid); it != made.end()) return it->second;
  std::shared_ptr<BeamProperty> property;
  if (card.is_cbeam) {
    if (const auto* p = pbeam_.find(card.pid)) {
      property = make(*p);
    } else if (const auto* l = pbeaml_.find(card.pid)) {
      property = make(*l);
    } else if (const auto* c = pbcomp_.find(card.pid)) {
      property = make(*c);
    } else {
      const bool is_bar = pbar_.find(card.pid) || pbarl_.find(card.pid);
      maker_.report_missing_property(
          card.pid, is_bar ? "PBEAM or PBEAML (it is a bar property)" : "PBEAM, PBEAML or PBCOMP", who, card.at);
      return nullptr;
    }
  } else {
    if (const auto* p = pbar_.find(card.pid)) {
      property = make(*p);
    } else if (const auto* l = pbarl_.find(card.pid)) {
      property = make(*l);
    } else {
      const bool is_beam = pbeam_.find(card.pid) || pbeaml_.find(card.pid) || pbcomp_.find(card.pid);
      maker_.report_missing_property(card.pid, is_beam ? "PBAR or PBARL (it is a beam property)" : "PBAR or PBARL", who,
                                     card.at);
      return nullptr;
    }
  }
  if (property && !card.is_cbeam) property->has_torsional_inertia = has_barmass(maker_.deck());
  made[card.pid] = property;
  return property;
}

std::shared_ptr<BeamProperty> BeamProperties::make(const records::Pbar& card) {
  const std::string who = "PBAR " + std::to_string(card.id);
  const records::Mat1* material = maker_.find_material(card.mid, who, card.at);
  auto property = std::make_shared<BeamProperty>();
  BeamSection s;
  s.A = card.A, s.I1 = card.I1, s.I2 = card.I2, s.I12 = card.I12, s.J = card.J, s.nsm = card.nsm;
  property->stations = {s};
  set_points(card.recovery, card.recovery, *property);
  property->k1 = card.k1.value_or(0);
  property->k2 = card.k2.value_or(0);
  if (card.I12 != 0 && (property->k1 != 0 || property->k2 != 0)) {
    maker_.diagnostics().warning(
        "fe.shear-ignored", maker_.deck().locate(card.at),
        who + " has I12, with which Nastran ignores the shear factors K1 and K2; so does Bough",
        "use a PBEAM if the bar is short enough for shear to matter");
    property->k1 = property->k2 = 0;
  }
  const bool ok = check(*property, who, card.at);
  if (!material || !ok) return nullptr;
  property->material = make_isotropic(*material);
  return property;
}

std::shared_ptr<BeamProperty> BeamProperties::make(const records::Pbarl& card) {
  const std::string who = "PBARL " + std::to_string(card.id);
  const records::Mat1* material = maker_.find_material(card.mid, who, card.at);
  std::string problem;
  const auto section = calc_library_section(card.shape, card.dims, &problem);
  if (!section) maker_.error("fe.bad-section", card.at, who + " " + problem, "correct the shape or its dimensions");
  if (!material || !section) return nullptr;
  auto property = std::make_shared<BeamProperty>();
  BeamSection s;
  s.A = section->A, s.I1 = section->I1, s.I2 = section->I2, s.I12 = section->I12, s.J = section->J, s.nsm = card.nsm;
  property->stations = {s};
  property->points_a = property->points_b = section->points;
  property->material = make_isotropic(*material);
  // Shear factors are ruled out by I12, as for a PBAR. The bar's axis is its centroid: n stays zero.
  property->k1 = s.I12 == 0 ? section->k1 : 0;
  property->k2 = s.I12 == 0 ? section->k2 : 0;
  return check(*property, who, card.at) ? property : nullptr;
}

std::shared_ptr<BeamProperty> BeamProperties::make(const records::Pbeam& card) {
  const std::string who = "PBEAM " + std::to_string(card.id);
  const records::Mat1* material = maker_.find_material(card.mid, who, card.at);
  auto property = std::make_shared<BeamProperty>();
  const Eigen::Vector2d n_a(card.n1_a, card.n2_a), n_b(card.n1_b, card.n2_b);
  const Eigen::Vector2d m_a(card.m1_a, card.m2_a), m_b(card.m1_b, card.m2_b);
  for (const records::PbeamStation& station : card.stations) {
    const double t = station.x_over_L;
    BeamSection s;
    s.x_over_L = t;
    s.A = station.A, s.I1 = station.I1, s.I2 = station.I2, s.I12 = station.I12, s.J = station.J, s.nsm = station.nsm;
    s.nsi = (1 - t) * card.nsi_a + t * card.nsi_b;
    s.n = (1 - t) * n_a + t * n_b;
    s.m = (1 - t) * m_a + t * m_b;
    property->stations.push_back(s);
  }
  set_points(card.stations.front().recovery, card.stations.back().recovery, *property);
  property->k1 = card.k1.value_or(1);
  property->k2 = card.k2.value_or(1);
  property->has_section_inertia = true;
  const auto warn = [&](const char* id, const std::string& what) {
    maker_.diagnostics().warning(id, maker_.deck().locate(card.at), who + what, {});
  };
  if (card.s1 != 0 || card.s2 != 0)
    warn("fe.shear-relief-ignored", " has shear relief factors S1, S2, which are not used");
  if (card.cw_a != 0 || card.cw_b != 0) warn("fe.warping-ignored", " has warping coefficients, which are not used");
  const bool ok = check(*property, who, card.at);
  if (!material || !ok) return nullptr;
  property->material = make_isotropic(*material);
  simplify(property.get());
  return property;
}

std::shared_ptr<BeamProperty> BeamProperties::make(const records::Pbeaml& card) {
  const std::string who = "PBEAML " + std::to_string(card.id);
  const records::Mat1* material = maker_.find_material(card.mid, who, card.at);
  auto property = std::make_shared<BeamProperty>();
  property->has_section_inertia = true;
  bool ok = true;
  for (const records::PbeamlStation& station : card.stations) {
    std::string problem;
    const auto section = calc_library_section(card.shape, station.dims, &problem);
    if (!section) {
      maker_.error("fe.bad-section", card.at, who + " " + problem + " at station " + show_number(station.x_over_L),
                   "correct the shape or its dimensions");
      ok = false;
      continue;
    }
    BeamSection s;
    s.x_over_L = station.x_over_L;
    s.A = section->A, s.I1 = section->I1, s.I2 = section->I2, s.I12 = section->I12, s.J = section->J;
    s.nsm = station.nsm;
    s.n = s.m = section->n;
    auto& points = property->stations.empty() ? property->points_a : property->points_b;
    points = section->points;
    for (auto& point : points) point += s.n;
    property->stations.push_back(s);
    if (property->stations.size() == 1) property->k1 = section->k1, property->k2 = section->k2;
  }
  if (!material || !ok || !check(*property, who, card.at)) return nullptr;
  if (property->stations.size() == 1) property->points_b = property->points_a;
  if (property->points_a.size() != property->points_b.size()) property->points_a.clear(), property->points_b.clear();
  property->material = make_isotropic(*material);
  simplify(property.get());
  return property;
}

bool BeamProperties::check(const BeamProperty& property, const std::string& who, const records::CardLocation& at) {
  bool ok = !property.stations.empty();
  if (!ok) maker_.error("fe.bad-property", at, who + " has no section", "give A and the moments of inertia");
  for (std::size_t k = 0; k < property.stations.size(); ++k) {
    const BeamSection& s = property.stations[k];
    const auto fail = [&](const std::string& what, const std::string& advice) {
      maker_.error("fe.bad-property", at, who + what, advice);
      ok = false;
    };
    const std::string where = property.is_uniform() ? "" : " at station " + show_number(s.x_over_L);
    if (k > 0 && !(s.x_over_L > property.stations[k - 1].x_over_L))
      fail(" has two stations at x/L = " + show_number(s.x_over_L), "give each station its own x/L");
    const std::pair<const char*, double> values[] = {{"A", s.A}, {"I1", s.I1}, {"I2", s.I2}, {"J", s.J}};
    for (const auto& [name, value] : values)
      if (!(value >= 0))
        fail(std::string(" has ") + name + " = " + show_number(value) + where + ", expected zero or more",
             "correct the property");
    if (!(s.A + s.I1 + s.I2 + s.J > 0))
      fail(" has no area and no inertia" + where, "give A and the moments of inertia");
    if (s.I12 != 0 && !(s.I1 * s.I2 > s.I12 * s.I12))
      fail(" has I12 = " + show_number(s.I12) + where + ", but I1 I2 - I12^2 must be positive",
           "correct the moments of inertia");
    if (!(s.nsm >= 0 && s.nsi >= 0)) fail(" has a negative nonstructural mass" + where, "correct the property");
  }
  if (!(property.k1 >= 0 && property.k2 >= 0)) {
    maker_.error("fe.bad-property", at, who + " has a negative shear factor", "K1 and K2 are zero or positive");
    ok = false;
  }
  return ok;
}

}  // namespace bough::fe
