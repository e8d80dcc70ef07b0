#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "fe/cards/shell_card.hpp"
#include "fe/elements/curved_shell.hpp"
#include "fe/shape/surface_shape.hpp"
#include "formats/records/params.hpp"

namespace bough::fe {
namespace {

struct ReadyShell {
  ResolvedShell card;
  std::vector<int> nodes;  // those present
  CurvedShellGeometry geometry;
};

/// Normals of the element's own surface at its nodes, x,r × x,s; the mean plane's where that vanishes.
void calc_own_normals(CurvedShellGeometry& g, const Vector3d& mean) {
  const std::size_t n = g.is_present.size();
  for (std::size_t k = 0; k < n; ++k)
    if (!g.is_present[k]) g.x[n + k] = 0.5 * (g.x[k] + g.x[(k + 1) % n]);
  const ShellTying& tying = get_shell_tying(static_cast<int>(n));
  for (int i = 0; i < tying.num_nodes; ++i) {
    const auto shapes = calc_surface_shapes(tying.num_corners, std::vector<char>(n, 1), tying.node_natural(i, 0),
                                            tying.node_natural(i, 1));
    Eigen::Matrix<double, 3, 2> x = Eigen::Matrix<double, 3, 2>::Zero();
    for (int j = 0; j < tying.num_nodes; ++j) x += g.x[static_cast<std::size_t>(j)] * shapes.dall.col(j).transpose();
    const Vector3d normal = Vector3d(x.col(0)).cross(Vector3d(x.col(1)));
    g.normal.push_back(normal.norm() > 0 ? normal.normalized() : mean);
  }
}

std::optional<ReadyShell> prepare(Maker& maker, ShellSections& sections, const records::ShellElement& card) {
  auto resolved = resolve_shell(maker, sections, card);
  if (!resolved) return std::nullopt;
  ReadyShell r{std::move(*resolved), {}, {}};
  r.nodes = r.card.nodes;
  r.geometry.x = r.card.x;
  r.geometry.z_offset = card.z_offset;
  for (int k : r.card.midsides) {
    r.geometry.is_present.push_back(k >= 0);
    r.geometry.x.push_back(k >= 0 ? maker.nodes().node(k).x : Vector3d(Vector3d::Zero()));
    if (k >= 0) r.nodes.push_back(k);
  }
  calc_own_normals(r.geometry, r.card.normal);
  for (const auto& frame : CurvedShell::calc_frames(r.geometry))
    if (!(frame.area > 0 && frame.R.col(2).dot(r.card.normal) > 0)) {
      maker.error("fe.bad-facet", card.at, r.card.who + " folds over itself between its corners and midside grids",
                  "put each midside grid near the middle of its side, in the order of the corners");
      return std::nullopt;
    }
  return r;
}

/// Normals at the nodes become the mean of all curved shells' where they agree within PARAM,SNORM degrees.
void unite_normals(Maker& maker, std::vector<ReadyShell>& shells) {
  const double limit = records::get_real_param(maker.deck(), "SNORM", 20, maker.diagnostics());
  if (!(limit > 0)) return;
  std::unordered_map<int, Vector3d> sum;
  std::set<int> broken;
  const auto for_each = [&](auto&& act) {
    for (auto& shell : shells) {
      std::size_t at = 0;
      const std::size_t corners = shell.geometry.is_present.size();
      for (std::size_t i = 0; i < 2 * corners; ++i)
        if (i < corners || shell.geometry.is_present[i - corners]) act(shell.nodes[at++], shell.geometry.normal[i]);
    }
  };
  for_each([&](int node, const Vector3d& normal) {
    Vector3d& total = sum.try_emplace(node, Vector3d::Zero()).first->second;
    total += total.dot(normal) < 0 ? Vector3d(-normal) : normal;
  });
  const double min_cosine = std::cos(limit * std::numbers::pi / 180);
  for_each([&](int node, const Vector3d& normal) {
    if (std::abs(sum[node].normalized().dot(normal)) < min_cosine) broken.insert(node);
  });
  for_each([&](int node, Vector3d& normal) {
    if (broken.count(node) > 0) return;
    const Vector3d mean = sum[node].normalized();
    normal = mean.dot(normal) < 0 ? Vector3d(-mean) : mean;
  });
}

/// The element's section, or one per point where the corners' thicknesses differ.
std::vector<ShellSection> find_sections(ShellSections& sections, const ResolvedShell& shell,
                                        const std::vector<SurfaceFrame>& frames) {
  const auto& card = *shell.card;
  if (shell.thickness.empty()) return {*shell.section};
  const Eigen::Map<const VectorXd> t(shell.thickness.data(), static_cast<Eigen::Index>(shell.thickness.size()));
  std::vector<ShellSection> result;
  for (const auto& frame : frames) {
    const auto* section = sections.find(card.pid, shell.who, card.at, frame.corner.dot(t));
    result.push_back(section ? *section : *shell.section);
  }
  return result;
}

}  // namespace

void make_curved_shells(Maker& maker) {
  ShellSections sections(maker);
  std::vector<ReadyShell> shells;
  for (const auto& card : maker.deck().shells)
    if (!card.midsides.empty())
      if (auto shell = prepare(maker, sections, card)) shells.push_back(std::move(*shell));
  unite_normals(maker, shells);
  for (auto& shell : shells) {
    const auto frames = CurvedShell::calc_frames(shell.geometry);
    std::vector<double> angle;
    for (const auto& frame : frames) {
      // THETA counts from the line of constant η.
      const Vector3d along = std::cos(frame.along_r) * frame.R.col(0) + std::sin(frame.along_r) * frame.R.col(1);
      const auto own = calc_material_angle(maker, shell.card, frame.x, frame.R.col(2), along);
      if (!own) break;
      angle.push_back(frame.along_r + *own);
    }
    if (angle.size() < frames.size()) continue;
    auto own = find_sections(sections, shell.card, frames);
    const auto gdofs = maker.list_gdofs(shell.nodes);
    maker.add(std::make_unique<CurvedShell>(shell.card.card->id, shell.card.card->card, std::move(shell.nodes), gdofs,
                                            std::move(shell.geometry), std::move(own), std::move(angle)),
              shell.card.section->ge);
  }
}

}  // namespace bough::fe
