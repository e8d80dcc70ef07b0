#pragma once
/// \file Shadow that bodies cast on flat faces: the share of a face that the sun sees past the convex hulls of others.
///
/// Face and hulls are projected along the sun. Of a hull only what lies in front of the plane of the face counts:
/// corners in front, and the points where segments between corners cross the plane. Hulls are subtracted from the face
/// one after the other, each as a convex polygon, so that shadows that overlap count once. Rays are parallel: the
/// penumbra of a near body, its distance times the size of the sun, is neglected.
#include <vector>

#include "solver/tree/data.hpp"

namespace bough::solver {

/// Body that casts a shadow: the convex hull of points that move with its frame.
struct ShadingBody {
  int body = -1;               ///< tree index
  Eigen::Matrix3Xd corners_B;  ///< from Bo
};

class Shading {
 public:
  Shading() = default;
  /// \param sun_W  direction to the sun, unit.
  Shading(std::vector<ShadingBody> bodies, const Vector3d& sun_W);
  /// Returns true if no body casts a shadow.
  bool is_empty() const { return bodies_.empty(); }

  /// Share of the projected area of a face that is lit, 0 to 1, after calc_position. No allocation for hulls of some
  /// dozens of corners.
  /// \param middle  of the face.  \param corners_W  of the convex face, in order: a column each, from the middle, in W.
  /// \param area_W  vector area of the face.
  double calc_lit_share(const TreeData& data, const Place& middle, const Eigen::Ref<const Eigen::Matrix3Xd>& corners_W,
                        const Vector3d& area_W) const;
  /// Lit share of a disc, as a polygon of its area.
  double calc_lit_share_of_disc(const TreeData& data, const Place& centre, const Vector3d& normal_W, double area) const;

 private:
  std::vector<ShadingBody> bodies_;
  Vector3d sun_W_ = Vector3d::UnitX();
  Eigen::Matrix<double, 2, 3> plane_;  ///< two unit vectors (rows) across the sun, in W
};

}  // namespace bough::solver
