#include <map>
#include <optional>
#include <set>

#include "base/number_text.hpp"
#include "fe/cards/maker.hpp"
#include "fe/elements/solid.hpp"

namespace bough::fe {
namespace {

struct SolidMaterial {
  Matrix6d C = Matrix6d::Zero();
  double rho = 0;
  SolidExpansion expansion;  ///< in the axes of C
  double ge = 0;
};

/// Strains in material axes from strains in basic ones; R holds the material axes in basic (Bond transformation; Auld,
/// "Acoustic fields and waves in solids", vol. 1, 3.D).
Matrix6d calc_strain_transform(const Matrix3d& R) {
  static constexpr int kPair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
  Matrix6d T;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const auto [a, b] = kPair[i];
      const auto [c, d] = kPair[j];
      const double sum = R(c, a) * R(d, b) + (c == d ? 0 : R(d, a) * R(c, b));
      T(i, j) = i < 3 ? sum * (j < 3 ? 1 : 0.5) : (j < 3 ? 2 * R(c, a) * R(c, b) : sum);
    }
  return T;
}

std::shared_ptr<const SolidExpansion> share_expansion(const SolidExpansion& expansion) {
  return expansion.alpha.isZero(0) ? nullptr : std::make_shared<const SolidExpansion>(expansion);
}

/// Elasticity and density of the material that a PSOLID names, made once; empty after reporting.
class MaterialMaker {
 public:
  explicit MaterialMaker(Maker& maker) : maker_(maker), mat9_(maker.deck().mat9) {}

  const SolidMaterial* find(const records::Psolid& property) {
    const auto [slot, is_new] = made_.try_emplace(property.id);
    if (is_new) slot->second = make(property);
    return slot->second ? &*slot->second : nullptr;
  }

 private:
  std::optional<SolidMaterial> make(const records::Psolid& property) {
    const std::string name = "PSOLID " + std::to_string(property.id);
    if (const auto* m = mat9_.find(property.mid)) {
      if (property.cordm < 0) {
        maker_.error("fe.bad-property", property.at,
                     name + " puts MAT9 " + std::to_string(m->id) + " in the element system (CORDM -1)",
                     "give the material axes as a coordinate system");
        return std::nullopt;
      }
      return SolidMaterial{m->G, m->rho, {m->alpha, m->tref}, m->ge};
    }
    const auto* m = maker_.find_material(property.mid, name, property.at);
    if (!m) return std::nullopt;
    if (!(m->nu > -1 && m->nu < 0.5)) {
      maker_.error(
          "fe.bad-material", m->at,
          "MAT1 " + std::to_string(m->id) + " has nu = " + show_number(m->nu) + ", expected -1 < nu < 0.5 in a solid",
          "correct the material");
      return std::nullopt;
    }
    SolidMaterial material;
    // Solids take E and NU; a G that differs is of beams and transverse shear (Quick Reference Guide, MAT1).
    const double G = m->E > 0 ? m->E / (2 * (1 + m->nu)) : m->G;
    material.C.topLeftCorner<3, 3>().setConstant(2 * G * m->nu / (1 - 2 * m->nu));
    material.C.diagonal().head<3>().array() += 2 * G;
    material.C.diagonal().tail<3>().setConstant(G);
    material.rho = m->rho;
    material.expansion.alpha.head<3>().setConstant(m->alpha);
    material.expansion.tref = m->tref;
    material.ge = m->ge;
    return material;
  }

  Maker& maker_;
  RecordIndex<records::Mat9> mat9_;
  std::map<int, std::optional<SolidMaterial>> made_;
};

/// IN and ISOP as far as they make another element (table of the Quick Reference Guide, PSOLID): with midside nodes the
/// points; without, TWO or THREE and FULL together are the plain element. Other combinations are the default, which is
/// said once a property: FULL alone (as in Nastran), and reduced shear without bubbles (Nastran's own).
SolidScheme choose_scheme(Maker& maker, const records::Psolid& property, const records::SolidElement& card,
                          std::set<int>& reported) {
  if (!card.midsides.empty()) return {property.points, true};
  if (card.corners.size() < 6 || (!property.is_full && property.points == 0)) return {};
  if (property.is_full && property.points > 0) return {property.points, true};
  if (reported.insert(property.id).second)
    maker.diagnostics().note(
        "fe.solid-scheme", maker.deck().locate(property.at),
        "PSOLID " + std::to_string(property.id) +
            (property.is_full
                 ? " has ISOP = FULL without IN, which Nastran takes as blank for elements without midside "
                   "nodes: they have their inner modes"
                 : " asks for reduced shear without bubbles (IN without ISOP = FULL), which is not here: "
                   "elements without midside nodes have their inner modes"),
        "IN = TWO and ISOP = FULL give the plain isoparametric element");
  return {};
}

/// Left-handed elements, reported in one note.
struct LeftHanded {
  int count = 0;
  std::string first;
  records::CardLocation at;
};

}  // namespace

void make_solids(Maker& maker) {
  const auto& deck = maker.deck();
  const RecordIndex<records::Psolid> psolid(deck.psolid);
  MaterialMaker materials(maker);
  std::map<int, std::shared_ptr<const SolidExpansion>> expansions;  // by PSOLID
  std::set<int> reported, bad_axes;
  LeftHanded turned;
  for (const auto& card : deck.solids) {
    const std::string who = card.card + " " + std::to_string(card.id);
    SolidGeometry geometry;
    geometry.kind = card.corners.size() == 8   ? SolidKind::Hexa
                    : card.corners.size() == 6 ? SolidKind::Penta
                    : card.corners.size() == 5 ? SolidKind::Pyramid
                                               : SolidKind::Tetra;
    std::vector<int> nodes;
    for (int g : card.corners) nodes.push_back(maker.find_grid(g, who, card.at));
    for (int g : card.midsides) {
      geometry.midside.push_back(g > 0 ? static_cast<int>(nodes.size()) : -1);
      if (g > 0) nodes.push_back(maker.find_grid(g, who, card.at));
    }
    const auto* property = psolid.find(card.pid);
    if (!property) {
      maker.report_missing_property(card.pid, "PSOLID", who, card.at);
      continue;
    }
    const SolidMaterial* material = materials.find(*property);
    bool complete = material != nullptr;
    for (int n : nodes) complete = complete && n >= 0;
    if (!complete) continue;
    Vector3d centre = Vector3d::Zero();
    for (int n : nodes) {
      geometry.x.push_back(maker.nodes().node(n).x);
      centre += geometry.x.back() / static_cast<double>(nodes.size());
    }
    geometry.scheme = choose_scheme(maker, *property, card, reported);
    const SolidQuality quality = calc_quality(geometry);
    if (!(quality.smallest_ratio > 0)) {
      maker.error("fe.bad-solid", card.at,
                  who + (quality.volume == 0 ? std::string(" has no volume")
                                             : " folds over itself (least Jacobian over its mean " +
                                                   show_number(quality.smallest_ratio) + ", expected above 0)"),
                  "check the order and the places of its grids");
      continue;
    }
    if (quality.volume < 0) {
      turn_round(geometry, nodes);
      if (turned.count++ == 0) turned.first = who, turned.at = card.at;
    }
    std::vector<int> gdofs;
    for (int n : nodes)
      for (int c = 0; c < 3; ++c) gdofs.push_back(maker.nodes().node(n).first_gdof + c);
    Matrix6d C = material->C;
    // Parts that elements share are computed once.
    auto& expansion = expansions[property->id];
    if (!expansion) expansion = share_expansion(material->expansion);
    auto own = expansion;
    if (property->cordm > 0) {
      Diagnostics found;
      const Matrix3d R = maker.nodes().calc_axes(property->cordm, centre, deck.locate(property->at), found);
      if (found.num_errors() > 0) {
        if (bad_axes.insert(property->id).second)
          maker.error("fe.missing-coordinates", property->at,
                      "PSOLID " + std::to_string(property->id) + " has CORDM " + std::to_string(property->cordm) +
                          ", a coordinate system that the deck does not define",
                      "add the CORD card or correct the field");
        continue;
      }
      const Matrix6d T = calc_strain_transform(R);
      C = (T.transpose() * C * T).eval();
      if (own) own = share_expansion({T.inverse() * own->alpha, own->tref});
    }
    maker.add(std::make_unique<Solid>(card.id, card.card, nodes, std::move(gdofs), std::move(geometry), C,
                                      material->rho, std::move(own)),
              material->ge);
  }
  if (turned.count > 0) {
    const std::string more = turned.count > 1 ? " and " + std::to_string(turned.count - 1) + " solids more" : "";
    maker.diagnostics().note("fe.left-handed", deck.locate(turned.at),
                             turned.first + more +
                                 (more.empty() ? " is numbered left-handed; its node order is"
                                               : " are numbered left-handed; their node order is") +
                                 " reversed",
                             {});
  }
}

}  // namespace bough::fe
