#pragma once
/// \file Force laws along one coordinate q of a hinge, in addition to its linear spring and damper:
///
///     preload - table(q - q_null) - table(q̇) - friction(q̇) + stops
///     friction  [F_c + (F_s - F_c) exp(-(q̇/v_s)²)] tanh(q̇/v_0)        Stribeck's, smooth over v_0
///               the same times the direction of sliding                  dry: solver/forces/joint_contact.hpp
///     stop      k δ (1 + c δ̇), not below zero, for δ past the stop       Hunt & Crossley with exponent 1
/// Along a prescribed coordinate nothing acts on the system: the prescribed motion strains springs by its own work.
#include <cmath>
#include <limits>

#include "solver/forces/element.hpp"
#include "solver/functions/curve.hpp"

namespace bough::solver {

class HingeLaw final : public ForceElement {
 public:
  struct Law {
    double preload = 0, null_position = 0;
    std::unique_ptr<const Curve> spring, damper;
    double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
    double stop_stiffness = 0, stop_damping = 0;
    double coulomb = 0, static_friction = 0, stribeck_velocity = 1, smoothing = 1;
    bool is_dry = false;  ///< friction by TreeData::slide in place of tanh(q̇/v_0)
  };
  /// \param q_row  row of the coordinate in q. \param u_row  row of its rate in u.
  HingeLaw(std::string name, int q_row, int u_row, Law law)
      : ForceElement(std::move(name)), q_row_(q_row), u_row_(u_row), law_(std::move(law)) {}

  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override;
  int num_kinks() const override { return (std::isfinite(law_.lower) ? 1 : 0) + (std::isfinite(law_.upper) ? 1 : 0); }
  void calc_kinks(const Tree&, const TreeData& data, double* g) const override {
    if (std::isfinite(law_.lower)) *g++ = data.q[q_row_] - law_.lower;
    if (std::isfinite(law_.upper)) *g = data.q[q_row_] - law_.upper;
  }
  bool is_along_hinge() const override { return true; }
  /// Returns true while the coordinate follows a prescribed motion, which then does the work of springs.
  bool is_prescribed(const TreeData& data) const {
    return data.mode[static_cast<size_t>(u_row_)] == HingeMode::Prescribed;
  }
  void add_tangent(const Tree& tree, const TreeData& data, Eigen::Ref<VectorXd> stiffness,
                   Eigen::Ref<VectorXd> damping) const override;

 private:
  template <class T>
  T calc_friction(T rate, double slide) const;
  /// [elastic, damper] at [q, rate]; of doubles the strain energy too.
  template <class T>
  std::array<T, 2> calc_forces(const std::array<T, 2>& at, double slide, double& strain) const;

  int q_row_, u_row_;
  Law law_;
};

}  // namespace bough::solver
