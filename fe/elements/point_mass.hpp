#pragma once
/// \file CONM1 and CONM2: a 6 x 6 mass at one grid.
/// Source: Nastran Quick Reference Guide, CONM1 and CONM2.
#include "fe/elements/carried.hpp"
#include "fe/elements/element.hpp"

namespace bough::fe {

class PointMass final : public Element, public OffsetMass {
 public:
  /// M: 6 x 6 about the grid in basic axes, symmetric.
  PointMass(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs,
            const Eigen::Matrix<double, 6, 6>& M)
      : Element(id, std::move(card), std::move(nodes), std::move(gdofs)), M_(M), is_rigid_(find_moments(M, moments_)) {}

  ElementShape shape() const override { return {"vertex", nodes()}; }
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  const OffsetMass* offset_mass(MassKind) const override;
  bool add_carried(MassKind kind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const override;
  bool is_rigid() const { return is_rigid_; }  ///< M is that of a rigid body

 private:
  Eigen::Matrix<double, 6, 6> M_;
  MassMoments moments_;
  bool is_rigid_;
};

/// Mass m with inertia I (3 x 3 about its centre) at offset s from the grid: [m -m s̃; m s̃  I - m s̃ s̃].
Eigen::Matrix<double, 6, 6> calc_rigid_mass(double m, const Vector3d& s, const Matrix3d& I);

}  // namespace bough::fe
