#pragma once
/// \file Nastran coordinate systems (CORD1R/C/S, CORD2R/C/S) and grid positions, resolved to basic.
///
/// Basic here is moved to the body origin: a point of the deck's basic system becomes x - origin.
#include <map>
#include <string>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::fe {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct CoordinateSystem {
  records::CoordKind kind = records::CoordKind::Rectangular;
  Vector3d origin = Vector3d::Zero();       ///< in basic
  Matrix3d R_basic = Matrix3d::Identity();  ///< columns: its rectangular axes in basic
  bool is_resolved = true;                  ///< false: an error of it was reported, it stands for basic
};

class CoordinateSystems {
 public:
  /// Resolves every system and grid position of the deck in the order of dependence. Reports
  /// fe.missing-coordinates, fe.cyclic-coordinates, fe.degenerate-coordinates and fe.missing-grid (of CORD1x).
  CoordinateSystems(const records::Deck& deck, const Vector3d& origin, Diagnostics& diagnostics);

  /// nullptr when there is none; cid 0 is basic.
  const CoordinateSystem* find(int cid) const;
  /// Position in basic of grid `index` of Deck::grids.
  const Vector3d& get_grid_position(int index) const { return grid_positions_[index]; }

  /// Position in basic; cylindrical x is (r, θ, z), spherical (r, θ, φ) with θ from z; angles in degrees.
  Vector3d calc_point(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const;
  /// R_basic_cid at x: the radial, tangential and third axes of a curvilinear system as columns; on its z axis those of
  /// θ = 0 (φ = 0). A missing system is reported, the result is then the identity.
  Matrix3d calc_axes(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const;

 private:
  std::map<int, CoordinateSystem> systems_;
  std::vector<Vector3d> grid_positions_;
};

}  // namespace bough::fe
