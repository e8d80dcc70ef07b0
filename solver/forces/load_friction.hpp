#pragma once
/// \file Friction of a hinge coordinate in proportion to the load that its bearing carries
/// (solver/system/load_friction).
///
/// With F and M the reaction of the hinge at the origin of Hc (force and moment of the parent on the child), split
/// along the axis of the coordinate (a) and across it (c), the bearing load is
///     L = radial |F_c| + axial |F_a| + bending |M_c| + torsion |M_a|
/// and the friction μ(q̇) L against the rate. Weights by kind of coordinate, with R the pin radius:
///     angle     radial = R, axial = friction arm, bending = R / bending arm, torsion = 0
///     travel    radial = 1, axial = 0, bending = 1 / bending arm, torsion = 1 / reaction arm
#include <cmath>
#include <string>

#include "base/diagnostic.hpp"
#include "solver/tree/data.hpp"

namespace bough::solver {

struct LoadFriction {
  std::string name;  ///< "coordinate 1 of hinge 'slide'"
  SourceLocation at;
  int body = -1;       ///< whose inboard hinge it is
  int coordinate = 0;  ///< of the hinge, from 0
  int u_row = 0;
  double dynamic = 0, at_rest = 0;  ///< coefficients μ
  double stribeck_velocity = 0;     ///< 0: none, at_rest holds a sticking coordinate only
  double smoothing = 0;
  bool is_dry = false;  ///< direction by TreeData::slide in place of tanh(q̇/smoothing)
  double radial = 0, axial = 0, bending = 0, torsion = 0;

  /// Signed coefficient: [μ_d + (μ_s - μ_d) exp(-(q̇/v_s)²)] times the direction of sliding.
  /// \param slide  -1, 0 or 1: direction of dry friction.
  template <class T>
  T calc_coefficient(T rate, double slide) const {
    using std::exp, std::tanh;
    T mu = dynamic;
    if (stribeck_velocity > 0) {
      const T s = rate / stribeck_velocity;
      mu += (at_rest - dynamic) * exp(-s * s);
    }
    return mu * (is_dry ? T(slide) : tanh(rate / smoothing));
  }

  /// Unit axis of the coordinate, in Hp. After calc_position.
  Vector3d calc_axis(const TreeData& data) const {
    const auto H = data[body].hinge.H.col(coordinate);
    const Vector3d angular = H.tail<3>(), linear = H.head<3>();
    return angular.isZero(0) ? linear.normalized() : angular.normalized();
  }

  /// Bearing load L of a reaction. \param axis  unit, in the axes of the reaction.
  /// \param[out] slope  ∂L/∂[F; M]; zero for parts that vanish. nullptr: not computed.
  double calc_load(const HingeReaction& reaction, const Vector3d& axis, Vector6d* slope = nullptr) const {
    const double f = reaction.force.dot(axis), m = reaction.moment.dot(axis);
    const Vector3d f_across = reaction.force - f * axis, m_across = reaction.moment - m * axis;
    const double f_size = f_across.norm(), m_size = m_across.norm();
    if (slope) {
      const auto unit = [](const Vector3d& v, double size) -> Vector3d {
        return size > 0 ? Vector3d(v / size) : Vector3d(Vector3d::Zero());
      };
      slope->head<3>() = radial * unit(f_across, f_size) + axial * (f < 0 ? -1 : 1) * axis;
      slope->tail<3>() = bending * unit(m_across, m_size) + torsion * (m < 0 ? -1 : 1) * axis;
    }
    return radial * f_size + axial * std::abs(f) + bending * m_size + torsion * std::abs(m);
  }
};

}  // namespace bough::solver
