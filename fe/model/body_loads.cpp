#include <algorithm>
#include <cmath>

#include "bough/base/rotation.hpp"
#include "bough/fe/assembly.hpp"
#include "bough/fe/model/load_sets.hpp"

namespace bough::fe {
namespace {

/// What the acceleration of the grids misses: the mass of a CONM off its grid is elsewhere, and its own inertia turns.
void add_offset_terms(const LoadTarget& t, const Vector3d& omega) {
  for (const auto& element : t.model.elements()) {
    // The terms of a DMIG at one grid need not be those of a mass.
    if (element->nodes().size() != 1 || element->num_dofs() != 6 || element->card() == "DMIG") continue;
    MatrixXd M = MatrixXd::Zero(6, 6);
    element->add_mass(t.model.mass_kind(), t.scale * t.model.wtmass(), M);
    const Vector3d moment(M(1, 5), M(2, 3), M(0, 4));  // m s, from -m s̃
    const Matrix3d inertia = M.bottomRightCorner<3, 3>();
    const int first = element->gdofs().front();
    t.F.segment<3>(first) -= omega.cross(omega.cross(moment));
    t.F.segment<3>(first + 3) -= omega.cross(Vector3d(inertia * omega));
  }
}

/// From each grid of an element to its lumped mass (3 x grids); none where the element has no lumps off its grids.
MatrixXd find_lump_offsets(const LoadTarget& t, const Element& element) {
  const auto n = static_cast<Eigen::Index>(element.nodes().size());
  if (n < 2 || element.num_dofs() != 6 * n || element.card() == "DMIG") return {};
  MatrixXd M = MatrixXd::Zero(6 * n, 6 * n), offsets = MatrixXd::Zero(3, n);
  element.add_mass(MassKind::Lumped, t.model.wtmass(), M);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto block = M.block<6, 6>(6 * i, 6 * i);
    const double m = block(0, 0);
    if (!(m > 0)) continue;
    offsets.col(i) = Vector3d(block(1, 5), block(2, 3), block(0, 4)) / m;  // -m s̃
  }
  if (offsets.isZero(0)) return {};
  for (Eigen::Index i = 0; i < n; ++i) M.block<6, 6>(6 * i, 6 * i).setZero();
  return M.isZero(0) ? offsets : MatrixXd{};
}

/// The mass of bars off their grids turns about the axis at its own radius, not at that of the grids.
void add_offset_elements(const LoadTarget& t, const Vector3d& omega) {
  for (const auto& element : t.model.elements()) {
    const MatrixXd offsets = find_lump_offsets(t, *element);
    if (offsets.size() == 0) continue;
    const auto n = offsets.cols();
    VectorXd field = VectorXd::Zero(6 * n);
    for (Eigen::Index i = 0; i < n; ++i) field.segment<3>(6 * i) = -omega.cross(omega.cross(Vector3d(offsets.col(i))));
    MatrixXd M = MatrixXd::Zero(6 * n, 6 * n);
    element->add_mass(t.model.mass_kind(), t.scale * t.model.wtmass(), M);
    const VectorXd f = M * field;
    for (Eigen::Index i = 0; i < 6 * n; ++i) t.F[element->gdofs()[static_cast<std::size_t>(i)]] += f[i];
  }
}

double interpolate(const std::vector<std::pair<double, double>>& table, double x) {
  const auto after = std::find_if(table.begin(), table.end(), [x](const auto& point) { return point.first > x; });
  if (after == table.begin()) return after->second;
  if (after == table.end()) return table.back().second;
  const auto& [x0, y0] = *(after - 1);
  return y0 + (x - x0) / (after->first - x0) * (after->second - y0);
}

/// Centrifugal force outward and force along an angular acceleration: M (-ω×(ω×r) + α×r) at the grids (Nastran Quick
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
  const Vector3d omega = load.a * axis, alpha = load.racc * axis;
  VectorXd field = VectorXd::Zero(t.model.num_gdofs());
  for (const Node& node : t.model.nodes()) {
    if (node.num_dofs != 6) continue;
    const Vector3d r = node.x - centre;
    field.segment<3>(node.first_gdof) = -omega.cross(omega.cross(r)) + alpha.cross(r);
    field.segment<3>(node.first_gdof + 3) = alpha;
  }
  t.F += t.scale * calc_mass_times(t.model, t.model.mass_kind(), field);
  add_offset_terms(t, omega);
  add_offset_elements(t, omega);
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
  t.F += t.scale * calc_mass_times(t.model, t.model.mass_kind(), field);
}

}  // namespace

bool add_body_loads(const LoadTarget& t) {
  bool is_found = false;
  Vector3d acceleration = Vector3d::Zero();
  for (const auto& gravity : t.deck.gravity) {
    if (gravity.sid != t.set) continue;
    is_found = true;
    const SourceLocation at = t.deck.locate(gravity.at);
    const Vector3d origin = t.model.calc_point(0, Vector3d::Zero(), at, t.diagnostics);
    acceleration += t.scale * gravity.a * (t.model.calc_axes(gravity.cid, origin, at, t.diagnostics) * gravity.n);
  }
  if (!acceleration.isZero(0))
    t.F += calc_mass_times(t.model, t.model.mass_kind(), t.model.calc_rigid_modes().leftCols<3>() * acceleration);
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
