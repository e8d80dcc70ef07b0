#pragma once
/// \file CVISC: a damper along the line of two grids and one about it. Source: Nastran Quick Reference Guide, CVISC and
/// PVISC.
#include "fe/elements/damping.hpp"
#include "fe/elements/element.hpp"

namespace bough::fe {

/// B = ce aᵀa + cr tᵀt, a and t the rates of extension and twist for unit rates of the 12 dofs. No stiffness, no mass.
class Viscous final : public Element, public Damping {
 public:
  /// `axis`: unit vector from the first grid to the second, basic.
  Viscous(int id, std::vector<int> nodes, std::vector<int> gdofs, double ce, double cr, const Vector3d& axis);

  ElementShape shape() const override { return {"line2", nodes()}; }
  const Damping* damping() const override { return this; }
  void add_damping(double scale, Eigen::Ref<MatrixXd> B) const override;

 private:
  double ce_, cr_;
  Vector3d axis_;
};

}  // namespace bough::fe
