#include "fe/shape/face_load.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"
#include "base/rotation.hpp"
#include "fe/shape/gauss.hpp"
#include "fe/shape/surface_shape.hpp"

namespace bough::fe {

namespace {

/// visit(weight, shapes, p, x, x,r, x,s) at the points of a quadrature of the face.
template <class Visit>
void for_each_point(const std::vector<Eigen::Vector3d>& corners, const std::vector<Eigen::Vector3d>& midside,
                    const std::vector<char>& has_midside, const std::vector<double>& p, const Visit& visit) {
  const int n = static_cast<int>(corners.size());
  BOUGH_DEMAND((n == 3 || n == 4) && p.size() == corners.size() && midside.size() == has_midside.size());
  std::vector<Eigen::Vector3d> x = corners;
  for (std::size_t k = 0; k < midside.size(); ++k)
    if (has_midside[k]) x.push_back(midside[k]);
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
      visit(weight, shapes, intensity, at, dr, ds);
    }
}

int count_nodes(const std::vector<Eigen::Vector3d>& corners, const std::vector<char>& has_midside) {
  return static_cast<int>(corners.size()) + static_cast<int>(std::count(has_midside.begin(), has_midside.end(), 1));
}

}  // namespace

Eigen::Matrix3Xd calc_face_load(const std::vector<Eigen::Vector3d>& corners,
                                const std::vector<Eigen::Vector3d>& midside, const std::vector<char>& has_midside,
                                const std::vector<double>& p, const Traction& traction) {
  Eigen::Matrix3Xd F = Eigen::Matrix3Xd::Zero(3, count_nodes(corners, has_midside));
  for_each_point(corners, midside, has_midside, p,
                 [&](double weight, const SurfaceShapes& shapes, double intensity, const Eigen::Vector3d& at,
                     const Eigen::Vector3d& dr, const Eigen::Vector3d& ds) {
                   const Eigen::Vector3d area = dr.cross(ds);
                   const double size = area.norm();
                   if (size == 0) return;
                   const Eigen::Vector3d t = weight * size * traction(intensity, at, area / size);
                   F += t * shapes.all.transpose();
                 });
  return F;
}

Eigen::MatrixXd calc_follower_stiffness(const std::vector<Eigen::Vector3d>& corners,
                                        const std::vector<Eigen::Vector3d>& midside,
                                        const std::vector<char>& has_midside, const std::vector<double>& p) {
  const int size = 3 * count_nodes(corners, has_midside);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
  for_each_point(corners, midside, has_midside, p,
                 [&](double weight, const SurfaceShapes& shapes, double intensity, const Eigen::Vector3d&,
                     const Eigen::Vector3d& dr, const Eigen::Vector3d& ds) {
                   for (int j = 0; j < shapes.all.size(); ++j) {
                     // x,r × x,s changes by N_j,r u × x,s + x,r × N_j,s u.
                     const Eigen::Matrix3d turned =
                         weight * intensity * (shapes.dall(1, j) * skew(dr) - shapes.dall(0, j) * skew(ds));
                     for (int i = 0; i < shapes.all.size(); ++i) K.block<3, 3>(3 * i, 3 * j) -= shapes.all[i] * turned;
                   }
                 });
  return K;
}

}  // namespace bough::fe
