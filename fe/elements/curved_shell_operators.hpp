#pragma once
/// \file Operators shared by curved_shell.cpp and curved_shell_forces.cpp. Internal.
#include <Eigen/Dense>

#include "fe/elements/curved_shell.hpp"

namespace bough::fe {

struct CurvedShell::Surface {
  Eigen::Matrix<double, 3, 2> x, V_a;  ///< x,r x,s and V,r V,s
  Vector3d V;
};

/// Strains at the points of quadrature, in their frames, per (u_i, d_i, bubbles).
struct CurvedShell::Operators {
  struct Point {
    Eigen::Matrix3Xd membrane, bending;
    Eigen::Matrix2Xd shear;
    Eigen::RowVectorXd drilling;      ///< θ·n - ½ rot u per dof of the element
    Eigen::Matrix3Xd turn, u_x, u_y;  ///< θ, u,x and u,y in the frame of the point per dof of the element
    Eigen::RowVectorXd spin;          ///< -½ rot u per (u_i, d_i)
    Eigen::Matrix3d to_local;         ///< (rr, ss, 2 rs) to (xx, yy, 2 xy)
    Eigen::Matrix2d J_inv;            ///< rows x, y; columns r, s
    double area = 0;                  ///< dA with the weight of the point
  };
  std::vector<Eigen::Matrix3Xd> membrane;  ///< covariant, per sample
  std::vector<Eigen::Matrix2Xd> shear;
  std::vector<Point> points;
};

/// S, or where the section is rigid in shear a stiffness that leaves 1e-6 of the bending of the element's own size.
inline Eigen::Matrix2d calc_shear_stiffness(const ShellSection& section, double area) {
  if (section.shear_flexible) return section.S;
  return 0.5e6 * (section.D(0, 0) + section.D(1, 1)) / area * Eigen::Matrix2d::Identity();
}

}  // namespace bough::fe
