#pragma once
/// \file Strain fields of the flat shells in element axes, N = 3 or 4 corners and as many quadrature points. Internal.
///
/// Membrane operators act on u v θz of each corner, plate operators on w θx θy. All sizes are fixed: no heap.
#include <array>

#include "fe/sections/shell_section.hpp"

namespace bough::fe::shell {

template <int N>
using Corners = Eigen::Matrix<double, 2, N>;
template <int N>
using Row = Eigen::Matrix<double, 1, 3 * N>;
template <int N>
using Vectors = Eigen::Matrix<double, 2, 3 * N>;
template <int N>
using Strains = Eigen::Matrix<double, 3, 3 * N>;  ///< xx yy xy (engineering)

template <int N>
struct Point {
  double r = 0, s = 0, weight = 0;     ///< natural coordinates, dA
  Eigen::Matrix<double, N, 1> shape;   ///< bilinear (linear)
  Eigen::Matrix<double, 2, N> dshape;  ///< by x, y
  Eigen::Matrix2d J_inv;               ///< d(r,s)/d(x,y): rows by x, y
  double J = 0;                        ///< dA / (dr ds)
};
template <int N>
using Points = std::array<Point<N>, N>;

/// 2 x 2 Gauss, or three inner points.
template <int N>
Points<N> calc_points(const Corners<N>& xy);
/// The point at the centre, with the whole area as its weight.
template <int N>
Point<N> calc_centre(const Corners<N>& xy);

/// Bending and transverse shear of DKMQ and DKMT (Katili 1993).
template <int N>
struct Plate {
  struct Side {
    int i = 0, j = 0;
    double length = 0;
    Eigen::Vector2d t;  ///< unit vector from i to j
    double phi = 0;     ///< 12 D_s / (S_s L²), 0 without transverse shear
    Row<N> mean;        ///< (w_j - w_i)/L + ½ t·(β_i + β_j): mean shear of the side before the bump
  };
  std::array<Side, N> sides;
  std::array<Strains<N>, N> bending;
  std::array<Vectors<N>, N> shear;  ///< γ
  std::array<Vectors<N>, N> slope;  ///< w,x w,y = γ - β; of w alone without bending
  std::array<Vectors<N>, N> force;  ///< Q: S γ, or its limit 12 D_s/L² of each side's mean when rigid in shear
  /// Per side and point: curvature and shear by a unit mean shear of the side.
  std::array<std::array<Eigen::Vector3d, N>, N> side_bending;
  std::array<std::array<Eigen::Vector2d, N>, N> side_shear;
};
/// Computes the plate operators at the points, `xy` the corners in element axes (Katili 1993, DKMT and DKMQ).
template <int N>
Plate<N> calc_plate(const Corners<N>& xy, const Points<N>& points, const ShellSection& section);

/// [3×3] -A⁻¹ B: strains that curvatures draw with them where no membrane force may grow (Reddy, Mechanics of Laminated
/// Composite Plates and Shells, §4.2), so that moments are (D - Bᵀ A⁻¹ B) κ. Zero without coupling, or with a singular
/// A.
Eigen::Matrix3d calc_stretch_of_curvature(const ShellSection& section);

enum class MembraneKind { Plain, Drilling };

template <int N>
struct Membrane {
  std::array<Strains<N>, N> strain;
  bool has_rotations = false;  ///< the corners' θz strain it
  bool coupled = false;        ///< stretch and strain_of_plate count
  Eigen::Matrix3d stretch;     ///< -A⁻¹ B
  /// -A⁻¹ B (κ - κ̄) with κ̄ the mean over the element: without it the membrane, which is poorer than the plate, would
  /// hold curvatures that vary. Enhanced strain of zero mean (Simo & Rifai, IJNME 29 (1990) 1595-1638): constant states
  /// stay.
  std::array<Strains<N>, N> strain_of_plate;
  /// Strains of the four inner modes, condensed into `strain`, and their own stiffness; only where has_modes.
  bool has_modes = false;
  std::array<Eigen::Matrix<double, 3, 4>, N> mode;
  Eigen::Matrix4d mode_stiffness;
  /// Stiffness in addition to that of the strains: weight (row·dofs)²: drilling.
  int num_springs = 0;
  std::array<Row<N>, N> spring;
  std::array<double, N> spring_weight;
};
/// Plain: QM6 or constant strain, with the drilling penalty section.drilling. Drilling: see shell_membrane.cpp.
template <int N>
Membrane<N> calc_membrane(MembraneKind kind, const Corners<N>& xy, const Points<N>& points, const ShellSection& section,
                          const Plate<N>& plate);

template <int N>
struct ShellFields {
  Points<N> points;
  Plate<N> plate;
  Membrane<N> membrane;
};

/// ½(v,x - u,y) of the bilinear (linear) field at a point.
template <int N>
Row<N> calc_spin(const Point<N>& at) {
  Row<N> row = Row<N>::Zero();
  for (int i = 0; i < N; ++i) {
    row[3 * i] = -0.5 * at.dshape(1, i);
    row[3 * i + 1] = 0.5 * at.dshape(0, i);
  }
  return row;
}

}  // namespace bough::fe::shell
