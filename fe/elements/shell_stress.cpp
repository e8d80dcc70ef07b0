#include "fe/sections/shell_stress.hpp"

#include "fe/elements/curved_shell_operators.hpp"
#include "fe/elements/shell.hpp"

namespace bough::fe {
namespace {

/// Mean [N; M; Q] over the points, whose shares of the area are `share`.
MatrixXd calc_mean_resultants(const Eigen::Ref<const MatrixXd>& forces, const std::vector<double>& share) {
  MatrixXd mean = MatrixXd::Zero(Shell::kNumForces, forces.cols());
  for (std::size_t q = 0; q < share.size(); ++q)
    mean += share[q] * forces.middleRows<Shell::kNumForces>(Shell::kNumForces * static_cast<Eigen::Index>(q));
  return mean;
}

}  // namespace

std::vector<StressPoint> Shell::stress_points() const { return list_stress_points(section_); }

std::vector<double> Shell::calc_shares() const {
  std::vector<double> share;
  if (num_nodes_ == 4)
    for (const auto& p : shell::calc_points<4>(get_corners<4>())) share.push_back(p.weight / area_);
  else
    for (const auto& p : shell::calc_points<3>(get_corners<3>())) share.push_back(p.weight / area_);
  return share;
}

double Shell::calc_mean(const Eigen::Ref<const VectorXd>& corner) const {
  double sum = 0;
  if (num_nodes_ == 4)
    for (const auto& p : shell::calc_points<4>(get_corners<4>())) sum += p.weight * p.shape.dot(corner.head<4>());
  else
    for (const auto& p : shell::calc_points<3>(get_corners<3>())) sum += p.weight * p.shape.dot(corner.head<3>());
  return sum / area_;
}

MatrixXd Shell::calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const {
  return calc_stress_map(section_) * calc_mean_resultants(forces, calc_shares());
}

MatrixXd Shell::calc_corner_stresses(const Eigen::Ref<const VectorXd>& force) const {
  MatrixXd shapes(num_points(), num_nodes_);  // a row per point
  Eigen::Index q = 0;
  if (num_nodes_ == 4)
    for (const auto& p : shell::calc_points<4>(get_corners<4>())) shapes.row(q++) = p.shape.transpose();
  else
    for (const auto& p : shell::calc_points<3>(get_corners<3>())) shapes.row(q++) = p.shape.transpose();
  const Eigen::Map<const MatrixXd> at_points(force.data(), kNumForces, num_points());
  return calc_stress_map(section_) * at_points * shapes.inverse().transpose();
}

std::vector<StressPoint> Shell::strain_points() const { return list_strain_points(section_); }

MatrixXd Shell::calc_strains(const Eigen::Ref<const MatrixXd>& forces) const {
  return calc_strain_map(section_) * calc_mean_resultants(forces, calc_shares()).topRows<6>();
}

std::vector<StressPoint> CurvedShell::stress_points() const { return list_stress_points(sections_.front()); }

template <class Of>
MatrixXd CurvedShell::sum_over_points(const Of& of) const {
  MatrixXd sum;
  const double area = calc_area();
  for (int q = 0; q < num_points(); ++q) {
    const auto& point = tying_->points[static_cast<std::size_t>(q)];
    const Surface f = calc_surface(point.sample);
    const double share = point.weight * Vector3d(f.x.col(0)).cross(Vector3d(f.x.col(1))).norm() / area;
    const MatrixXd part = share * of(q);
    if (q == 0)
      sum = part;
    else
      sum += part;
  }
  return sum;
}

MatrixXd CurvedShell::calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const {
  // The thickness and the direction of the material may change from point to point.
  return sum_over_points([&](int q) -> MatrixXd {
    return calc_stress_map(calc_section(q)) * forces.middleRows<kNumForces>(kNumForces * static_cast<Eigen::Index>(q));
  });
}

VectorXd CurvedShell::calc_nodal_temperatures(const ElementTemperature& T) const {
  const int n = num_full(), corners = tying_->num_corners;
  VectorXd nodal(n);
  for (int i = 0; i < n; ++i) {
    const int at = place_[static_cast<std::size_t>(i)];
    nodal[i] = at >= 0 ? T.node[at] : 0.5 * (T.node[i - corners] + T.node[(i - corners + 1) % corners]);
  }
  return nodal;
}

double CurvedShell::calc_temperature(const VectorXd& nodal, int point) const {
  const auto& at = tying_->samples[static_cast<std::size_t>(tying_->points[static_cast<std::size_t>(point)].sample)];
  return at.shape.head(num_full()).dot(nodal);
}

std::vector<StressPoint> CurvedShell::strain_points() const { return list_strain_points(sections_.front()); }

MatrixXd CurvedShell::calc_strains(const Eigen::Ref<const MatrixXd>& forces) const {
  return sum_over_points([&](int q) -> MatrixXd {
    return calc_strain_map(calc_section(q)) * forces.middleRows<6>(kNumForces * static_cast<Eigen::Index>(q));
  });
}

void CurvedShell::set_thermal_strains(const VectorXd& nodal, double gradient_z, ThermalState& state) const {
  const auto& stress = sections_.front().stress;
  if (!stress) return;
  if (!stress->layers.empty())
    state.stress = sum_over_points(
        [&](int q) -> MatrixXd { return calc_ply_expansion(calc_section(q), calc_temperature(nodal, q), gradient_z); });
  state.strain = sum_over_points([&](int q) -> MatrixXd {
    return calc_section_expansion(calc_section(q), calc_temperature(nodal, q), gradient_z);
  });
}

}  // namespace bough::fe
