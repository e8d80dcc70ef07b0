#include "fe/elements/beam.hpp"
#include "fe/sections/stress.hpp"

namespace bough::fe {
namespace {

/// Stress at (y, z) per [N My Mz] about the shear centre: N/A + a (y - n_y) + b (z - n_z), where a and b come from
/// [I1 I12; I12 I2] [a; b] = [-(Mz + n_y N); My - n_z N] (docs/elements/beam.md). Bending without its stiffness has no
/// stress.
Eigen::RowVector3d calc_row(const BeamSection& s, const Eigen::Vector2d& point) {
  Eigen::Matrix<double, 2, 3> moment;  // right side per [N My Mz]
  moment << -s.n.x(), 0, -1, -s.n.y(), 1, 0;
  Eigen::Matrix<double, 2, 3> slope = Eigen::Matrix<double, 2, 3>::Zero();
  if (s.I12 != 0) {
    Eigen::Matrix2d I;
    I << s.I1, s.I12, s.I12, s.I2;
    slope = I.inverse() * moment;
  } else {
    if (s.I1 > 0) slope.row(0) = moment.row(0) / s.I1;
    if (s.I2 > 0) slope.row(1) = moment.row(1) / s.I2;
  }
  Eigen::RowVector3d row = (point - s.n).transpose() * slope;
  if (s.A > 0) row[0] += 1 / s.A;
  return row;
}

/// The points of an end; without any its axis.
const std::vector<Eigen::Vector2d>& get_points(const std::vector<Eigen::Vector2d>& given) {
  static const std::vector<Eigen::Vector2d> axis{Eigen::Vector2d::Zero()};
  return given.empty() ? axis : given;
}

}  // namespace

std::vector<StressPoint> Beam::stress_points() const {
  std::vector<StressPoint> points;
  for (const auto& [end, at] : {std::pair{"_a", &property_->points_a}, std::pair{"_b", &property_->points_b}}) {
    const std::size_t count = at->empty() ? 1 : at->size();
    for (std::size_t i = 0; i < count; ++i) {
      points.emplace_back().kind = StressKind::Axial;
      points.back().name = (at->empty() ? std::string("axis") : std::string(1, static_cast<char>('C' + i))) + end;
    }
  }
  return points;
}

MatrixXd Beam::calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const {
  const auto &a = get_points(property_->points_a), &b = get_points(property_->points_b);
  MatrixXd stress(static_cast<Eigen::Index>(a.size() + b.size()), forces.cols());
  Eigen::Index row = 0;
  for (int end = 0; end < 2; ++end) {
    const BeamSection section = property_->calc_section(end);
    for (const auto& point : end == 0 ? a : b) {
      const Eigen::RowVector3d per = calc_row(section, point);
      stress.row(row++) = per[0] * forces.row(0) + per[1] * forces.row(4 + 2 * end) + per[2] * forces.row(5 + 2 * end);
    }
  }
  return stress;
}

MatrixXd Beam::calc_strains(const Eigen::Ref<const MatrixXd>& forces) const {
  return calc_stresses(forces) / property_->material.E;
}

/// α (T + (y - n_y) dT/dy + (z - n_z) dT/dz), as beam_thermal.cpp.
VectorXd Beam::calc_thermal_strains(const ElementTemperature& T) const {
  const auto &a = get_points(property_->points_a), &b = get_points(property_->points_b);
  VectorXd strain(static_cast<Eigen::Index>(a.size() + b.size()));
  Eigen::Index row = 0;
  for (int end = 0; end < 2; ++end) {
    const Eigen::Vector2d n = property_->calc_section(end).n;
    for (const auto& point : end == 0 ? a : b)
      strain[row++] = T.node[end] + (point - n).dot(end == 0 ? T.gradient_a : T.gradient_b);
  }
  return property_->material.alpha * strain;
}

}  // namespace bough::fe
