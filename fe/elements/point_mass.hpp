#pragma once
/// \file CONM1 and CONM2: a 6 x 6 mass at one grid.
/// Source: Nastran Quick Reference Guide, CONM1 and CONM2.
#include "bough/fe/elements/element.hpp"

namespace bough::fe {

class PointMass final : public Element {
 public:
  /// M: 6 x 6 about the grid in basic axes, symmetric.
  PointMass(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs,
            const Eigen::Matrix<double, 6, 6>& M)
      : Element(id, std::move(card), std::move(nodes), std::move(gdofs)), M_(M) {}

  ElementShape shape() const override { return {"vertex", nodes()}; }
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;

 private:
  Eigen::Matrix<double, 6, 6> M_;
};

/// Mass m with inertia I (3 x 3 about its centre) at offset s from the grid: [m -m s̃; m s̃  I - m s̃ s̃].
Eigen::Matrix<double, 6, 6> calc_rigid_mass(double m, const Vector3d& s, const Matrix3d& I);

}  // namespace bough::fe
