#pragma once
/// \file The weight table of Nastran's grid point weight generator.
#include "fe/model/model.hpp"

namespace bough::fe {

/// Grid point weight as Nastran prints it (MSC Nastran Reference Guide, Grid Point Weight Generator): before
/// PARAM,WTMASS, so weights where that turns weight into mass.
struct GridPointWeight {
  int grid = 0;                           ///< of the reference point; 0: the origin of basic
  Vector3d reference = Vector3d::Zero();  ///< in basic
  Eigen::Matrix<double, 6, 6> MO;         ///< rigid mass matrix about the reference, basic axes
  Matrix3d S = Matrix3d::Identity();      ///< columns: the principal axes of the translational mass, in basic
  Vector3d mass = Vector3d::Zero();       ///< along the axes S; they differ where masses act in some directions only
  Matrix3d cg = Matrix3d::Zero();         ///< row i: centre (x, y, z) of mass i from the reference, axes S
  Matrix3d I_S = Matrix3d::Zero();        ///< about the centres, axes S; off the diagonal +∫xy dm as printed
  Vector3d I_Q = Vector3d::Zero();        ///< principal inertias
  Matrix3d Q = Matrix3d::Identity();      ///< columns: their axes, in axes S
};

/// About grid `grid` (0: the origin of basic). Throws InputError("fe.missing-grid").
GridPointWeight calc_grid_point_weight(const Model& model, int grid);
/// Grid point weight from a rigid mass matrix (x y z, rotations about x y z) about the reference.
GridPointWeight calc_grid_point_weight(const Eigen::Matrix<double, 6, 6>& MO);

}  // namespace bough::fe
