#pragma once
/// \file Drag and pressure of sunlight on the faces of a flexible body's mesh.
///
/// A face is the triangle or quadrilateral of its corners at p + φ η, first order in η: its vector area is half the
/// cross product of two edges or of the diagonals, its force acts in equal shares on its corners. No face shades
/// another; bodies that are named do (shading.hpp).
#include "solver/forces/drag.hpp"
#include "solver/forces/sunlight.hpp"

namespace bough::solver {

/// Faces of one body. Grids are numbered by their rows.
struct MeshFaces {
  struct Face {
    std::array<int, 4> corner{};
    int count = 3;
  };
  int body = -1;       ///< tree index
  Eigen::Matrix3Xd p;  ///< g; undeformed, from Bo, in B
  MatrixXd shapes;     ///< 3g x n: translations
  std::vector<Face> faces;
};

/// Place, motion and vector area of a face, in W.
struct FaceMotion {
  Place place;                          ///< of its centroid
  Vector3d v = Vector3d::Zero();        ///< of its centroid
  Vector3d area = Vector3d::Zero();     ///< L²; along its normal
  Eigen::Matrix<double, 3, 4> corners;  ///< from the centroid; the first `count` columns
  int count = 0;
};

class FaceElement : public ForceElement {
 public:
  /// \param mesh  faces on which the force acts.
  FaceElement(std::string name, MeshFaces mesh) : ForceElement(std::move(name)), mesh_(std::move(mesh)) {}
  std::vector<ForceChannel> channels() const override;

 protected:
  /// Sums the forces that `calc_force` gives the faces, in W; `seen` is the area that it adds up.
  template <class CalcForce>
  ForceResult calc_sum(const Tree& tree, const TreeData& data, Loads* loads, const CalcForce& calc_force) const;
  const MeshFaces& mesh() const { return mesh_; }

 private:
  FaceMotion calc_face(const Tree& tree, const TreeData& data, const MeshFaces::Face& face) const;
  MeshFaces mesh_;
};

/// Each face is a plate: F = -½ ρ C_d |A·v| v, v through the air; one-sided: of faces whose normal points along v.
class DragOnFaces final : public FaceElement {
 public:
  /// \param air  drag of the unit area; its normal is not read.
  DragOnFaces(std::string name, MeshFaces mesh, DragElement::Law air, bool is_one_sided)
      : FaceElement(std::move(name), std::move(mesh)), law_(std::move(air)), is_one_sided_(is_one_sided) {}
  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override;
  ValidityWarning check_validity(const Tree& tree, const TreeData& data) const override;

 private:
  DragElement::Law law_;
  bool is_one_sided_;
};

/// Each face is a panel (sunlight.hpp); the shadow of the planet is that on the origin of the body.
class SunOnFaces final : public FaceElement {
 public:
  /// \param panel  of the unit area; its normal is not read.
  SunOnFaces(std::string name, MeshFaces mesh, const SolarPressure::Panel& panel)
      : FaceElement(std::move(name), std::move(mesh)), panel_(panel) {}
  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override;
  int num_kinks() const override { return panel_.shadow.radius > 0 ? 2 : 0; }
  void calc_kinks(const Tree& tree, const TreeData& data, double* g) const override;
  std::vector<ForceChannel> channels() const override;

 private:
  SolarPressure::Panel panel_;
};

}  // namespace bough::solver
