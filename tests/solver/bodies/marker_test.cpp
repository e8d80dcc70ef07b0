#include "solver/bodies/marker.hpp"

#include <gtest/gtest.h>

#include "tests/solver/bodies/marker_rates.hpp"

namespace bough::solver::testing {
namespace {

TEST(Marker, MotionIsTheRateOfItsPlaceAndOfItsAxes) {
  const int n = 3;
  Random random(21);
  const Body body = Body::make_flexible(make_point_body(n, 5).make_record("p"), -1, true, {});
  Marker marker{0, body.find_node(103), random.vector(), random.rotation(), true};
  const VectorXd eta = random.vector_n(n, 0.3), eta_dot = random.vector_n(n), eta_ddot = random.vector_n(n);
  const MarkerMotion m = expect_marker_rates(body, marker, eta, eta_dot, eta_ddot, 1e-7);
  EXPECT_LT((m.J.topRows<3>() * eta_dot - m.v).norm(), 1e-14);
  EXPECT_LT((m.J.bottomRows<3>() * eta_dot - m.w).norm(), 1e-14);
}

// Load stiffening acts through the marker: the Jacobian of an offset load is that of its node's wrench.
TEST(Marker, WrenchAtAnOffsetIsTheWrenchAtItsNode) {
  const int n = 3;
  Random random(22);
  const Body body = Body::make_flexible(make_point_body(n, 6).make_record("p"), -1, true, {});
  const VectorXd eta = random.vector_n(n, 0.3);
  const Marker offset{0, body.find_node(102), random.vector(), random.rotation(), true};
  MarkerMotion m = make_marker_motion(body, offset);
  calc_marker_position(body, offset, eta, m);
  const Vector3d f = random.vector(), t = random.vector();
  Vector6d wrench;
  wrench << f, t;
  NodeInBody k;
  const Node& node = body.nodes()[static_cast<size_t>(offset.node)];
  calc_node_in_body(node, eta, eta, k);
  VectorXd Q = VectorXd::Zero(n);
  add_node_generalized_force(node, eta, k.T, f, t + m.o.cross(f), Q);
  EXPECT_LT((m.J.transpose() * wrench - Q).norm(), 1e-14 * (1 + Q.norm()));
}

}  // namespace
}  // namespace bough::solver::testing
