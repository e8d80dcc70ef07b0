#include "bough/fe/shape/face_load.hpp"

#include "bough/base/diagnostic.hpp"
#include "bough/fe/shape/gauss.hpp"
#include "bough/fe/shape/surface_shape.hpp"

namespace bough::fe {

Eigen::Matrix3Xd calc_face_load(const std::vector<Eigen::Vector3d>& corners,
                                const std::vector<Eigen::Vector3d>& midside, const std::vector<char>& has_midside,
                                const std::vector<double>& p, const Traction& traction) {
  const int n = static_cast<int>(corners.size());
  BOUGH_DEMAND((n == 3 || n == 4) && p.size() == corners.size() && midside.size() == has_midside.size());
  std::vector<Eigen::Vector3d> x = corners;
  for (std::size_t k = 0; k < midside.size(); ++k)
    if (has_midside[k]) x.push_back(midside[k]);
  Eigen::Matrix3Xd F = Eigen::Matrix3Xd::Zero(3, static_cast<int>(x.size()));
  // The integrand of a serendipity face is of degree 8 in a direction: five points are exact.
  const auto points = get_gauss_points(x.size() == corners.size() ? 3 : 5);
  for (const auto& a : points)
    for (const auto& b : points) {
      // The triangle is the square with one side drawn to a point.
      const double r = n == 4 ? 2 * a.x - 1 : a.x, s = n == 4 ? 2 * b.x - 1 : b.x * (1 - a.x);
      const double weight = a.weight * b.weight * (n == 4 ? 4 : 1 - a.x);
      const SurfaceShapes shapes = calc_surface_shapes(n, has_midside, r, s);
      Eigen::Vector3d at = Eigen::Vector3d::Zero(), dr = at, ds = at;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto c = static_cast<Eigen::Index>(i);
        at += shapes.all[c] * x[i];
        dr += shapes.dall(0, c) * x[i];
        ds += shapes.dall(1, c) * x[i];
      }
      double intensity = 0;
      for (int k = 0; k < n; ++k) intensity += shapes.corner[k] * p[static_cast<std::size_t>(k)];
      const Eigen::Vector3d area = dr.cross(ds);
      const double size = area.norm();
      if (size == 0) continue;
      const Eigen::Vector3d t = weight * size * traction(intensity, at, area / size);
      F += t * shapes.all.transpose();
    }
  return F;
}

}  // namespace bough::fe
