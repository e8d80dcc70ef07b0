/// \file The bodies behind the mass of the shells: points at the centre of mass of the section over each grid, and arms
/// along the normal for what is spread through the thickness.
#include "base/rotation.hpp"
#include "fe/elements/carried.hpp"
#include "fe/elements/curved_shell.hpp"
#include "fe/elements/shell.hpp"

namespace bough::fe {

const OffsetMass* Shell::offset_mass(MassKind kind) const {
  const bool has_rotary_inertia = kind == MassKind::Consistent && section_.rotary_inertia != 0;
  return z_offset_ + section_.mass_offset != 0 || has_rotary_inertia ? this : nullptr;
}

bool Shell::add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const {
  if (carried.detail == CarriedDetail::Whether) return true;
  const int n = num_nodes();
  const Vector3d z = R_.col(2), arm = (z_offset_ + section_.mass_offset) * z;
  const double rotary = kind == MassKind::Consistent ? section_.rotary_inertia : 0;
  const MatrixXd area = calc_mass_areas(kind);
  std::vector<int> place, spread;
  for (int i = 0; i < n; ++i) {
    const Matrix3Xd turn = carried.select(6 * i + 3);
    place.push_back(carried.add_point(true, x.col(i) + arm, carried.select(6 * i) - skew(arm) * turn));
    if (rotary != 0) spread.push_back(carried.add_point(false, z, -skew(z) * turn));
    auto& second = carried.turns[static_cast<std::size_t>(carried.add_turn(6 * i + 3))];
    if (!arm.isZero(0)) second.parts.push_back({place.back(), arm, Matrix3d::Identity()});
    if (rotary != 0) second.parts.push_back({spread.back(), z, Matrix3d::Identity()});
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      carried.mu(place[a], place[b]) = section_.mass * area(i, j);
      if (rotary != 0) carried.mu(spread[a], spread[b]) = rotary * area(i, j);
    }
  return true;
}

const OffsetMass* CurvedShell::offset_mass(MassKind kind) const {
  for (const auto& section : sections_)
    if (z_offset_ + section.mass_offset != 0 || (kind == MassKind::Consistent && section.rotary_inertia != 0))
      return this;
  return nullptr;
}

bool CurvedShell::add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const {
  if (carried.detail == CarriedDetail::Whether) return true;
  const auto masses = calc_nodal_masses(kind);
  const int n = static_cast<int>(nodes().size());
  for (int i = 0; i < n; ++i) {
    const int place = carried.add_point(true, x.col(i), carried.select(6 * i));
    const Vector3d& V = masses.normal[static_cast<std::size_t>(i)];
    const int spread = carried.add_point(false, V, -skew(V) * carried.select(6 * i + 3));
    BOUGH_DEMAND(place == 2 * i && spread == place + 1);
    carried.turns[static_cast<std::size_t>(carried.add_turn(6 * i + 3))].parts.push_back(
        {spread, V, Matrix3d::Identity()});
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      carried.mu(2 * i, 2 * j) = masses.zeroth(i, j);
      carried.mu(2 * i, 2 * j + 1) = carried.mu(2 * j + 1, 2 * i) = masses.first(i, j);
      carried.mu(2 * i + 1, 2 * j + 1) = masses.second(i, j);
    }
  return true;
}

}  // namespace bough::fe
