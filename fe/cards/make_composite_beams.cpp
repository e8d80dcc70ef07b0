#include "fe/cards/make_beam_properties.hpp"

namespace bough::fe {
namespace {

using records::Pbcomp;

/// Every lump with its mirror images, fractions scaled to a sum of 1. Nastran Quick Reference Guide, PBCOMP: SECTION 1
/// is symmetric about y and z, 2 about y, 3 about z, 4 about the origin, 5 not at all.
std::vector<Pbcomp::Lump> mirror_lumps(const Pbcomp& card) {
  std::vector<Pbcomp::Lump> all;
  const auto add = [&](const Pbcomp::Lump& lump, double y, double z) {
    Pbcomp::Lump image = lump;
    image.r = Eigen::Vector2d(y * lump.r[0], z * lump.r[1]);
    all.push_back(image);
  };
  for (const auto& lump : card.lumps) {
    add(lump, 1, 1);
    if (card.section == 1 || card.section == 2) add(lump, 1, -1);
    if (card.section == 1 || card.section == 3) add(lump, -1, 1);
    if (card.section == 1 || card.section == 4) add(lump, -1, -1);
  }
  double sum = 0;
  for (const auto& lump : all) sum += lump.fraction;
  for (auto& lump : all) lump.fraction /= sum > 0 ? sum : 1;
  return all;
}

}  // namespace

/// Without lumped areas: A, I and N of the card. With them I1, I2, I12 and N of the card do not count (Quick Reference
/// Guide, PBCOMP): the section is its lumps, stiffness weighted by E and mass by density, each about its own centre; A,
/// J and the shear factors stay those of the card. Lumps without a fraction only say where stresses are printed.
std::shared_ptr<BeamProperty> BeamProperties::make(const records::Pbcomp& card) {
  const std::string who = "PBCOMP " + std::to_string(card.id);
  const records::Mat1* material = maker_.find_material(card.mid, who, card.at);
  bool ok = material != nullptr, is_mixed = false, is_lumped = false;
  for (const auto& lump : card.lumps) {
    is_mixed = is_mixed || lump.mid != card.mid;
    is_lumped = is_lumped || lump.fraction > 0;
    ok = maker_.find_material(lump.mid, who, card.at) && ok;
  }
  if (is_mixed && !is_lumped) {
    maker_.error("fe.bad-property", card.at, who + " has several materials but no lumped area with a fraction C",
                 "give Y, Z and C of each material");
    return nullptr;
  }
  if (!ok) return nullptr;
  auto property = std::make_shared<BeamProperty>();
  BeamSection s;
  s.A = card.A, s.I1 = card.I1, s.I2 = card.I2, s.I12 = card.I12, s.J = card.J;
  s.nsm = card.nsm;
  s.n = card.n, s.m = card.m;
  property->material = make_isotropic(*material);
  property->has_section_inertia = true;
  property->k1 = card.k1, property->k2 = card.k2;
  if (is_lumped) {
    const auto lumps = mirror_lumps(card);
    const auto find = [&](const Pbcomp::Lump& lump) { return maker_.find_material(lump.mid, who, card.at); };
    double stiffness = 0, mass = 0;
    Eigen::Vector2d n = Eigen::Vector2d::Zero(), m = Eigen::Vector2d::Zero();
    for (const auto& lump : lumps) {
      const double e = find(lump)->E / material->E * lump.fraction * card.A,
                   rho_A = find(lump)->rho * lump.fraction * card.A;
      stiffness += e, mass += rho_A;
      n += e * lump.r, m += rho_A * lump.r;
    }
    s.A = stiffness;
    s.n = n / (stiffness > 0 ? stiffness : 1);
    s.I1 = s.I2 = s.I12 = 0;
    for (const auto& lump : lumps) {
      const double e = find(lump)->E / material->E * lump.fraction * card.A;
      const Eigen::Vector2d d = lump.r - s.n;
      s.I1 += e * d[0] * d[0], s.I2 += e * d[1] * d[1], s.I12 += e * d[0] * d[1];
    }
    if (is_mixed) {
      // The mass is carried as nonstructural, since its centre and that of the stiffness differ.
      s.nsm = mass + card.nsm;
      s.m = (m + card.nsm * card.m) / (s.nsm > 0 ? s.nsm : 1);
      s.nsi = card.nsm * (card.m - s.m).squaredNorm();
      for (const auto& lump : lumps) s.nsi += find(lump)->rho * lump.fraction * card.A * (lump.r - s.m).squaredNorm();
      property->material.rho = 0;
    }
    // Equal weights leave round-off where a product of inertia should vanish.
    if (std::abs(s.I12) < 1e-14 * (s.I1 + s.I2)) s.I12 = 0;
  }
  property->stations = {s};
  return check(*property, who, card.at) ? property : nullptr;
}

}  // namespace bough::fe
