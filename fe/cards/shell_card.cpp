#include "fe/cards/shell_card.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "formats/records/params.hpp"

namespace bough::fe {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Vector3d calc_normal(const std::vector<Vector3d>& x) {
  return x.size() == 4 ? (x[2] - x[0]).cross(x[3] - x[1]) : (x[1] - x[0]).cross(x[2] - x[0]);
}

/// Empty if the corners form a convex facet, otherwise the error.
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

}  // namespace

std::vector<double> list_thicknesses(const records::ShellElement& card, double of_property) {
  std::vector<double> thicknesses;
  for (const double t : card.t)
    thicknesses.push_back(std::isnan(t) ? of_property : card.relative_thickness ? t * of_property : t);
  return thicknesses;
}

std::optional<ResolvedShell> resolve_shell(Maker& maker, ShellSections& sections, const records::ShellElement& card) {
  ResolvedShell r;
  r.card = &card;
  r.who = card.card + " " + std::to_string(card.id);
  bool ok = true;
  for (int g : card.grids) {
    r.nodes.push_back(maker.find_grid(g, r.who, card.at));
    ok = ok && r.nodes.back() >= 0;
  }
  for (int g : card.midsides) {
    r.midsides.push_back(g == 0 ? -1 : maker.find_grid(g, r.who, card.at));
    ok = ok && (g == 0 || r.midsides.back() >= 0);
  }
  std::optional<double> mean;
  if (!card.t.empty()) {
    const auto known = sections.find_thickness(card.pid);
    const bool needs_own =
        card.relative_thickness || std::any_of(card.t.begin(), card.t.end(), [](double t) { return std::isnan(t); });
    if (needs_own && !known) {
      maker.error("fe.bad-property", card.at,
                  r.who + " gives a thickness at some corners only, and its property none for the others",
                  "give T of the property or the thickness of each corner");
      return std::nullopt;
    }
    r.thickness = list_thicknesses(card, known.value_or(0));
    mean = std::accumulate(r.thickness.begin(), r.thickness.end(), 0.0) / static_cast<double>(r.thickness.size());
    if (std::all_of(r.thickness.begin(), r.thickness.end(), [&](double t) { return t == r.thickness[0]; }))
      r.thickness.clear();
  }
  r.section = sections.find(card.pid, r.who, card.at, mean);
  if (!r.section || !ok) return std::nullopt;
  for (int n : r.nodes) r.x.push_back(maker.nodes().node(n).x);
  if (const std::string wrong = check_facet(r.x); !wrong.empty()) {
    maker.error("fe.bad-facet", card.at, r.who + " " + wrong, "correct the corners or their order");
    return std::nullopt;
  }
  r.normal = calc_normal(r.x).normalized();
  return r;
}

namespace {

/// Returns true if the section is equal in all directions of its plane: material axes do not matter.
bool is_isotropic(const ShellSection& section) {
  const auto differs = [](const auto& a, const auto& b) { return (a - b).norm() > 1e-10 * a.norm(); };
  const ShellSection turned = rotate_section(section, 0.5);
  if (differs(section.A, turned.A) || differs(section.B, turned.B) || differs(section.D, turned.D)) return false;
  if (section.shear_flexible && differs(section.S, turned.S)) return false;
  if (!section.expansion) return true;
  const ShellExpansion &e = *section.expansion, &f = *turned.expansion;
  return !differs(e.N_t, f.N_t) && !differs(e.M_t, f.M_t) && !differs(e.N_g, f.N_g) && !differs(e.M_g, f.M_g);
}

}  // namespace

std::optional<double> calc_material_angle(Maker& maker, const ResolvedShell& shell, const Vector3d& x,
                                          const Vector3d& normal, const Vector3d& side) {
  const auto& card = *shell.card;
  if (!card.mcid) return card.theta_deg * kDegree;
  const std::string field = shell.who + " has MCID " + std::to_string(*card.mcid) + ", ";
  Diagnostics found;  // reported here, with the field
  const Matrix3d axes = maker.nodes().calc_axes(*card.mcid, x, maker.deck().locate(card.at), found);
  Vector3d axis = axes.col(0);
  if (found.num_errors() > 0) {
    maker.error("fe.missing-coordinates", card.at, field + "a coordinate system that the deck does not define",
                "add the CORD card or correct the field");
    return std::nullopt;
  }
  if (normal.cross(axis).norm() < 1e-6) {
    if (is_isotropic(*shell.section)) return 0;
    // Curved shells ask at every point.
    const auto& messages = maker.diagnostics().items();
    const std::string what = field + "whose x-axis is normal to the element; its y-axis is taken in place of it";
    if (messages.empty() || messages.back().what != what)
      maker.diagnostics().warning("fe.bad-material-axes", maker.deck().locate(card.at), what,
                                  "name a system whose x-axis has a part in the element, or give THETA");
    axis = axes.col(1);
  }
  return std::atan2(normal.dot(side.cross(axis)), side.dot(axis) - side.dot(normal) * normal.dot(axis));
}

std::optional<double> calc_material_angle(Maker& maker, const ResolvedShell& shell) {
  Vector3d centre = Vector3d::Zero();
  for (const auto& p : shell.x) centre += p / static_cast<double>(shell.x.size());
  return calc_material_angle(maker, shell, centre, shell.normal, shell.x[1] - shell.x[0]);
}

std::unordered_map<int, Vector3d> calc_surface_normals(Maker& maker, const std::vector<ResolvedShell>& shells) {
  const double limit = records::get_real_param(maker.deck(), "SNORM", 20, maker.diagnostics());
  std::unordered_map<int, Vector3d> sum;
  std::set<int> broken;
  if (!(limit > 0)) return sum;
  for (const auto& shell : shells)
    for (int node : shell.nodes) {
      Vector3d& total = sum.try_emplace(node, Vector3d::Zero()).first->second;
      total += total.dot(shell.normal) < 0 ? Vector3d(-shell.normal) : shell.normal;
    }
  std::vector<std::pair<int, Vector3d>> shared;
  for (const auto& [g, n] : list_neighbor_normals(maker.deck())) {
    const auto found = sum.find(maker.nodes().find_node(g));
    if (found == sum.end()) continue;
    found->second += found->second.dot(n) < 0 ? Vector3d(-n) : n;
    shared.emplace_back(found->first, n);
  }
  const auto check = [&](int node, const Vector3d& normal) {
    if (std::abs(sum[node].normalized().dot(normal)) < std::cos(limit * kDegree)) broken.insert(node);
  };
  for (const auto& shell : shells)
    for (int node : shell.nodes) check(node, shell.normal);
  for (const auto& [node, normal] : shared) check(node, normal);
  for (int node : broken) sum.erase(node);
  for (auto& [node, total] : sum) total.normalize();
  return sum;
}

}  // namespace bough::fe
