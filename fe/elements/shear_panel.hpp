#pragma once
/// \file Shear panel (CSHEAR): carries shear flow along its sides, and by PSHEAR's F1, F2 extension along them.
///
/// S. J. Garvey, "The quadrilateral shear panel", Aircraft Engineering 23 (1951) 134-135; NASTRAN Theoretical Manual
/// (NASA SP-221), 5.3. The lines of the two pencils through the points where opposite sides meet carry shear alone.
/// The shear field is the projective image of constant shear in a square: with homogeneous weights w_i of the corners
/// (the areas of the triangles of the three others), linear over the square, the shear flow is s w² on every line of
/// both pencils, and s w_i w_j is its mean along the side ij. Its complementary energy gives the stiffness, by 8 x 8
/// Gauss points (a parallelogram: A/(G t) (1 + 2 cot² α/(1 + ν)), the manual's). Half of each side's force acts on
/// either end, as in NASTRAN. A warped panel is computed on its mean plane; forces normal to it at the corners, of
/// least norm, put those at the true corners into equilibrium.
#include <array>

#include "fe/elements/element.hpp"
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"

namespace bough::fe {

struct ShearPanelProperty {
  double G = 0, nu = 0, E = 0;
  double t = 0;
  double mass = 0;                   ///< per area
  std::array<double, 4> rod_area{};  ///< of the sides 1-2, 2-3, 3-4, 4-1
};

class ShearPanel final : public Element, public StressState, public StressRecovery {
 public:
  /// Three translations per corner. The corners must be convex on their mean plane.
  ShearPanel(int id, std::vector<int> nodes, std::vector<int> gdofs, const std::array<Vector3d, 4>& x,
             const ShearPanelProperty& property);

  /// Homogeneous weights of the corners, mean 1; one is not positive where the panel is not convex.
  static Eigen::Vector4d calc_weights(const std::array<Vector3d, 4>& x);
  /// Area of the mean plane's quadrilateral: half the cross product of the diagonals.
  static double calc_area(const std::array<Vector3d, 4>& x);

  ElementShape shape() const override { return {"quad4", nodes()}; }
  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;
  /// Lumped alone: ∫N_i over the mean plane.
  void add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const override;
  const StressState* stress_state() const override { return this; }
  /// Mean shear flows q12 q23 q34 q41, positive with a positive shear strain at corner 1 (its angle grows smaller), and
  /// the forces of the four rods.
  int num_internal_forces() const override { return 8; }
  void calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const override;
  std::vector<std::string> internal_force_names() const override;
  const StressRecovery* stress_recovery() const override { return this; }
  /// Shear flow over thickness along each side.
  std::vector<StressPoint> stress_points() const override;
  MatrixXd calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const override;
  MatrixXd calc_strains(const Eigen::Ref<const MatrixXd>& forces) const override;
  /// ∫ N_ab u,a·u,b of the panel's stress field with the shapes w_i N_i / w, which hold x; rods N/L across.
  void add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                               Eigen::Ref<MatrixXd> K_G) const override;

 private:
  Vector3d calc_side(int side, double* length) const;

  std::array<Vector3d, 4> x_;
  ShearPanelProperty property_;
  Eigen::Vector4d weight_, mass_;
  Eigen::Matrix<double, 12, 1> forces_;  // on the corners for s = 1
  double flexibility_ = 0;
};

}  // namespace bough::fe
