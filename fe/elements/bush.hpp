#pragma once
/// \file CBUSH and CGAP: six springs and six dampers in element axes at one point, carried to the grids by rigid arms.
/// Source: Nastran Quick Reference Guide, CBUSH and PBUSH.
#include "fe/elements/damping.hpp"
#include "fe/elements/element.hpp"
#include "fe/elements/spring_rows.hpp"
#include "fe/elements/stress_state.hpp"

namespace bough::fe {

struct BushData {
  Matrix3d R_basic_element = Matrix3d::Identity();
  std::array<double, 6> k{};          ///< along and about the element axes
  std::array<double, 6> b{};          ///< viscous damping, likewise
  std::array<double, 6> ge{};         ///< structural damping, likewise
  Vector3d arm_a = Vector3d::Zero();  ///< spring point from grid A, basic
  Vector3d arm_b = Vector3d::Zero();  ///< and from grid B
  double mass = 0;
};

/// One node (grounded) or two. Half the mass at each end, translations only; the half of a grounded end is on the
/// ground. K_G: the forces on the arms, and the axes of the spring, which turn with the mean of the two grids; a spring
/// to ground keeps its axes.
class Bush final : public Element, public StressState, public Damping, public SpringRows {
 public:
  Bush(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, const BushData& data);

  ElementShape shape() const override { return nodes().size() == 2 ? ElementShape{"line2", nodes()} : ElementShape{}; }
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  const Damping* damping() const override;
  void add_damping(double scale, Eigen::Ref<MatrixXd> B) const override;
  void add_structural_damping(double g, Eigen::Ref<MatrixXd> K) const override;
  const StressState* stress_state() const override { return this; }
  int num_internal_forces() const override { return 6; }
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override {
    force = calc_spring_forces(u);
  }
  std::vector<std::string> internal_force_names() const override {
    return {"force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"};
  }
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;
  /// Six spring forces in element axes, of B on the spring's B side.
  Eigen::Matrix<double, 6, 1> calc_spring_forces(const Eigen::Ref<const VectorXd>& u) const;
  MatrixXd calc_spring_rows() const override { return calc_stretch(); }

 private:
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 12> calc_stretch() const;

  BushData data_;
};

}  // namespace bough::fe
