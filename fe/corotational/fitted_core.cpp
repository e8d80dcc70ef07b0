#include "fe/corotational/fitted_core.hpp"

namespace bough::fe {

using Eigen::Index;

FittedCore::FittedCore(const Connector& connector) : core_(connector.core(), list_ends(connector)) {
  BOUGH_DEMAND(core_.follows_nodes());
  for (std::size_t k = 0; k < 2; ++k) {
    const ConnectorEnd& end = connector.data().ends[k];
    ends_[k].shares = end.shares;
    ends_[k].arm = end.rotation.arm;
    for (Index p = 0; p < 4; ++p) ends_[k].mean.members.push_back({0, end.rotation.points.col(p), 1, 0});
  }
}

/// Nodes of the core: dofs [u_A θ_A u_B θ_B].
std::vector<Node> FittedCore::list_ends(const Connector& connector) {
  std::vector<Node> nodes(2);
  for (std::size_t k = 0; k < 2; ++k) {
    nodes[k].x = connector.data().ends[k].x;
    nodes[k].first_gdof = 6 * static_cast<int>(k);
  }
  return nodes;
}

MeanMotion FittedCore::calc_mean(const End& end, const Eigen::Ref<const VectorXd>& u) const {
  Matrix3Xd points = Matrix3Xd::Zero(3, 4);
  for (Index i = 0; i < end.shares.cols(); ++i) points += u.segment<3>(6 * i) * end.shares.col(i).transpose();
  return MeanMotion(end.mean, points, {});
}

void FittedCore::calc_finite(const Eigen::Ref<const VectorXd>& u, FiniteForces& result) const {
  const Index N = u.size();
  const MeanMotion a = calc_mean(ends_[0], u), b = calc_mean(ends_[1], u);
  const std::array<const MeanMotion*, 2> means{&a, &b};
  VectorXd u_core = VectorXd::Zero(12);
  MatrixXd A = MatrixXd::Zero(12, N);  // variation of the ends by that of the grids
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& [shares, mean, arm] = ends_[k];
    const auto first = 6 * static_cast<Index>(k);
    u_core.segment<3>(first) = means[k]->calc_displacement(arm);
    const MatrixXd tangent = means[k]->calc_tangent(arm);
    for (Index i = 0; i < shares.cols(); ++i)
      for (Index p = 0; p < 4; ++p) A.block<6, 3>(first, 6 * i) += shares(p, i) * tangent.middleCols<3>(6 * p);
  }
  const FiniteForces core = core_.calc_finite(u_core, {a.R(), b.R()});
  result.f = A.transpose() * core.f;
  result.K = A.transpose() * core.K * A;
  result.energy = core.energy;
  result.internal = core.internal;
  result.max_turn = std::max(result.max_turn, core.max_turn);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& [shares, mean, arm] = ends_[k];
    const auto first = 6 * static_cast<Index>(k);
    const MatrixXd slope = means[k]->calc_slope(arm, core.f.segment<3>(first), core.f.segment<3>(first + 3));
    for (Index i = 0; i < shares.cols(); ++i)
      for (Index j = 0; j < shares.cols(); ++j)
        for (Index p = 0; p < 4; ++p)
          for (Index q = 0; q < 4; ++q)
            result.K.block<3, 3>(6 * i, 6 * j) += shares(p, i) * shares(q, j) * slope.block<3, 3>(6 * p, 6 * q);
  }
}

MeanSeries FittedCore::calc_series(const End& end, const Eigen::Ref<const MatrixXd>& u) const {
  std::vector<MatrixXd> points(4, MatrixXd::Zero(6, u.cols()));
  for (Index i = 0; i < end.shares.cols(); ++i)
    for (Index p = 0; p < 4; ++p)
      points[static_cast<std::size_t>(p)].topRows<3>() += end.shares(p, i) * u.middleRows<3>(6 * i);
  return MeanSeries(end.mean, points);
}

/// Motion of the ends along one curve: 12 x 5.
MatrixXd FittedCore::calc_core_motion(const Eigen::Ref<const MatrixXd>& u) const {
  MatrixXd ends(12, kSeriesTop);
  ends << calc_series(ends_[0], u).calc_motion(ends_[0].arm), calc_series(ends_[1], u).calc_motion(ends_[1].arm);
  return ends;
}

MatrixXd FittedCore::calc_forces(const Eigen::Ref<const MatrixXd>& u, int top) const {
  MatrixXd forces = MatrixXd::Zero(u.rows(), u.cols());
  for (Index first = 0; first < u.cols(); first += top) {
    const auto u_c = u.middleCols(first, top);
    const MatrixXd core = core_.calc_forces(calc_core_motion(u_c));
    for (std::size_t k = 0; k < 2; ++k) {
      const End& end = ends_[k];
      const auto on_points = calc_series(end, u_c).calc_forces(end.arm, core.middleRows<6>(6 * static_cast<Index>(k)));
      for (Index i = 0; i < end.shares.cols(); ++i)
        for (Index p = 0; p < 4; ++p)
          forces.block(6 * i, first, 3, top) +=
              end.shares(p, i) * on_points[static_cast<std::size_t>(p)].topLeftCorner(3, top);
    }
  }
  return forces;
}

MatrixXd FittedCore::calc_internal(const Eigen::Ref<const MatrixXd>& u) const {
  MatrixXd ends(12, u.cols());
  for (Index first = 0; first < u.cols(); first += kSeriesTop)
    ends.middleCols<kSeriesTop>(first) = calc_core_motion(u.middleCols<kSeriesTop>(first));
  return core_.calc_local(ends).internal;
}

}  // namespace bough::fe
