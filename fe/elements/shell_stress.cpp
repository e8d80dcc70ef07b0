#include "fe/sections/shell_stress.hpp"

#include "fe/elements/curved_shell_operators.hpp"
#include "fe/elements/shell.hpp"
#include "fe/elements/temperature.hpp"

namespace bough::fe {
namespace {

/// Mean [N; M] over the points, whose shares of the area are `share`.
MatrixXd calc_mean_resultants(const Eigen::Ref<const MatrixXd>& forces, const std::vector<double>& share) {
  MatrixXd mean = MatrixXd::Zero(6, forces.cols());
  for (std::size_t q = 0; q < share.size(); ++q)
    mean += share[q] * forces.middleRows<6>(Shell::kNumForces * static_cast<Eigen::Index>(q));
  return mean;
}

}  // namespace

std::vector<StressPoint> Shell::stress_points() const { return list_stress_points(section_); }

MatrixXd Shell::calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const {
  if (!section_.stress) return MatrixXd(0, forces.cols());
  std::vector<double> share;
  if (num_nodes_ == 4)
    for (const auto& p : shell::calc_points<4>(get_corners<4>())) share.push_back(p.weight / area_);
  else
    for (const auto& p : shell::calc_points<3>(get_corners<3>())) share.push_back(p.weight / area_);
  return calc_stress_map(section_) * calc_mean_resultants(forces, share);
}

VectorXd Shell::calc_initial_stresses(const ElementTemperature& given) const {
  if (!section_.expansion) return {};
  const ElementTemperature T = given.calc_change(section_.expansion->tref);
  return calc_ply_expansion(section_, T.node.head(num_nodes_).mean(), T.gradient_z);
}

std::vector<StressPoint> CurvedShell::stress_points() const { return list_stress_points(sections_.front()); }

MatrixXd CurvedShell::calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const {
  if (!sections_.front().stress) return MatrixXd(0, forces.cols());
  // The thickness and the direction of the material may change from point to point.
  MatrixXd stress;
  const double area = calc_area();
  for (int q = 0; q < num_points(); ++q) {
    const auto& point = tying_->points[static_cast<std::size_t>(q)];
    const Surface f = calc_surface(point.sample);
    const double share = point.weight * Vector3d(f.x.col(0)).cross(Vector3d(f.x.col(1))).norm() / area;
    const MatrixXd part =
        share * (calc_stress_map(calc_section(q)) * forces.middleRows<6>(kNumForces * static_cast<Eigen::Index>(q)));
    if (q == 0)
      stress = part;
    else
      stress += part;
  }
  return stress;
}

VectorXd CurvedShell::calc_initial_stresses(const ElementTemperature& given) const {
  if (!sections_.front().expansion) return {};
  const ElementTemperature T = given.calc_change(sections_.front().expansion->tref);
  return calc_ply_expansion(calc_section(0), T.node.head(tying_->num_corners).mean(), T.gradient_z);
}

}  // namespace bough::fe
