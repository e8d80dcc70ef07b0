#pragma once
/// \file A body of point masses whose every number follows by a plain sum: no code of the product is asked.
#include <random>

#include "formats/records/flex_body.hpp"

namespace bough::test {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct PointMass {
  double m;
  Vector3d p;
  MatrixXd phi;  ///< 3 x n
};

/// Mass, integrals and nodes 1, 2, ... of the points; geometric stiffness random and symmetric, so that every block has
/// something to carry. Node 1 is an interface node; `moments` gives it locators along its rotations too.
inline records::FlexBody make_body(const std::vector<PointMass>& points, unsigned seed = 1, bool moments = false) {
  std::mt19937 engine(seed);
  const auto random = [&] { return std::uniform_real_distribution<double>(-1, 1)(engine); };
  const auto n = points.front().phi.cols();
  const auto symmetric = [&] {
    const MatrixXd a = MatrixXd::NullaryExpr(n, n, random);
    return MatrixXd(a + a.transpose());
  };
  records::FlexBody b;
  b.name = "points";
  b.integrals_method = "exact";
  b.exact.gamma0 = b.exact.gamma1 = MatrixXd::Zero(3, n);
  b.exact.gamma2.assign(n, MatrixXd::Zero(3, n));
  b.exact.gamma3.assign(n, Matrix3d::Zero());
  b.exact.gamma4.assign(n, std::vector<Matrix3d>(n, Matrix3d::Zero()));
  b.modal_mass = MatrixXd::Zero(n, n);
  b.node_xyz.resize(static_cast<Eigen::Index>(points.size()), 3);
  const Matrix3d one = Matrix3d::Identity();
  for (const auto& [m, p, phi] : points) {
    b.mass += m;
    b.cg += m * p;
    b.inertia += m * (p.squaredNorm() * one - p * p.transpose());
    b.modal_mass += m * phi.transpose() * phi;
    for (Eigen::Index j = 0; j < n; ++j) {
      const Vector3d f = phi.col(j);
      b.exact.gamma0.col(j) += m * f;
      b.exact.gamma1.col(j) += m * p.cross(f);
      b.exact.gamma3[j] += m * (p.dot(f) * one - f * p.transpose());
      for (Eigen::Index k = 0; k < n; ++k) {
        const Vector3d g = phi.col(k);
        b.exact.gamma2[j].col(k) += m * f.cross(g);
        b.exact.gamma4[j][k] += m * (f.dot(g) * one - f * g.transpose());
      }
    }
    b.node_id.push_back(static_cast<int>(b.node_id.size()) + 1);
    b.node_xyz.row(static_cast<Eigen::Index>(b.node_id.size()) - 1) = p.transpose();
    MatrixXd all(6, n);
    all << phi, MatrixXd::NullaryExpr(3, n, random);
    b.phi.push_back(all);
  }
  b.cg /= b.mass;
  b.eigenvalue = VectorXd::LinSpaced(n, 4, 4 + 5.0 * static_cast<double>(n - 1));
  b.frequency_hz = b.eigenvalue.cwiseSqrt() / 6.283185307179586;
  b.kind.assign(n, records::ModeKind::Normal);
  b.modal_stiffness = b.eigenvalue.asDiagonal();
  b.modal_damping = 0.1 * symmetric();
  for (auto& G : b.kg_inertial) G = symmetric();
  b.kg_inertial_computed.fill(true);
  b.interface_nodes = {1};
  for (int d = 1; d <= (moments ? 6 : 3); ++d) {
    b.locators.push_back({"node1_" + std::to_string(d), 1, d});
    b.kg_external.push_back(symmetric());
  }
  return b;
}

/// Points at random places with random shapes.
inline std::vector<PointMass> make_points(int count, int num_modes, unsigned seed) {
  std::mt19937 engine(seed);
  const auto random = [&] { return std::uniform_real_distribution<double>(-1, 1)(engine); };
  std::vector<PointMass> points;
  for (int k = 0; k < count; ++k)
    points.push_back({1.5 + random(), Vector3d::NullaryExpr(random), MatrixXd::NullaryExpr(3, num_modes, random)});
  return points;
}

}  // namespace bough::test
