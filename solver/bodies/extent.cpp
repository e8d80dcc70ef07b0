#include "solver/bodies/extent.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace bough::solver {

Vector3d calc_centre_of_mass(const Body& body) {
  if (!(body.mass() > 0)) return Vector3d::Zero();
  return Vector3d(body.M6()(1, 5), body.M6()(2, 3), body.M6()(0, 4)) / body.mass();
}

double calc_inertia_extent(const Body& body) {
  if (!(body.mass() > 0)) return 0;
  // A box of edges a, b, c has tr I = m (a² + b² + c²) / 6 about its middle.
  const double about_origin = body.M6().bottomRightCorner<3, 3>().trace();
  const double trace = about_origin - 2 * body.mass() * calc_centre_of_mass(body).squaredNorm();
  // A point far from the origin leaves roundoff.
  return trace > 1e-12 * about_origin ? std::sqrt(6 * trace / body.mass()) : 0;
}

double calc_extent(const Body& body) {
  Eigen::AlignedBox3d box;
  for (const Node& node : body.nodes())
    if (node.id != 0 && node.is_material) box.extend(node.p);
  return std::max(calc_inertia_extent(body), box.isEmpty() ? 0 : box.diagonal().norm());
}

}  // namespace bough::solver
