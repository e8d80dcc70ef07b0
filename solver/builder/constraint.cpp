// [[constraint]] to Loops.
#include <algorithm>
#include <cmath>
#include <map>

#include "solver/builder/build.hpp"
#include "solver/builder/special_node.hpp"
#include "solver/text/names.hpp"
#include "solver/tree/body_sizes.hpp"

namespace bough::solver {

namespace {

using records::ConstraintRecord;
using records::ConstraintType;

records::HingeRecord make_hinge_record(const ConstraintRecord& r) {
  return {.name = r.name,
          .type = r.hinge,
          .axis = r.axis,
          .axis2 = r.axis2,
          .pitch = r.pitch,
          .rotations = r.rotations,
          .translations = r.translations,
          .at = r.at};
}

std::unique_ptr<const Closure> build_closure(const ConstraintRecord& r, Diagnostics& diagnostics) {
  if (r.type == ConstraintType::Hinge) {
    Diagnostics own;
    auto hinge = make_hinge(make_hinge_record(r), own);
    for (Diagnostic item : own.items()) {
      if (item.what.starts_with("hinge ")) item.what.replace(0, 5, "constraint");
      diagnostics.add(std::move(item));
    }
    if (!hinge) return nullptr;
    if (hinge->num_u() == 6) {
      diagnostics.error("system.bad-constraint", r.at, "constraint " + quote(r.name) + " leaves all six motions free",
                        "name a type that holds something");
      return nullptr;
    }
    return make_hinge_closure(std::move(hinge));
  }
  if (r.type == ConstraintType::Distance) {
    if (r.length > 0 && std::isfinite(r.length)) return make_distance_closure(r.length);
    diagnostics.error("system.bad-constraint", r.at, "constraint " + quote(r.name) + " keeps no distance",
                      "give length > 0; a spherical constraint keeps two points together");
    return nullptr;
  }
  if (!(r.axis.allFinite() && r.axis.norm() > 0)) {
    diagnostics.error("system.zero-axis", r.at, "constraint " + quote(r.name) + " has no direction in axis");
    return nullptr;
  }
  const Vector3d axis = r.axis.normalized();
  if (r.type == ConstraintType::KnifeEdge) return make_knife_edge_closure(axis);
  if (r.type == ConstraintType::Rolling) {
    if (!(r.axis2.allFinite() && r.axis2.norm() > 0)) {
      diagnostics.error("system.zero-axis", r.at, "constraint " + quote(r.name) + " has no direction in axis2");
      return nullptr;
    }
    if (std::isfinite(r.radius + r.crown) && r.radius >= 0 && r.crown >= 0 && r.radius + r.crown > 0)
      return make_rolling_closure(axis, r.axis2.normalized(), r.radius, r.crown);
    diagnostics.error("system.bad-constraint", r.at, "constraint " + quote(r.name) + " rolls on no radius",
                      "give radius > 0 for a disc, crown > 0 for a sphere, both for a tyre");
    return nullptr;
  }
  return r.type == ConstraintType::PointOnLine ? make_line_closure(axis) : make_plane_closure(axis);
}

class Builder {
 public:
  Builder(const records::SystemSpec& spec, const TreeOrder& order, System& system, Diagnostics& diagnostics)
      : spec_(spec), order_(order), system_(system), diagnostics_(diagnostics) {}

  void build(const ConstraintRecord& r) {
    const int errors = diagnostics_.num_errors();
    Constraint c;
    c.name = r.name;
    c.at = r.at;
    c.active = r.active;
    if (r.type == ConstraintType::Coupler || r.type == ConstraintType::RateCoupler) {
      build_coupler(r, c);
    } else {
      for (const Matrix3d* R : {&r.parent_rotation, &r.child_rotation}) {
        if ((*R * R->transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 && R->determinant() > 0) continue;
        diagnostics_.error("system.bad-rotation", r.at,
                           "constraint " + quote(r.name) + ": the rotation of its frame on the " +
                               (R == &r.parent_rotation ? "parent" : "child") + " is not a proper rotation matrix");
      }
      c.closure = build_closure(r, diagnostics_);
      const auto parent = build_end(r, r.parent, r.parent_node, r.parent_position, r.parent_rotation);
      const auto child = build_end(r, r.child, r.child_node, r.child_position, r.child_rotation);
      if (parent && child && parent->body == child->body) {
        diagnostics_.error("system.bad-constraint", r.at,
                           "constraint " + quote(r.name) + " has body " + quote(r.child) + " on both sides",
                           "name two bodies, or ground and a body");
      }
      if (!c.closure || !parent || !child || diagnostics_.num_errors() != errors) return;
      c.parent_marker = system_.tree.add_marker(*parent);
      c.child_marker = system_.tree.add_marker(*child);
    }
    if (diagnostics_.num_errors() == errors) system_.loops.constraints.push_back(std::move(c));
  }

 private:
  std::optional<Marker> build_end(const ConstraintRecord& r, const std::string& name, int node, const Vector3d& p,
                                  const Matrix3d& R) {
    Marker m;
    m.p_KM = p;
    m.R_KM = R;
    const std::string user = "constraint " + quote(r.name);
    if (name == "ground") {
      if (node == 0) return m;
      diagnostics_.error("system.unknown-node", r.at,
                         user + " names node " + std::to_string(node) + " of ground, which has only node 0",
                         "give parent_position instead");
      return std::nullopt;
    }
    const auto found = order_.tree_index.find(name);
    if (found == order_.tree_index.end()) {
      std::vector<std::string> names;
      for (const auto& body : spec_.bodies) names.push_back(body.name);
      if (std::find(names.begin(), names.end(), name) != names.end()) return std::nullopt;  // in a loop of hinges
      diagnostics_.error("system.unknown-body", r.at, user + " names body " + quote(name) + ", which does not exist",
                         suggest_name(name, names, "declare it"));
      return std::nullopt;
    }
    m.body = found->second;
    if (!system_.body_is_valid[static_cast<size_t>(m.body)]) return std::nullopt;
    const Body& body = system_.tree[m.body].body;
    const bool is_ball = r.type != ConstraintType::Rolling &&
                         (r.type != ConstraintType::Hinge || r.hinge == records::HingeType::Spherical);
    // The frame of what acts along a line lies at the child's point: the parent's node feels a moment.
    const bool is_point = is_ball && p.isZero(0) &&
                          (r.type == ConstraintType::Hinge || r.type == ConstraintType::Distance || name == r.child);
    m.node = find_loaded_node(name, body, node, {true, !is_point}, r.at, user, diagnostics_);
    m.node = reject_special_node(name, body, m.node, r.at, user, diagnostics_);
    if (m.node < 0) return std::nullopt;
    m.moves = body.nodes()[static_cast<size_t>(m.node)].moves;
    return m;
  }

  void build_coupler(const ConstraintRecord& r, Constraint& c) {
    c.offset = r.offset;
    c.is_rate = r.type == ConstraintType::RateCoupler;
    const std::string user = "constraint " + quote(r.name);
    if (r.terms.empty()) diagnostics_.error("system.bad-constraint", r.at, user + " couples nothing", "give its terms");
    std::vector<std::string> names;
    for (const TreeBody& tb : system_.tree.bodies) names.push_back(tb.hinge_name);
    for (const auto& term : r.terms) {
      const auto at = std::find(names.begin(), names.end(), term.hinge);
      if (at == names.end()) {
        diagnostics_.error("system.unknown-hinge", r.at,
                           user + " names hinge " + quote(term.hinge) + ", which does not exist",
                           suggest_name(term.hinge, names, "declare it"));
        continue;
      }
      const TreeBody& tb = system_.tree[static_cast<int>(at - names.begin())];
      if (!tb.hinge->has_independent_coordinates() && !c.is_rate) {
        diagnostics_.error(
            "system.bad-constraint", r.at,
            user + " couples an orientation of hinge " + quote(term.hinge) + ", which is no plain coordinate",
            "couple hinges whose coordinates are angles or travels");
      } else if (term.coordinate < 1 || term.coordinate > tb.hinge->num_u()) {
        diagnostics_.error("system.bad-constraint", r.at,
                           user + " names coordinate " + std::to_string(term.coordinate) + " of hinge " +
                               quote(term.hinge) + ", which has " + std::to_string(tb.hinge->num_u()));
      } else if (!std::isfinite(term.ratio) || term.ratio == 0) {
        diagnostics_.error("system.bad-constraint", r.at,
                           user + " couples hinge " + quote(term.hinge) + " with a ratio that is zero or no number");
      } else {
        c.terms.push_back(
            {c.is_rate ? 0 : tb.q_offset + term.coordinate - 1, tb.u_offset + term.coordinate - 1, term.ratio});
      }
    }
    std::map<int, std::pair<double, double>> sums;  // by row of u: of the ratios, and of their sizes
    for (const CouplerTerm& term : c.terms) {
      sums[term.u_row].first += term.ratio;
      sums[term.u_row].second += std::abs(term.ratio);
    }
    const auto cancels = [](const auto& sum) { return std::abs(sum.second.first) <= 1e-12 * sum.second.second; };
    if (!sums.empty() && std::all_of(sums.begin(), sums.end(), cancels))
      diagnostics_.error("system.bad-constraint", r.at,
                         user + " couples nothing: the ratios of its terms cancel in every coordinate",
                         "give each coordinate one term, with a ratio other than zero");
  }

  const records::SystemSpec& spec_;
  const TreeOrder& order_;
  System& system_;
  Diagnostics& diagnostics_;
};

/// Largest distance of a marker or node from the origin of its body, or of a hinge at the start from its parent frame:
/// positions have the roundoff of that.
double calc_marker_reach(const Tree& tree) {
  double reach = 0;
  for (const Marker& m : tree.markers) reach = std::max(reach, m.p_KM.norm());
  for (const TreeBody& tb : tree.bodies) {
    reach = std::max(reach, tb.initial_q.norm());
    for (const Node& node : tb.body.nodes()) reach = std::max(reach, node.p.norm());
  }
  return reach;
}

}  // namespace

void build_constraints(const records::SystemSpec& spec, const TreeOrder& order, System& system,
                       Diagnostics& diagnostics) {
  Builder builder(spec, order, system, diagnostics);
  for (const auto& record : spec.constraints) builder.build(record);
  // The relative tolerance of gaps, 1e-12, becomes 1e-15 of the reach.
  constexpr double kRoundoffShare = 1e-3;
  const VectorXd sizes = calc_body_sizes(system.tree);
  const double size = sizes.size() > 0 ? sizes.maxCoeff() : 1;
  system.loops.length = std::max(size, kRoundoffShare * calc_marker_reach(system.tree));
  finish_loops(system.tree, system.loops);
}

}  // namespace bough::solver
