#pragma once
/// \file Gyroscopic and circulatory matrices of rotors in the fixed frame (docs/theory/rotors.md).
#include <string>
#include <vector>

#include "fe/model/model.hpp"

namespace bough::fe {

/// Frame of the displacements: fixed in space, or turning with the rotor.
enum class RotorFrame { Fixed, Rotating };

/// Grids that spin about an axis: on it, or all around it.
struct RotorAxis {
  int id = 0;
  std::vector<int> grids;             ///< ids
  Vector3d axis = Vector3d::UnitX();  ///< unit vector in basic; positive spin by the right-hand rule
  SourceLocation at;
  Vector3d point = Vector3d::Zero();  ///< [L] a point of the axis
  bool is_spatial = false;            ///< grids are around the axis: a body of shells, solids and bars
  RotorFrame frame = RotorFrame::Fixed;
};

/// Grids and elements of a rotor in a model.
struct Rotor {
  int id = 0;
  Vector3d axis = Vector3d::UnitX();
  Vector3d point = Vector3d::Zero();
  bool is_spatial = false;
  RotorFrame frame = RotorFrame::Fixed;
  std::vector<int> nodes;                ///< indices into Model::nodes()
  std::vector<const Element*> elements;  ///< all of their grids are on the rotor
  double mass = 0, polar_inertia = 0;    ///< [M], [M L²] about the axis, with PARAM,WTMASS
};

/// Finds the elements of each rotor: those with two or more grids that are all on it, and masses. An element with one
/// grid (a spring to ground) and one without mass between a rotor and other grids is a bearing.
/// Reports modal.rotor-element for an element with mass that joins a rotor to other grids, or whose rotary inertia has
/// no gyroscopic matrix; modal.rotor-asymmetric (warning) for unequal inertia or stiffness across the axis.
std::vector<Rotor> find_rotors(const Model& model, const std::vector<RotorAxis>& axes, Diagnostics& diagnostics);

/// Factors of the damping of a rotor, B_R = B_e + α1 M + α2 K + viscous_ge K4 + viscous_g K.
struct RotorDamping {
  double alpha1 = 0, alpha2 = 0;
  double g = 0;           ///< structural damping of all elements, in addition to GE
  double viscous_g = 0;   ///< [T] g / ω of the viscous equivalent; 0: none
  double viscous_ge = 0;  ///< [T] 1 / ω of that of GE; 0: none
};

using SparseColumns = Eigen::SparseMatrix<double>;

/// num_gdofs x num_gdofs, basic axes, of one rotor. With ẽ the cross product with the axis at each grid, translations
/// and rotations, the motion in the rotating frame changes by u̇ - Ω ẽ u.
struct RotorMatrices {
  SparseColumns gyroscopic;  ///< G: Ω G is part of B; of the whole model in the rotating frame
  /// Ω² times it is part of K, symmetric: convection of momentum of a spatial rotor in the fixed frame, centrifugal
  /// softening of the whole model in the rotating one. Without the geometric stiffness of the centrifugal stress.
  SparseColumns centrifugal;
  SparseColumns damping;  ///< α1 M + α2 K and viscous equivalents: part of B, without the dampers B_e, which B has
  SparseColumns circulation;  ///< -B_R ẽ: times Ω part of K
  SparseColumns structural;   ///< H = g K + K4: its imaginary part at frequency ω if it has no viscous equivalent
  SparseColumns structural_circulation;  ///< -H ẽ: times Ω/ω part of K if it has no viscous equivalent
};
/// Assembles the matrices of a rotor. O(elements of the rotor; of the model in the rotating frame).
RotorMatrices assemble_rotor(const Model& model, const Rotor& rotor, const RotorDamping& damping);
/// Centrifugal load of a spatial rotor [num_gdofs] at unit spin, with its stiffness from loads on arms.
struct CentrifugalLoad {
  VectorXd F;
  SparseColumns stiffness;
};
/// -∫ N^T ρ ẽẽ r dV by the mass samples of the elements.
CentrifugalLoad calc_centrifugal_load(const Model& model, const Rotor& rotor);
/// Σ (g + GE) K_e of the elements of a rotor: its part of the structural damping of the model.
SparseColumns assemble_rotor_structural(const Model& model, const Rotor& rotor, double g);

}  // namespace bough::fe
