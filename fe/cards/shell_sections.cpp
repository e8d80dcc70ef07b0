#include "fe/cards/shell_sections.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include "base/number_text.hpp"
#include "fe/sections/shell_stress.hpp"
#include "formats/records/params.hpp"

namespace bough::fe {

namespace {
constexpr double kDegree = std::numbers::pi / 180;

/// Shear modulus of membrane and bending: by E and NU, while G is of transverse shear (Quick Reference Guide, MAT1).
double find_in_plane_modulus(const records::Mat1& m) { return m.E > 0 ? m.E / (2 * (1 + m.nu)) : m.G; }
}  // namespace

ShellSections::ShellSections(Maker& maker)
    : maker_(maker),
      pshell_(maker.deck().pshell),
      pcomp_(maker.deck().pcomp),
      mat1_(maker.deck().mat1),
      mat2_(maker.deck().mat2),
      mat8_(maker.deck().mat8) {
  const auto& t = maker.deck().temperatures;
  has_temperatures_ = !t.grids.empty() || !t.defaults.empty() || !t.bars.empty() || !t.plates.empty();
  for (const auto& subcase : maker.deck().subcases) has_initial_ = has_initial_ || subcase.initial_temperature != 0;
  drilling_factor_ = 1e-6 * records::get_real_param(maker.deck(), "K6ROT", 100, maker.diagnostics());
}

const ShellSection* ShellSections::find(int pid, const std::string& who, const records::CardLocation& at,
                                        std::optional<double> thickness) {
  const auto key = std::make_pair(pid, thickness.value_or(-1));
  if (const auto it = made_.find(key); it != made_.end()) return it->second ? &*it->second : nullptr;
  auto& slot = made_[key];
  if (const auto* p = pshell_.find(pid)) {
    slot = make_pshell(*p, who, at, thickness);
  } else if (const auto* c = pcomp_.find(pid)) {
    slot = make_pcomp(*c);
  } else {
    maker_.report_missing_property(pid, "PSHELL, PCOMP or PCOMPG", who, at);
  }
  if (slot) slot->drilling = drilling_factor_ * slot->A(2, 2);
  return slot ? &*slot : nullptr;
}

std::optional<double> ShellSections::find_thickness(int pid) const {
  const auto* p = pshell_.find(pid);
  return p ? p->t : std::nullopt;
}

std::optional<PlaneMaterial> ShellSections::find_material(int mid, const std::string& who,
                                                          const records::CardLocation& at) {
  const auto [slot, is_new] = materials_.try_emplace(mid);
  if (is_new) slot->second = make_material(mid, who, at);
  return slot->second;
}

std::optional<PlaneMaterial> ShellSections::make_material(int mid, const std::string& who,
                                                          const records::CardLocation& at) {
  if (const auto* m = mat8_.find(mid)) {
    if (!(m->E1 > 0 && m->E2 > 0 && m->G12 > 0 && m->nu12 * m->nu12 * m->E2 < m->E1)) {
      maker_.error("fe.bad-material", m->at, "MAT8 " + std::to_string(mid) + " is not positive definite",
                   "E1, E2, G12 are positive and NU12² E2 < E1");
      return std::nullopt;
    }
    auto p = make_orthotropic_plane(m->E1, m->E2, m->nu12, m->G12, m->G1z, m->G2z, m->rho);
    p.alpha = {m->a1, m->a2, 0};
    p.tref = m->tref;
    p.ge = m->ge;
    return p;
  }
  if (const auto* m = mat2_.find(mid)) {
    PlaneMaterial p;
    p.Q = m->G;
    p.G << m->G(0, 0), m->G(0, 1), m->G(0, 1),
        m->G(1, 1);  // a MAT2 named by MID3 gives G11 G12 G22 of the shear stiffness
    p.rho = m->rho;
    p.shear_rigid = true;  // no shear flexibility if the section is a ply
    p.alpha = m->alpha;
    p.tref = m->tref;
    p.ge = m->ge;
    return p;
  }
  if (!mat1_.find(mid)) {
    if (maker_.deck().is_refused(mid, {"MAT1", "MAT2", "MAT8"})) return std::nullopt;
    maker_.error(
        "fe.missing-material", at,
        who + " refers to material " + std::to_string(mid) + ", but the deck has no MAT1, MAT2 or MAT8 with that id",
        "add the material or correct the id");
    return std::nullopt;
  }
  const records::Mat1* m = maker_.find_material(mid, who, at);
  if (!m) return std::nullopt;
  auto p = make_isotropic_plane(m->E, find_in_plane_modulus(*m), m->nu, m->rho);
  p.G = m->G * Eigen::Matrix2d::Identity();
  p.alpha = {m->alpha, m->alpha, 0};
  p.tref = m->tref;
  p.ge = m->ge;
  return p;
}

std::optional<PlaneMaterial> ShellSections::find_plane_strain(const records::Pshell& p) {
  const std::string name = "PSHELL " + std::to_string(p.id);
  const auto* m = mat1_.find(p.mid1);
  if (!m || !(std::abs(m->nu) < 0.5)) {
    maker_.error("fe.bad-property", p.at,
                 name + " is in plane strain (MID2 = -1), but MID1 " + std::to_string(p.mid1) +
                     (m ? " has NU of 0.5 or more" : " is no MAT1"),
                 "give MID1 a MAT1 with NU below 0.5");
    return std::nullopt;
  }
  if (!maker_.find_material(p.mid1, name, p.at)) return std::nullopt;
  auto plane = make_isotropic_plane(m->E, find_in_plane_modulus(*m), m->nu, m->rho);
  plane.G = m->G * Eigen::Matrix2d::Identity();
  const double c = m->E / ((1 + m->nu) * (1 - 2 * m->nu));
  plane.Q(0, 0) = plane.Q(1, 1) = c * (1 - m->nu);
  plane.Q(0, 1) = plane.Q(1, 0) = c * m->nu;
  plane.alpha.head<2>().setConstant((1 + m->nu) * m->alpha);
  plane.tref = m->tref;
  plane.ge = m->ge;
  return plane;
}

std::optional<ShellSection> ShellSections::make_pshell(const records::Pshell& p, const std::string& who,
                                                       const records::CardLocation& at,
                                                       std::optional<double> thickness) {
  const std::string name = "PSHELL " + std::to_string(p.id);
  const std::optional<double> given = thickness ? thickness : p.t;
  if (!given || !(*given > 0)) {
    maker_.error("fe.bad-property", given ? p.at : at,
                 who + " has no positive thickness: neither the element nor " + name + " gives one",
                 "set T on the PSHELL or T1.. on the element");
    return std::nullopt;
  }
  const double t = *given;
  ShellSection s;
  bool ok = true;
  auto material = [&](int mid) {
    auto m = find_material(mid, name, p.at);
    ok = ok && m.has_value();
    return m.value_or(PlaneMaterial{});
  };
  double rho = 0;
  PlaneMaterial membrane, bending;
  if (p.mid1 > 0) {
    const auto m = p.mid2 == -1 ? find_plane_strain(p) : find_material(p.mid1, name, p.at);
    ok = m.has_value();
    if (m) s.A = t * m->Q, rho = m->rho, membrane = *m;
  }
  if (p.mid2 > 0) {
    const auto m = bending = material(p.mid2);
    s.D = p.bending_ratio * t * t * t / 12 * m.Q;
    if (p.mid1 <= 0) rho = m.rho;
  }
  if (p.mid4 > 0) s.B = -t * t * material(p.mid4).Q;  // Nastran's curvature has the other sign
  s.shear_flexible = p.mid3 > 0 && p.mid2 > 0 && p.shear_ratio > 0;
  if (s.shear_flexible) s.S = p.shear_ratio * t * material(p.mid3).G;
  // A material without transverse shear moduli leaves the plate rigid in shear, as a blank MID3 does.
  s.shear_flexible = s.shear_flexible && s.S.determinant() > 0 && s.S(0, 0) > 0;
  s.mass = rho * t + p.nsm;
  s.ge = p.mid1 > 0 ? membrane.ge : bending.ge;
  s.rotary_inertia = rho * t * t * t / 12;
  if (!ok) return std::nullopt;
  set_expansion(membrane, bending, s);
  auto stress = std::make_shared<ShellStress>();
  if (p.mid1 > 0) stress->t = t;
  if (p.mid2 > 0) stress->inertia = p.bending_ratio * t * t * t / 12;
  stress->z1 = p.z1.value_or(-0.5 * t);
  stress->z2 = p.z2.value_or(0.5 * t);
  s.stress = std::move(stress);
  return s;
}

void ShellSections::set_expansion(const PlaneMaterial& membrane, const PlaneMaterial& bending,
                                  ShellSection& section) const {
  if (!has_temperatures_ || (membrane.alpha.isZero(0) && bending.alpha.isZero(0))) return;
  auto e = std::make_shared<ShellExpansion>();
  e->N_t = section.A * membrane.alpha;
  e->M_t = section.B.transpose() * membrane.alpha;
  e->N_g = section.B * bending.alpha;
  e->M_g = section.D * bending.alpha;
  e->e_tt = membrane.alpha.dot(e->N_t);
  e->e_tg = membrane.alpha.dot(e->N_g);
  e->e_gg = bending.alpha.dot(e->M_g);
  e->tref = membrane.tref;
  section.expansion = std::move(e);
}

/// LAM = SMEAR is the PSHELL of which MID1 = MID2, without MID3 and MID4: no coupling and so no Z0, no transverse
/// shear.
void ShellSections::stack_smeared(const records::Pcomp& p, std::vector<LaminateLayer>& layers, double& z0) {
  if (p.layup == records::Layup::Smeared) {
    layers = {smear(layers)};
    layers[0].material.shear_rigid = true;
    const double centred = -0.5 * layers[0].thickness;
    if (std::abs(z0 - centred) > 1e-9 * layers[0].thickness)
      maker_.diagnostics().warning("fe.smeared-offset", maker_.deck().locate(p.at),
                                   "PCOMP " + std::to_string(p.id) +
                                       " is smeared, which has no coupling of membrane and bending: its Z0 is not used",
                                   "give ZOFFS on the elements");
    z0 = centred;
  } else if (p.layup == records::Layup::SmearedCore) {
    const LaminateLayer core = layers.back();
    layers.pop_back();
    LaminateLayer face = smear(layers);
    face.thickness *= 0.5;
    layers = {face, core, face};
  }
}

/// Sets stress output: for LAM = SMEAR that of a PSHELL, for SMCORE that of its three layers, which have no separate
/// limits.
void ShellSections::set_stress(const records::Pcomp& p, const std::vector<LaminateLayer>& layers, double z0,
                               ShellSection& section) const {
  static const std::map<std::string, FailureTheory> theories{{"HILL", FailureTheory::Hill},
                                                             {"HOFF", FailureTheory::Hoffman},
                                                             {"TSAI", FailureTheory::TsaiWu},
                                                             {"STRN", FailureTheory::Strain}};
  auto stress = std::make_shared<ShellStress>();
  double thickness = 0;
  for (const auto& layer : layers) thickness += layer.thickness;
  if (p.layup == records::Layup::Smeared) {
    stress->t = thickness;
    stress->inertia = thickness * thickness * thickness / 12;
    stress->z1 = -0.5 * thickness;
    stress->z2 = 0.5 * thickness;
    section.stress = std::move(stress);
    return;
  }
  double z = z0;
  const auto theory = theories.find(p.failure);
  std::set<int> weak;  // materials without strengths that have been told
  const auto shear = calc_interlaminar_shear(layers);
  stress->has_shear = p.bending;
  stress->bond = p.layup == records::Layup::Stacked ? p.sb : 0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    auto& layer = stress->layers.emplace_back();
    layer.z = z + 0.5 * layers[k].thickness;
    z += layers[k].thickness;
    layer.shear = shear[k].asDiagonal();
    const bool is_ply = p.layup == records::Layup::Stacked;
    layer.angle = is_ply ? p.plies[k].theta_deg * kDegree : 0;
    const PlaneMaterial own = rotate_material(layers[k].material, -layer.angle);
    layer.Q = own.Q;
    layer.alpha = own.alpha;
    if (!is_ply || theory == theories.end()) continue;
    layer.theory = theory->second;
    if (const auto* m = mat8_.find(p.plies[k].mid)) {
      layer.strength = m->strength;
    } else if (const auto* i = mat1_.find(p.plies[k].mid)) {
      layer.strength.Xt = layer.strength.Yt = i->st;
      layer.strength.Xc = layer.strength.Yc = std::abs(i->sc);
      layer.strength.S = i->ss;
    }
    const auto& own_strength = layer.strength;
    if (own_strength.Xt > 0 && own_strength.Yt > 0 && own_strength.S > 0) continue;
    if (weak.insert(p.plies[k].mid).second)
      maker_.diagnostics().note("fe.no-strength", maker_.deck().locate(p.at),
                                "PCOMP " + std::to_string(p.id) + " asks for " + p.failure + ", and material " +
                                    std::to_string(p.plies[k].mid) +
                                    " lacks a strength (Xt, Yt or S): its plies have the failure index 0",
                                "give all three");
  }
  section.stress = std::move(stress);
}

std::optional<ShellSection> ShellSections::make_pcomp(const records::Pcomp& p) {
  const std::string name = "PCOMP " + std::to_string(p.id);
  std::vector<LaminateLayer> layers;
  bool ok = !p.plies.empty();
  for (const auto& ply : p.plies) {
    const auto m = find_material(ply.mid, name, p.at);
    ok = ok && m && ply.t > 0;
    if (!(ply.t > 0))
      maker_.error("fe.bad-property", p.at, name + " has a ply of thickness " + show_number(ply.t),
                   "thicknesses are positive");
    if (m) layers.push_back({rotate_material(*m, ply.theta_deg * kDegree), ply.t});
  }
  if (!ok) return std::nullopt;
  double z0 = p.z0;
  stack_smeared(p, layers, z0);
  ShellSection s = make_laminate_section(layers, z0);
  set_stress(p, layers, z0, s);
  s.mass += p.nsm;
  s.ge = p.ge;
  auto expansion = make_laminate_expansion(layers, z0);
  expansion.tref = p.tref;
  if (has_temperatures_ && has_initial_ && p.tref == 0 && expansion.e_tt > 0)
    maker_.diagnostics().warning("fe.laminate-tref", maker_.deck().locate(p.at),
                                 name + " expands from its own TREF, zero, and not from TEMPERATURE(INITIAL)",
                                 "give TREF on the laminate");
  if (!p.bending || !p.membrane) {
    expansion.M_t.setZero();
    expansion.N_g.setZero();
    expansion.e_tg = 0;
    (p.bending ? expansion.N_t : expansion.M_g).setZero();
    (p.bending ? expansion.e_tt : expansion.e_gg) = 0;
  }
  if (has_temperatures_ && expansion.e_tt + expansion.e_gg > 0)
    s.expansion = std::make_shared<ShellExpansion>(expansion);
  if (!p.bending) {
    s.D.setZero();
    s.B.setZero();
    s.shear_flexible = false;
  }
  if (!p.membrane) {
    s.A.setZero();
    s.B.setZero();
  }
  return s;
}

}  // namespace bough::fe
