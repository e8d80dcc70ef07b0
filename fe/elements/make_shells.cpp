#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "bough/fe/elements/maker.hpp"
#include "bough/fe/elements/shell.hpp"
#include "bough/fe/materials/laminate.hpp"

namespace bough::fe {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// PSHELL and PCOMP of the deck as sections per thickness and material angle.
class SectionMaker {
 public:
  explicit SectionMaker(Maker& maker)
      : maker_(maker),
        pshell_(maker.deck().pshell),
        pcomp_(maker.deck().pcomp),
        mat1_(maker.deck().mat1),
        mat2_(maker.deck().mat2),
        mat8_(maker.deck().mat8) {
    const auto* k6rot = maker.deck().find_param("K6ROT");
    drilling_factor_ = 1e-6 * (k6rot ? std::atof(k6rot->value.c_str()) : 100.0);
  }

  /// The section in material axes, or nullptr after reporting. thickness: mean of the element's corners, if given.
  const ShellSection* find(const records::ShellElement& card, const std::string& who, std::optional<double> thickness) {
    const auto key = std::make_pair(card.pid, thickness.value_or(-1));
    if (const auto it = made_.find(key); it != made_.end()) return it->second ? &*it->second : nullptr;
    auto& slot = made_[key];
    if (const auto* p = pshell_.find(card.pid)) {
      slot = make_pshell(*p, who, card.at, thickness);
    } else if (const auto* c = pcomp_.find(card.pid)) {
      slot = make_pcomp(*c);
    } else {
      maker_.report_missing_property(card.pid, "PSHELL, PCOMP or PCOMPG", who, card.at);
    }
    if (slot) slot->drilling = drilling_factor_ * slot->A(2, 2);
    return slot ? &*slot : nullptr;
  }

  std::optional<double> find_thickness(int pid) const {
    const auto* p = pshell_.find(pid);
    return p ? p->t : std::nullopt;
  }

 private:
  /// The material as a plate sees it, made once; empty after reporting.
  std::optional<PlaneMaterial> find_material(int mid, const std::string& who, const records::CardLocation& at) {
    const auto [slot, is_new] = materials_.try_emplace(mid);
    if (is_new) slot->second = make_material(mid, who, at);
    return slot->second;
  }

  std::optional<PlaneMaterial> make_material(int mid, const std::string& who, const records::CardLocation& at) {
    if (const auto* m = mat8_.find(mid)) {
      if (!(m->E1 > 0 && m->E2 > 0 && m->G12 > 0 && m->nu12 * m->nu12 * m->E2 < m->E1)) {
        maker_.error("fe.bad-material", m->at, "MAT8 " + std::to_string(mid) + " is not positive definite",
                     "E1, E2, G12 are positive and NU12² E2 < E1");
        return std::nullopt;
      }
      return make_orthotropic_plane(m->E1, m->E2, m->nu12, m->G12, m->G1z, m->G2z, m->rho);
    }
    if (const auto* m = mat2_.find(mid)) {
      PlaneMaterial p;
      p.Q = m->G;
      p.G << m->G(0, 0), m->G(0, 1), m->G(0, 1), m->G(1, 1);  // a MAT2 named by MID3 gives G11 G12 G22 of the shear law
      p.rho = m->rho;
      p.shear_rigid = true;  // and none when it stands for a ply
      return p;
    }
    if (!mat1_.find(mid)) {
      maker_.error(
          "fe.missing-material", at,
          who + " refers to material " + std::to_string(mid) + ", but the deck has no MAT1, MAT2 or MAT8 with that id",
          "add the material or correct the id");
      return std::nullopt;
    }
    const records::Mat1* m = maker_.find_material(mid, who, at);
    if (!m) return std::nullopt;
    return make_isotropic_plane(m->E, m->G, m->nu, m->rho);
  }

  std::optional<ShellSection> make_pshell(const records::Pshell& p, const std::string& who,
                                          const records::CardLocation& at, std::optional<double> thickness) {
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
    if (p.mid1 > 0) {
      const auto m = material(p.mid1);
      s.A = t * m.Q;
      rho = m.rho;
    }
    const int bending = p.mid2 == -1 ? p.mid1 : p.mid2;
    if (bending > 0) {
      const auto m = material(bending);
      s.D = p.bending_ratio * t * t * t / 12 * m.Q;
      if (p.mid1 <= 0) rho = m.rho;
    }
    if (p.mid4 > 0) s.B = -t * t * material(p.mid4).Q;  // Nastran's curvature has the other sign
    s.shear_flexible = p.mid3 > 0 && bending > 0 && p.shear_ratio > 0;
    if (s.shear_flexible) s.S = p.shear_ratio * t * material(p.mid3).G;
    // A material without transverse shear moduli leaves the plate rigid in shear, as a blank MID3 does.
    s.shear_flexible = s.shear_flexible && s.S.determinant() > 0 && s.S(0, 0) > 0;
    s.mass = rho * t + p.nsm;
    s.rotary_inertia = rho * t * t * t / 12;
    if (!ok) return std::nullopt;
    return s;
  }

  std::optional<ShellSection> make_pcomp(const records::Pcomp& p) {
    const std::string name = "PCOMP " + std::to_string(p.id);
    std::vector<LaminateLayer> layers;
    bool ok = !p.plies.empty();
    for (const auto& ply : p.plies) {
      const auto m = find_material(ply.mid, name, p.at);
      ok = ok && m && ply.t > 0;
      if (!(ply.t > 0))
        maker_.error("fe.bad-property", p.at, name + " has a ply of thickness " + show(ply.t),
                     "thicknesses are positive");
      if (m) layers.push_back({rotate_material(*m, ply.theta_deg * kDegree), ply.t});
    }
    if (!ok) return std::nullopt;
    ShellSection s = make_laminate_section(layers, p.z0);
    s.mass += p.nsm;
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

  Maker& maker_;
  Index<records::Pshell> pshell_;
  Index<records::Pcomp> pcomp_;
  Index<records::Mat1> mat1_;
  Index<records::Mat2> mat2_;
  Index<records::Mat8> mat8_;
  double drilling_factor_ = 1e-4;
  std::map<int, std::optional<PlaneMaterial>> materials_;
  std::map<std::pair<int, double>, std::optional<ShellSection>> made_;
};

Vector3d calc_normal(const std::vector<Vector3d>& x) {
  return x.size() == 4 ? (x[2] - x[0]).cross(x[3] - x[1]) : (x[1] - x[0]).cross(x[2] - x[0]);
}

/// Empty when the corners make a proper convex facet, else what is wrong.
std::string check_facet(const std::vector<Vector3d>& x) {
  const Vector3d normal = calc_normal(x);
  const double scale = (x[2] - x[0]).squaredNorm();
  if (!(normal.norm() > 1e-10 * scale)) return "has no area";
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d a = x[(i + 1) % n] - x[i], b = x[(i + n - 1) % n] - x[i];
    if (!(a.cross(b).dot(normal) > 0))
      return "has an interior angle of 180 degrees or more at corner " + std::to_string(i + 1);
  }
  return {};
}

double calc_material_angle(Maker& maker, const records::ShellElement& card, const std::vector<Vector3d>& x) {
  if (!card.mcid) return card.theta_deg * kDegree;
  Vector3d centre = Vector3d::Zero();
  for (const auto& p : x) centre += p / static_cast<double>(x.size());
  const Vector3d normal = calc_normal(x).normalized();
  const Vector3d axis =
      maker.nodes().calc_axes(*card.mcid, centre, maker.deck().locate(card.at), maker.diagnostics()).col(0);
  const Vector3d side = x[1] - x[0];
  return std::atan2(normal.dot(side.cross(axis)), side.dot(axis) - side.dot(normal) * normal.dot(axis));
}

/// Normals of the surface at every node where all shells agree within PARAM,SNORM degrees (default 20): the sum of the
/// unit normals, each turned to the side of the first.
std::unordered_map<int, Vector3d> calc_surface_normals(const Maker& maker, const std::vector<std::vector<int>>& facets,
                                                       const std::vector<Vector3d>& normals) {
  const auto* param = maker.deck().find_param("SNORM");
  const double limit = param ? std::atof(param->value.c_str()) : 20.0;
  std::unordered_map<int, Vector3d> sum;
  std::set<int> broken;
  if (!(limit > 0)) return sum;
  for (std::size_t e = 0; e < facets.size(); ++e)
    for (int node : facets[e]) {
      Vector3d& total = sum.try_emplace(node, Vector3d::Zero()).first->second;
      total += total.dot(normals[e]) < 0 ? Vector3d(-normals[e]) : normals[e];
    }
  for (std::size_t e = 0; e < facets.size(); ++e)
    for (int node : facets[e])
      if (std::abs(sum[node].normalized().dot(normals[e])) < std::cos(limit * kDegree)) broken.insert(node);
  for (int node : broken) sum.erase(node);
  for (auto& [node, total] : sum) total.normalize();
  return sum;
}

}  // namespace

void make_shells(Maker& maker) {
  SectionMaker sections(maker);
  struct Ready {
    const records::ShellElement* card;
    std::vector<int> nodes;
    std::vector<Vector3d> x;
    const ShellSection* section;
  };
  std::vector<Ready> ready;
  std::vector<std::vector<int>> facets;
  std::vector<Vector3d> normals;
  for (const auto& card : maker.deck().shells) {
    const std::string who = card.card + " " + std::to_string(card.id);
    Ready r{&card, {}, {}, nullptr};
    for (int g : card.grids) r.nodes.push_back(maker.find_grid(g, who, card.at));
    std::optional<double> thickness;
    if (!card.t.empty()) {
      double mean = 0;
      for (double t : card.t) mean += t / static_cast<double>(card.t.size());
      thickness = card.relative_thickness ? mean * sections.find_thickness(card.pid).value_or(0) : mean;
    }
    r.section = sections.find(card, who, thickness);
    if (!r.section || std::any_of(r.nodes.begin(), r.nodes.end(), [](int n) { return n < 0; })) continue;
    for (int n : r.nodes) r.x.push_back(maker.nodes().node(n).x);
    if (const std::string wrong = check_facet(r.x); !wrong.empty()) {
      maker.error("fe.bad-facet", card.at, who + " " + wrong, "correct the corners or their order");
      continue;
    }
    facets.push_back(r.nodes);
    normals.push_back(calc_normal(r.x).normalized());
    ready.push_back(std::move(r));
  }
  const auto surface = calc_surface_normals(maker, facets, normals);
  for (std::size_t e = 0; e < ready.size(); ++e) {
    const Ready& r = ready[e];
    ShellGeometry geometry{r.x, r.card->z_offset, {}};
    for (int n : r.nodes) {
      const auto it = surface.find(n);
      const Vector3d normal = it == surface.end() ? normals[e] : it->second;
      geometry.normals.push_back(normal.dot(normals[e]) < 0 ? Vector3d(-normal) : normal);
    }
    maker.add(std::make_unique<Shell>(r.card->id, r.card->card, r.nodes, maker.list_gdofs(r.nodes), geometry,
                                      rotate_section(*r.section, calc_material_angle(maker, *r.card, r.x))));
  }
}

}  // namespace bough::fe
