#include "fe/elements/beam.hpp"
#include "fe/shape/gauss.hpp"

namespace bough::fe {

using Vector12d = Eigen::Matrix<double, 12, 1>;

Vector12d Beam::calc_end_load(const BeamLineLoad& load) const {
  const BeamField& field = *field_;
  const auto displace = [&](double x) {
    Matrix6x12d D;
    field.calc_shape(std::min(x, geometry_.length), &D, nullptr);
    return D;
  };
  if (load.is_point) return displace(load.x1).transpose() * load.p1;
  Vector12d f = Vector12d::Zero();
  const double span = load.x2 - load.x1;
  const auto add = [&](double from, double to) {
    for (const auto& point : get_gauss_points(field.is_uniform() ? 4 : 8)) {
      const double x = from + (to - from) * point.x, share = (x - load.x1) / span;
      f += (to - from) * point.weight * (displace(x).transpose() * ((1 - share) * load.p1 + share * load.p2));
    }
  };
  // The shapes have kinks at stations.
  double from = load.x1;
  for (const auto& station : property_->stations) {
    const double at = station.x_over_L * geometry_.length;
    if (property_->is_uniform() || at <= from || at >= load.x2) continue;
    add(from, at);
    from = at;
  }
  add(from, load.x2);
  return f;
}

Vector12d Beam::calc_grid_load(const Vector12d& end_load) const { return calc_end_map().transpose() * end_load; }

void Beam::add_load_forces(const Vector12d& end_load, Eigen::Ref<VectorXd> force) const {
  // Forces on the ends: K (v + released motion under the load) - load.
  Vector12d nodal = -end_load;
  if (const unsigned pins = geometry_.pin_a | (geometry_.pin_b << 6)) {
    const BeamField& field = *field_;
    const Matrix6x12d S = field.calc_relative();
    const Matrix12d K = S.transpose() * field.calc_stiffness() * S;
    std::vector<int> released;
    for (int i = 0; i < 12; ++i)
      if (pins >> i & 1u) released.push_back(i);
    const MatrixXd K_rr = K(released, released);
    const VectorXd v = K_rr.completeOrthogonalDecomposition().solve(VectorXd(end_load(released)));
    nodal += K(Eigen::all, released) * v;
  }
  force[0] -= nodal[0];
  force[1] -= nodal[1];
  force[2] -= nodal[2];
  force[3] -= nodal[3];
  force[4] -= nodal[4];
  force[5] -= nodal[5];
  force[6] += nodal[10];
  force[7] += nodal[11];
}

}  // namespace bough::fe
