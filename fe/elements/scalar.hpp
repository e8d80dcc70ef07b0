#pragma once
/// \file CELAS1 to 4, CDAMP1 to 4 and CMASS1 to 4: a spring, a damper or a mass between two degrees of freedom (in the
/// displacement axes of their grids), or from one to ground. Source: Nastran Quick Reference Guide, CELAS1, CELAS2,
/// CDAMP1, CDAMP2, CMASS1, CMASS2.
#include "fe/elements/carried.hpp"
#include "fe/elements/damping.hpp"
#include "fe/elements/element.hpp"
#include "fe/elements/spring_rows.hpp"
#include "fe/elements/stress_state.hpp"

namespace bough::fe {

/// K = k b bᵀ; b holds the unit direction at the first end minus that at the second.
class ScalarSpring final : public Element, public PrintedForces, public SpringRows {
 public:
  ScalarSpring(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, double k, VectorXd b)
      : Element(id, std::move(card), std::move(nodes), std::move(gdofs)), k_(k), b_(std::move(b)) {}

  ElementShape shape() const override { return nodes().size() == 2 ? ElementShape{"line2", nodes()} : ElementShape{}; }
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  /// One force: tension k (u1 - u2). The spring has no direction in space, hence no geometric stiffness and no
  /// StressState.
  const PrintedForces* printed_forces() const override { return this; }
  std::vector<std::string> printed_force_names() const override { return {"force"}; }
  VectorXd calc_printed_forces(const Eigen::Ref<const VectorXd>& u) const override {
    return VectorXd::Constant(1, k_ * b_.dot(u));
  }
  MatrixXd calc_spring_rows() const override { return b_.transpose(); }

 private:
  double k_;
  VectorXd b_;
};

/// B = coefficient b bᵀ: a force against the difference of the two rates.
class ScalarDamper final : public Element, public Damping, public SpringRows {
 public:
  ScalarDamper(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, double coefficient, VectorXd b)
      : Element(id, std::move(card), std::move(nodes), std::move(gdofs)), coefficient_(coefficient), b_(std::move(b)) {}

  ElementShape shape() const override { return nodes().size() == 2 ? ElementShape{"line2", nodes()} : ElementShape{}; }
  const Damping* damping() const override { return this; }
  void add_damping(double scale, Eigen::Ref<MatrixXd> B) const override;
  MatrixXd calc_spring_rows() const override { return b_.transpose(); }

 private:
  double coefficient_;
  VectorXd b_;
};

/// M = m b bᵀ, lumped and consistent alike.
class ScalarMass final : public Element, public OffsetMass {
 public:
  /// \param turns  one of its ends is a rotation of a grid
  ScalarMass(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, double m, VectorXd b, bool turns)
      : Element(id, std::move(card), std::move(nodes), std::move(gdofs)), m_(m), b_(std::move(b)), turns_(turns) {}

  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  /// At rotations. One grid: the moment of inertia about an axis, of which several make that of a body.
  const OffsetMass* offset_mass(MassKind kind) const override;
  bool add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const override;

 private:
  double m_;
  VectorXd b_;
  bool turns_;
};

}  // namespace bough::fe
