#pragma once
/// \file Points of mass between the two ends of a consistent beam along a curve (docs/theory/third-order.md, "Rigid
/// links, offsets, carried masses").
///
/// The frame R halves the rotation between the ends, R = R_a exp(½ρ), exp(ρ) = R_aᵀR_b. Seen from it the ends turn by
/// -½ρ and ½ρ, and end b moves by d = Rᵀc - c_0, c from end a to end b. A place is at x_a + u_a + R (X + D q), an arm
/// at R (exp(τ̃) X + ..), with D q and τ the linear motion and rotation by what is seen. To second order these are the
/// fields of CarriedMass::add_chord_field; a rigid-body motion of the ends is one of the points at any order.
#include "fe/corotational/series.hpp"
#include "fe/elements/carried.hpp"

namespace bough::fe {

class ChordSeries {
 public:
  /// u: 12 x k, orders 1 to k, at most 5, of [u_A θ_A u_B θ_B] of the grids. `carried`: with one field; both outlive
  /// the object.
  ChordSeries(const CarriedMass& carried, const Eigen::Ref<const MatrixXd>& u);

  /// Motion of moved point p of the field.
  SeriesVector calc_motion(std::size_t p) const;
  /// Forces of the work Σ force_p·motion_p on the dofs of the grids, orders 1 to 5: 12 x 5. forces: of the moved
  /// points.
  MatrixXd calc_forces(const std::vector<SeriesVector>& forces) const;

 private:
  /// A point seen from the frame: its place from end a (order 0: undeformed), and of an arm its rotation.
  struct Seen {
    SeriesVector y, tau;
  };
  Seen look_at(std::size_t p) const;
  const CarriedPoint& point(std::size_t p) const {
    return carried_.points[static_cast<std::size_t>(field_.moved[p].point)];
  }
  /// Linear combination of -½ρ, d, ½ρ by the blocks of A for θ_A, u_B, θ_B.
  SeriesVector combine(const Eigen::Matrix<double, 3, 12>& A) const;

  const CarriedMass& carried_;
  const CarriedField& field_;
  SeriesVector theta_a_, theta_b_, u_a_, rho_, c_, d_;
  SeriesMatrix R_a_, R_;
};

}  // namespace bough::fe
