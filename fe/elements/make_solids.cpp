#include <map>
#include <optional>

#include "bough/fe/elements/maker.hpp"
#include "bough/fe/elements/solid.hpp"

namespace bough::fe {
namespace {

struct SolidMaterial {
  Matrix6d C = Matrix6d::Zero();
  double rho = 0;
  SolidExpansion expansion;  ///< in the axes of C
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

/// The law and density a PSOLID names, made once; empty after reporting.
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
      return SolidMaterial{m->G, m->rho, {m->alpha, m->tref}};
    }
    const auto* m = maker_.find_material(property.mid, name, property.at);
    if (!m) return std::nullopt;
    if (!(m->nu > -1 && m->nu < 0.5)) {
      maker_.error("fe.bad-material", m->at,
                   "MAT1 " + std::to_string(m->id) + " has nu = " + show(m->nu) + ", expected -1 < nu < 0.5 in a solid",
                   "correct the material");
      return std::nullopt;
    }
    SolidMaterial material;
    material.C.topLeftCorner<3, 3>().setConstant(2 * m->G * m->nu / (1 - 2 * m->nu));
    material.C.diagonal().head<3>().array() += 2 * m->G;
    material.C.diagonal().tail<3>().setConstant(m->G);
    material.rho = m->rho;
    material.expansion.alpha.head<3>().setConstant(m->alpha);
    material.expansion.tref = m->tref;
    return material;
  }

  Maker& maker_;
  Index<records::Mat9> mat9_;
  std::map<int, std::optional<SolidMaterial>> made_;
};

}  // namespace

void make_solids(Maker& maker) {
  const auto& deck = maker.deck();
  const Index<records::Psolid> psolid(deck.psolid);
  MaterialMaker materials(maker);
  std::map<int, std::shared_ptr<const SolidExpansion>> expansions;  // by PSOLID
  for (const auto& card : deck.solids) {
    const std::string who = card.card + " " + std::to_string(card.id);
    SolidGeometry geometry;
    geometry.kind = card.card == "CHEXA"    ? SolidKind::Hexa
                    : card.card == "CPENTA" ? SolidKind::Penta
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
    std::vector<int> gdofs;
    for (int n : nodes) {
      geometry.x.push_back(maker.nodes().node(n).x);
      centre += geometry.x.back() / static_cast<double>(nodes.size());
      for (int c = 0; c < 3; ++c) gdofs.push_back(maker.nodes().node(n).first_gdof + c);
    }
    Matrix6d C = material->C;
    // Only what differs from element to element is made anew.
    auto& expansion = expansions[property->id];
    if (!expansion) expansion = share_expansion(material->expansion);
    auto own = expansion;
    if (property->cordm > 0) {
      const Matrix6d T = calc_strain_transform(
          maker.nodes().calc_axes(property->cordm, centre, deck.locate(property->at), maker.diagnostics()));
      C = (T.transpose() * C * T).eval();
      if (own) own = share_expansion({T.inverse() * own->alpha, own->tref});
    }
    auto solid = std::make_unique<Solid>(card.id, card.card, nodes, std::move(gdofs), std::move(geometry), C,
                                         material->rho, std::move(own));
    double ratio = 0;
    if (!(solid->calc_volume(&ratio) > 0) || !(ratio > 0)) {
      maker.error(
          "fe.bad-solid", card.at,
          who + " is turned inside out or folded (smallest Jacobian ratio " + show(ratio) + ", expected above 0)",
          "check the order of its grids");
      continue;
    }
    maker.add(std::move(solid));
  }
}

}  // namespace bough::fe
