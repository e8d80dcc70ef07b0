#include <optional>

#include "fe/cards/maker.hpp"
#include "fe/elements/bush.hpp"
#include "fe/elements/scalar.hpp"

namespace bough::fe {
namespace {

/// Where a scalar element acts: nodes, rows of the g-set and the direction b over them; false after reporting.
struct ScalarEnds {
  std::vector<int> nodes;
  std::vector<int> gdofs;
  VectorXd b;
};

/// \param is_whole  all six rows of each grid, and not only those in which b is not zero
std::optional<ScalarEnds> find_ends(Maker& maker, const std::string& who, std::array<int, 2> grids,
                                    std::array<int, 2> components, const records::CardLocation& at,
                                    bool is_whole = false) {
  ScalarEnds ends;
  std::vector<double> b;
  bool ok = true;
  for (int k = 0; k < 2; ++k) {
    if (grids[k] == 0) continue;
    const int index = maker.find_point(grids[k], who, at);
    if (index < 0) {
      ok = false;
      continue;
    }
    const Node& node = maker.nodes().node(index);
    const int c = components[k];
    if (node.num_dofs == 1 ? c > 1 || c < 0 : c < 1 || c > 6) {
      maker.error("fe.bad-component", at,
                  who + " has component " + std::to_string(c) + " at " +
                      (node.num_dofs == 1 ? "scalar point " : "grid ") + std::to_string(grids[k]) + ", expected " +
                      (node.num_dofs == 1 ? "0 or 1" : "1 to 6"),
                  "correct the component");
      ok = false;
      continue;
    }
    ends.nodes.push_back(index);
    const double sign = k == 0 ? 1 : -1;
    if (node.num_dofs == 1) {
      ends.gdofs.push_back(node.first_gdof);
      b.push_back(sign);
      continue;
    }
    const int first = c <= 3 ? 0 : 3;
    for (int i = is_whole ? 0 : first; i < (is_whole ? 6 : first + 3); ++i) {
      const bool is_along = i / 3 == first / 3;
      const double direction = is_along ? sign * node.R_basic_cd(i % 3, (c - 1) % 3) : 0;
      const int gdof = node.first_gdof + i;
      const auto it = std::find(ends.gdofs.begin(), ends.gdofs.end(), gdof);
      if (it != ends.gdofs.end()) {
        b[static_cast<std::size_t>(it - ends.gdofs.begin())] += direction;  // both ends on one grid
      } else if (direction != 0 || is_whole) {
        ends.gdofs.push_back(gdof);
        b.push_back(direction);
      }
    }
  }
  if (ok && ends.nodes.empty()) {
    maker.error("fe.missing-grid", at, who + " has no grid at either end", "give G1 or G2");
    ok = false;
  }
  if (!ok) return std::nullopt;
  if (ends.nodes.size() == 2 && ends.nodes[0] == ends.nodes[1]) ends.nodes.pop_back();
  ends.b = Eigen::Map<const VectorXd>(b.data(), static_cast<Eigen::Index>(b.size()));
  return ends;
}

std::string name_scalar(const char* family, int pid, bool by_scalar_points) {
  return family + std::to_string((pid > 0 ? 1 : 2) + (by_scalar_points ? 2 : 0));
}

struct BushAxes {
  Matrix3d R = Matrix3d::Identity();
  bool ok = true;
};

BushAxes calc_bush_axes(Maker& maker, const records::Cbush& card, const std::string& who, const Node& a, const Node* b,
                        const records::Pbush& property) {
  BushAxes axes;
  if (card.cid) {
    axes.R = maker.nodes().calc_axes(*card.cid, a.x, maker.deck().locate(card.at), maker.diagnostics());
    return axes;
  }
  const auto fail = [&](const std::string& what, const std::string& advice) {
    maker.error("fe.bad-orientation", card.at, who + what, advice);
    axes.ok = false;
    return axes;
  };
  const Vector3d along = b ? Vector3d(b->x - a.x) : Vector3d::Zero();
  if (along.isZero(0)) return fail(" is grounded or has coincident grids and gives no CID", "give CID");
  const Vector3d ex = along.normalized();
  Vector3d v = Vector3d::Zero();
  if (card.g0 > 0) {
    const int g0 = maker.find_grid(card.g0, who, card.at);
    if (g0 < 0) {
      axes.ok = false;
      return axes;
    }
    v = maker.nodes().node(g0).x - a.x;
  } else if (card.v) {
    v = a.R_basic_cd * *card.v;
  } else {
    // Only axial and torsional springs and dampers need no orientation.
    for (const int i : {1, 2, 4, 5})
      if (property.k[i] != 0 || property.b[i] != 0)
        return fail(" has stiffness or damping across its axis but no orientation",
                    "give an orientation vector, GO or CID");
    v = ex.unitOrthogonal();
  }
  Vector3d ez = ex.cross(v);
  if (!(ez.norm() > 1e-6 * v.norm()))
    return fail(" has its orientation vector along its axis", "give a vector that is not parallel to GA-GB");
  ez.normalize();
  axes.R << ex, ez.cross(ex), ez;
  return axes;
}

void make_bush(Maker& maker, const char* name, const records::Pbush* property, const records::Cbush& card) {
  const std::string who = std::string(name) + " " + std::to_string(card.id);
  const int a = maker.find_grid(card.ga, who, card.at);
  const int b = card.gb == 0 ? -1 : maker.find_grid(card.gb, who, card.at);
  if (!property || a < 0 || (card.gb != 0 && b < 0)) return;
  const Node& node_a = maker.nodes().node(a);
  const Node* node_b = b < 0 ? nullptr : &maker.nodes().node(b);
  const BushAxes axes = calc_bush_axes(maker, card, who, node_a, node_b, *property);
  if (!axes.ok) return;
  BushData data;
  data.R_basic_element = axes.R;
  data.k = property->k;
  data.b = property->b;
  data.ge = property->ge;
  data.mass = property->mass;
  Vector3d point = node_a.x;
  if (card.ocid >= 0) {
    point +=
        maker.nodes().calc_axes(card.ocid, node_a.x, maker.deck().locate(card.at), maker.diagnostics()) * card.s_offset;
  } else if (node_b) {
    point += card.s * (node_b->x - node_a.x);
  }
  data.arm_a = point - node_a.x;
  std::vector<int> nodes{a};
  if (node_b) {
    data.arm_b = point - node_b->x;
    nodes.push_back(b);
  }
  auto gdofs = maker.list_gdofs(nodes);
  maker.add(std::make_unique<Bush>(card.id, name, std::move(nodes), std::move(gdofs), data));
}

/// A gap of a linear analysis stays as it is at the start (Quick Reference Guide, CGAP): closed with KA along its axis
/// and KT across it, open with KB. Both act half-way between the grids, so that rigid-body motions stay free.
void make_gap(Maker& maker, const records::Pgap* property, const records::Cgap& card) {
  if (!property) maker.report_missing_property(card.pid, "PGAP", "CGAP " + std::to_string(card.id), card.at);
  records::Pbush springs;
  const bool is_closed = property && (property->u0 <= 0 || property->f0 > 0);
  if (property) springs.k[0] = is_closed ? property->ka : property->kb;
  if (is_closed) springs.k[1] = springs.k[2] = property->kt;
  records::Cbush bush;
  bush.id = card.id, bush.ga = card.ga, bush.gb = card.gb, bush.at = card.at, bush.cid = card.cid;
  bush.v = card.v, bush.g0 = card.g0;
  const int a = maker.nodes().find_node(card.ga), b = maker.nodes().find_node(card.gb);
  // Equal across the axis: without an orientation any is as good.
  if (!card.cid && !card.v && card.g0 == 0 && a >= 0 && b >= 0) {
    const Node& node_a = maker.nodes().node(a);
    const Vector3d along = maker.nodes().node(b).x - node_a.x;
    if (!along.isZero(0)) bush.v = node_a.R_basic_cd.transpose() * along.unitOrthogonal();
  }
  make_bush(maker, "CGAP", property ? &springs : nullptr, bush);
}

}  // namespace

void make_springs(Maker& maker) {
  const auto& deck = maker.deck();
  const RecordIndex<records::Pelas> pelas(deck.pelas);
  for (const records::ScalarSpring& card : deck.springs) {
    const std::string name = name_scalar("CELAS", card.pid, card.by_scalar_points),
                      who = name + " " + std::to_string(card.id);
    double k = card.k, ge = card.ge;
    bool ok = true;
    if (card.pid > 0) {
      const records::Pelas* property = pelas.find(card.pid);
      if (!property) maker.report_missing_property(card.pid, "PELAS", who, card.at);
      ok = property != nullptr;
      if (property) k = property->k, ge = property->ge;
    }
    auto ends = find_ends(maker, who, {card.g1, card.g2}, {card.c1, card.c2}, card.at);
    if (!ok || !ends) continue;
    maker.add(std::make_unique<ScalarSpring>(card.id, name, std::move(ends->nodes), std::move(ends->gdofs), k,
                                             std::move(ends->b)),
              ge);
  }
  const RecordIndex<records::Pmass> pmass(deck.pmass);
  for (const records::ScalarMass& card : deck.scalar_masses) {
    const std::string name = name_scalar("CMASS", card.pid, card.by_scalar_points),
                      who = name + " " + std::to_string(card.id);
    double m = card.m;
    bool ok = true;
    if (card.pid > 0) {
      const records::Pmass* property = pmass.find(card.pid);
      if (!property) maker.report_missing_property(card.pid, "PMASS", who, card.at);
      ok = property != nullptr;
      if (property) m = property->m;
    }
    const bool turns = (card.g1 != 0 && card.c1 > 3) || (card.g2 != 0 && card.c2 > 3);
    auto ends = find_ends(maker, who, {card.g1, card.g2}, {card.c1, card.c2}, card.at, turns);
    if (!ok || !ends) continue;
    maker.add(std::make_unique<ScalarMass>(card.id, name, std::move(ends->nodes), std::move(ends->gdofs), m,
                                           std::move(ends->b), turns));
  }
  const RecordIndex<records::Pdamp> pdamp(deck.pdamp);
  for (const records::ScalarDamper& card : deck.dampers) {
    const std::string name = name_scalar("CDAMP", card.pid, card.by_scalar_points),
                      who = name + " " + std::to_string(card.id);
    double b = card.b;
    bool ok = true;
    if (card.pid > 0) {
      const records::Pdamp* property = pdamp.find(card.pid);
      if (!property) maker.report_missing_property(card.pid, "PDAMP", who, card.at);
      ok = property != nullptr;
      if (property) b = property->b;
    }
    auto ends = find_ends(maker, who, {card.g1, card.g2}, {card.c1, card.c2}, card.at);
    if (!ok || !ends) continue;
    maker.add(std::make_unique<ScalarDamper>(card.id, name, std::move(ends->nodes), std::move(ends->gdofs), b,
                                             std::move(ends->b)));
  }
  const RecordIndex<records::Pbush> pbush(deck.pbush);
  for (const records::Cbush& card : deck.cbush) {
    const records::Pbush* property = pbush.find(card.pid);
    if (!property) maker.report_missing_property(card.pid, "PBUSH", "CBUSH " + std::to_string(card.id), card.at);
    make_bush(maker, "CBUSH", property, card);
  }
  const RecordIndex<records::Pgap> pgap(deck.special.pgap);
  for (const records::Cgap& card : deck.special.cgap) make_gap(maker, pgap.find(card.pid), card);
}

}  // namespace bough::fe
