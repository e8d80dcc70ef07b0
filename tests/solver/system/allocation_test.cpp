// No heap allocation in an evaluation: every call of malloc in this program is counted.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/solver/support/malloc_count.hpp"
#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

TEST(Allocation, NoneInAnEvaluation) {
  if (get_malloc_count() < 0) GTEST_SKIP() << "malloc cannot be counted in this build";
  RandomTreeOptions options;
  options.num_bodies = 16;
  RandomTree tree = make_random_tree(3, options);
  records::BodyRecord large;  // enough modes for blocked factorizations
  large.name = "large";
  large.file = "large.h5";
  tree.spec.bodies.push_back(large);
  tree.flex["large.h5"] = make_point_body(48, 9, 0.01).make_record("large");
  auto hinge = make_hinge_record("last", records::HingeType::Universal, "b2", "large");
  hinge.parent_node = 102;
  hinge.child_node = 103;
  tree.spec.hinges.push_back(hinge);
  const System system = build(tree.spec, tree.flex);
  VectorXd q, u;
  make_random_state(system, 5, q, u);
  q.segment(system.eta_offset(system.find_body("large")), 48) *= 0.1;
  VectorXd q_dot(q.size()), u_dot(u.size());
  auto data = system.make_data();
  double sum = 0;
  const long before = get_malloc_count();
  for (int k = 0; k < 100; ++k) {
    const double t = 0.01 * k;
    calc_q_dot(system, *data, t, q, u, q_dot);
    calc_kinematics(system, *data, t, q, u);
    add_forces(system, *data, t);
    add_node_wrench(system, *data, 0, 1, Vector3d(1, 2, 3), Vector3d(4, 5, 6));
    calc_accelerations(system, *data, t, u_dot);
    sum += calc_node_motion(system, *data, 0, 1).a_WK.norm() + calc_energies(system, *data).kinetic;
    sum += calc_power(system, *data);
  }
  const long after = get_malloc_count();
  EXPECT_EQ(after - before, 0);
  EXPECT_TRUE(std::isfinite(sum));
  const VectorXd proof = u_dot * 2;  // the counter does count
  EXPECT_GT(get_malloc_count(), after) << proof.size();
}

}  // namespace
}  // namespace bough::solver::testing
