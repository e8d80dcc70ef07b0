#pragma once
/// \file Where curved shells of eight and of six nodes sample their strains, and how these are interpolated (MITC).
///
/// Covariant strains e = (rr, ss, 2 rs) of the membrane and γ = (r, s) of the transverse shear are sampled at tying
/// points and interpolated to the points of quadrature; both are linear in the samples, with weights that no geometry
/// enters.
///
/// Quadrilateral: membrane as MITC9 (Bucalem & Bathe, IJNME 36 (1993) 3729-3754): rr at r = ±1/√3, s = 0, ±√0.6, ss
/// likewise, rs at the four Gauss points. Shear as the plate element MITC9 (Bathe, Brezzi & Fortin, IJNME 28 (1989)
/// 1787-1801): γ_r in {1, r, s, rs, s²} by its tangential values at two Gauss points of the sides s = ±1 and its mean
/// over the element. Triangle: membrane as MITC6 (Lee & Bathe, Computers & Structures 82 (2004) 945-962): the strain
/// along each side linear, tied at the two Gauss points of that side and midway on the parallel at 1/√3; shear as MITC7
/// (Bathe, Brezzi & Fortin 1989): γ_r = a1 + b1 r + c1 s + s (d r + e s), γ_s = a2 + b2 r + c2 s - r (d r + e s),
/// tangential values at two Gauss points of each side and the means.
#include <vector>

#include <Eigen/Dense>

namespace bough::fe {

/// Values of the full set of shapes (corners, midsides, then the bubble) at a point.
struct ShellSample {
  Eigen::Vector2d natural;
  Eigen::VectorXd shape;    ///< n + 1
  Eigen::Matrix2Xd dshape;  ///< 2 x (n + 1)
};

struct MembraneTie {
  int sample;
  Eigen::Matrix3d weight;
};
struct ShearTie {
  int sample;
  Eigen::Matrix2d weight;
};

/// A point of quadrature: e = Σ weight e(sample), γ likewise.
struct ShellPoint {
  int sample;     ///< the point itself
  double weight;  ///< in natural coordinates
  std::vector<MembraneTie> membrane;
  std::vector<ShearTie> shear;
};

struct ShellTying {
  int num_corners = 0;
  int num_nodes = 0;  ///< 8 or 6: twice the corners
  std::vector<ShellSample> samples;
  std::vector<ShellPoint> points;  ///< 3 x 3 Gauss, or six of degree 4 (Dunavant, IJNME 21 (1985) 1129-1148)
  Eigen::MatrixX2d node_natural;   ///< natural coordinates of the nodes
};

/// num_corners: 4 or 3. Made once.
const ShellTying& get_shell_tying(int num_corners);

}  // namespace bough::fe
