#pragma once
/// \file The LVLH frame of a reference orbit as a body without mass on a prescribed hinge (docs/theory/orbit.md).
#include "formats/records/system_spec.hpp"

namespace bough::records {

/// Ellipse about a centre of gravity. Perifocal axes: x to the periapsis, z along the angular momentum.
struct Ellipse {
  double semi_major_axis = 0;  ///< L
  double eccentricity = 0;
  double mean_anomaly = 0;  ///< rad, at the start
  Eigen::Matrix3d R_WP = Eigen::Matrix3d::Identity();
};

/// Ellipse through a position from the centre with a velocity. An orbit that is no ellipse has a semi_major_axis that
/// is not above zero, or an eccentricity of 1 or more.
Ellipse calc_ellipse(double mu, const Eigen::Vector3d& position, const Eigen::Vector3d& velocity);

/// Adds, for each orbit, a body of its name without mass on a planar hinge whose coordinates are prescribed by Kepler's
/// equation: z to the centre, y against the angular momentum, x along the path. Parents and references "lvlh:NAME" of
/// an orbit become that body. Reports "system.bad-orbit".
void add_orbits(SystemSpec& spec, Diagnostics& diagnostics);

}  // namespace bough::records
