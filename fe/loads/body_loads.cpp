#include <algorithm>
#include <cmath>

#include "fe/loads/inertial_loads.hpp"
#include "fe/loads/load_sets.hpp"
#include "fe/matrices/assembly.hpp"

namespace bough::fe {
namespace {

double interpolate(const std::vector<std::pair<double, double>>& table, double x) {
  const auto after = std::find_if(table.begin(), table.end(), [x](const auto& point) { return point.first > x; });
  if (after == table.begin()) return after->second;
  if (after == table.end()) return table.back().second;
  const auto& [x0, y0] = *(after - 1);
  return y0 + (x - x0) / (after->first - x0) * (after->second - y0);
}

/// Centrifugal force outward and force along an angular acceleration: that of a frame with -RACC (Nastran Quick
/// Reference Guide, RFORCE; OptiStruct Reference Guide, RFORCE, for the sign of RACC).
void add_rotation(const LoadTarget& t, const records::Rotation& load) {
  const SourceLocation at = t.deck.locate(load.at);
  Vector3d centre = t.model.calc_point(0, Vector3d::Zero(), at, t.diagnostics);
  if (load.g > 0) {
    const int index = t.find_grid(load.g, "RFORCE", load.at);
    if (index < 0) return;
    centre = t.model.node(index).x;
  }
  const Vector3d axis = 2 * M_PI * (t.model.calc_axes(load.cid, centre, at, t.diagnostics) * load.r);
  Vector12d A_I = calc_load_factors(Vector3d::Zero(), -load.racc * axis, load.a * axis);
  A_I.head<3>() = -calc_acceleration_field(A_I).A * centre;
  t.A_I += t.scale * A_I;
}

/// ACCEL1: A N at its grids. ACCEL: N times a value that varies along one axis of CID, linear between the places of its
/// table and constant beyond them (Quick Reference Guide, ACCEL, ACCEL1). The sign is that of GRAV.
void add_grid_accelerations(const LoadTarget& t, const records::GridAcceleration& load) {
  const SourceLocation at = t.deck.locate(load.at);
  VectorXd field = VectorXd::Zero(t.model.num_gdofs());
  const auto set = [&](const Node& node, double value) {
    if (node.num_dofs != 6) return;
    field.segment<3>(node.first_gdof) = value * (t.model.calc_axes(load.cid, node.x, at, t.diagnostics) * load.n);
  };
  if (load.direction >= 0) {
    const Vector3d origin = t.model.calc_point(load.cid, Vector3d::Zero(), at, t.diagnostics);
    const Vector3d axis = t.model.calc_axes(load.cid, origin, at, t.diagnostics).col(load.direction);
    for (const Node& node : t.model.nodes()) set(node, interpolate(load.table, axis.dot(node.x - origin)));
  } else if (load.is_all) {
    for (const Node& node : t.model.nodes()) set(node, load.a);
  } else {
    for (const int grid : load.grids) {
      const int index = t.model.find_node(grid);
      if (index >= 0)
        set(t.model.node(index), load.a);
      else if (!load.skip_if_missing)
        t.find_grid(grid, "ACCEL1", load.at);
    }
  }
  const VectorXd force = calc_mass_times(t.model, t.model.mass_kind(), field);
  t.F += t.scale * (force - calc_superelement_force(t.model, field, list_without_gravity(t.model, t.deck)));
}

}  // namespace

bool add_body_loads(const LoadTarget& t) {
  bool is_found = false;
  for (const auto& gravity : t.deck.gravity) {
    if (gravity.sid != t.set) continue;
    is_found = true;
    const SourceLocation at = t.deck.locate(gravity.at);
    const Vector3d origin = t.model.calc_point(0, Vector3d::Zero(), at, t.diagnostics);
    t.A_I.head<3>() -= t.scale * gravity.a * (t.model.calc_axes(gravity.cid, origin, at, t.diagnostics) * gravity.n);
  }
  for (const auto& load : t.deck.load_cards.rotations) {
    if (load.sid != t.set) continue;
    is_found = true;
    add_rotation(t, load);
  }
  for (const auto& load : t.deck.special.accelerations) {
    if (load.sid != t.set) continue;
    is_found = true;
    add_grid_accelerations(t, load);
  }
  return is_found;
}

}  // namespace bough::fe
