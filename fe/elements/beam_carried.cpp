/// \file The bodies behind the mass of a beam: sections on its field, or at the ends of its arms.
#include <cmath>

#include "base/rotation.hpp"
#include "fe/elements/beam.hpp"
#include "fe/elements/carried.hpp"

namespace bough::fe {
namespace {

/// Moments per length about the shear centre, in element axes: those of M, with the inertia of the section about its y
/// and z axes where `bending` says so. A polar inertia (NSI) counts half for each axis. Where M has no bending inertia
/// the propeller moment still needs ∫(y² - z²): E is then wide of M by that, and not above it, so that no motion has
/// less energy in M than its pieces.
MassMoments calc_section_moments(const BeamProperty& property, const BeamSection& s, bool bending) {
  const Matrix6d m = calc_section_mass(property, s, bending);
  const Matrix3d J = m.bottomRightCorner<3, 3>();
  MassMoments moments{m(0, 0), {m(1, 5), m(2, 3), m(0, 4)}, 0.5 * J.trace() * Matrix3d::Identity() - J};
  if (property.has_torsional_inertia || (property.has_section_inertia && !bending)) {
    const double half = 0.5 * property.material.rho * (s.I1 - s.I2), product = property.material.rho * s.I12;
    moments.E(0, 0) -= std::hypot(half, product);
    moments.E(1, 1) += half;
    moments.E(2, 2) -= half;
    moments.E(1, 2) += product;
    moments.E(2, 1) += product;
  }
  return moments;
}

MassMoments turn_and_scale(const MassMoments& a, const Matrix3d& R, double scale) {
  return {scale * a.m, scale * R * a.S, scale * R * a.E * R.transpose()};
}

/// Inertia about a point at -`arm`.
MassMoments shift(const MassMoments& a, const Vector3d& arm) {
  const Matrix3d cross = arm * a.S.transpose();
  return {a.m, a.S + a.m * arm, a.E + cross + cross.transpose() + a.m * arm * arm.transpose()};
}

}  // namespace

const OffsetMass* Beam::offset_mass(MassKind kind) const {
  const bool has_inertia = property_->has_section_inertia || property_->has_torsional_inertia;
  return kind == MassKind::Consistent || has_inertia || has_arms() ? this : nullptr;
}

bool Beam::add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const {
  if (carried.detail == CarriedDetail::Whether) return true;
  kind == MassKind::Lumped ? add_lumped_bodies(x, carried) : add_consistent_bodies(x, carried);
  return true;
}

void Beam::add_lumped_bodies(const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const {
  const BeamField& field = *field_;
  MassMoments end[2];
  for (const auto& point : field.calc_points(2, 3)) {
    const double t = point.x / geometry_.length;
    const MassMoments section = calc_section_moments(*property_, property_->calc_section(t), false);
    for (int k = 0; k < 2; ++k) {
      const double part = point.weight * (k == 0 ? 1 - t : t);
      end[k].m += part * section.m, end[k].S += part * section.S, end[k].E += part * section.E;
    }
  }
  for (int k = 0; k < 2; ++k) {
    const auto about_grid =
        shift(turn_and_scale(end[k], geometry_.R_basic_element, 1), k == 0 ? geometry_.wa : geometry_.wb);
    carried.add_grid_body(x.col(k), about_grid.m, about_grid.S, about_grid.E, 6 * k);
  }
}

void Beam::add_consistent_bodies(const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const {
  using Motion = Eigen::Matrix<double, 3, 12>;
  const BeamField& field = *field_;
  const Matrix3d& R = geometry_.R_basic_element;
  Matrix12d turn = Matrix12d::Zero(), tips = Matrix12d::Identity();  // element axes, grids to tips
  for (int i = 0; i < 12; i += 3) turn.block<3, 3>(i, i) = R.transpose();
  tips.block<3, 3>(0, 3) = -skew(geometry_.wa);
  tips.block<3, 3>(6, 9) = -skew(geometry_.wb);
  const bool has_pins = geometry_.pin_a || geometry_.pin_b;
  const Matrix12d released = has_pins ? Matrix12d(calc_release() * turn) : turn;  // by the tips in basic axes
  const Vector3d arms[2] = {geometry_.wa, geometry_.wb}, x_a = x.col(0) + geometry_.wa;
  const bool has_arms = !arms[0].isZero(0) || !arms[1].isZero(0);
  const auto by_grids = [&](const Motion& motion) { return has_arms ? Motion(motion * tips) : motion; };
  const bool needs_second = carried.detail == CarriedDetail::SecondOrder;
  // Second-order motion of the points by that of the ends of the arms.
  std::vector<std::pair<int, Matrix3d>> by_end[2];
  std::vector<ChordPoint> moved;
  const auto add_ends = [&](int p, const Motion& motion) {
    for (int k = 0; k < 2; ++k)
      if (!arms[k].isZero(0)) by_end[k].emplace_back(p, motion.middleCols<3>(6 * k));
  };
  double mass = 0;
  for (const auto& point : field.calc_points(4, 7)) {
    const auto section = turn_and_scale(
        calc_section_moments(*property_, property_->calc_section(point.x / geometry_.length), true), R, point.weight);
    Matrix6x12d D;
    field.calc_shape(point.x, &D, nullptr);
    const Motion U = R * D.topRows<3>() * released, Theta = R * D.bottomRows<3>() * released;
    const int first = carried.add_body(x_a + point.x * R.col(0), section.m, section.S, section.E, by_grids(U),
                                       by_grids(Theta), -1, false);
    for (int p = first; needs_second && p < static_cast<int>(carried.points.size()); ++p) {
      const auto& added = carried.points[static_cast<std::size_t>(p)];
      moved.push_back({p, added.is_place ? U : Motion(-skew(added.x) * Theta), Theta});
      add_ends(p, moved.back().motion);
    }
    mass += section.m;
  }
  if (needs_second) carried.add_chord_field(x_a, geometry_.length * R.col(0), tips, moved);
  if (!property_->has_section_inertia && !property_->has_torsional_inertia && !geometry_.is_part) {
    // The mean of lumped and consistent along the axis: a mass that feels the stretch and is nowhere, so that the pull
    // of spin is that of the line.
    const Motion stretch = R.col(0) * (released.row(6) - released.row(0));
    const int p = carried.add_point(false, Vector3d::Zero(), by_grids(stretch));
    carried.mu(p, p) = mass / 12;
  }
  for (int k = 0; k < 2; ++k) {
    if (by_end[k].empty()) continue;
    auto& second = carried.turns[static_cast<std::size_t>(carried.add_turn(6 * k + 3))];
    for (const auto& [p, B] : by_end[k]) second.parts.push_back({p, arms[k], B});
  }
}

}  // namespace bough::fe
