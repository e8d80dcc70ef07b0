#pragma once
/// \file CBUSH1D: spring, damper and mass along one axis: the line of two grids, or x of a coordinate system (then also
/// to ground). Source: Nastran Quick Reference Guide, CBUSH1D and PBUSH1D (linear part).
#include <optional>

#include "fe/elements/damping.hpp"
#include "fe/elements/element.hpp"
#include "fe/elements/stress_state.hpp"

namespace bough::fe {

struct Bush1dData {
  double k = 0, c = 0, mass = 0;
  Vector3d axis = Vector3d::UnitX();  ///< unit, basic; from the first grid to the second where they give it
  std::optional<double> length;  ///< of the line of two grids; absent: the axis is that of a system, it never turns
};

/// One node (grounded) or two; translations alone. Half the mass at each end (the half of a grounded end is on the
/// ground). The force N = k (u2 - u1)·axis is tension; along a line it has K_G = N/L (1 - a aᵀ), as a rod.
class Bush1d final : public Element, public StressState, public Damping {
 public:
  /// `gdofs`: the three translations of each node.
  Bush1d(int id, std::vector<int> nodes, std::vector<int> gdofs, const Bush1dData& data);

  ElementShape shape() const override { return nodes().size() == 2 ? ElementShape{"line2", nodes()} : ElementShape{}; }
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  const Damping* damping() const override { return data_.c != 0 ? this : nullptr; }
  void add_damping(double scale, Eigen::Ref<MatrixXd> B) const override;
  const StressState* stress_state() const override { return this; }
  int num_internal_forces() const override { return 1; }
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override;
  std::vector<std::string> internal_force_names() const override { return {"axial"}; }
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;

 private:
  void add_between_ends(const Matrix3d& block, Eigen::Ref<MatrixXd> A) const;

  Bush1dData data_;
};

}  // namespace bough::fe
