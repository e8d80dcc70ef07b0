// No heap allocation in an evaluation: every call of malloc in this program is counted (glibc, no sanitizer).
#include <atomic>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/solver/support/models.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define BOUGH_COUNTS_MALLOC
extern "C" void* __libc_malloc(size_t size);

namespace {
std::atomic<long> num_mallocs{0};
}

extern "C" void* malloc(size_t size) {
  num_mallocs.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
#endif

namespace bough::solver::testing {
namespace {

TEST(Allocation, NoneInAnEvaluation) {
#ifndef BOUGH_COUNTS_MALLOC
  GTEST_SKIP() << "malloc cannot be counted in this build";
#else
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
  const long before = num_mallocs;
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
  const long after = num_mallocs;
  EXPECT_EQ(after - before, 0);
  EXPECT_TRUE(std::isfinite(sum));
  const VectorXd proof = u_dot * 2;  // the counter does count
  EXPECT_GT(num_mallocs, after) << proof.size();
#endif
}

}  // namespace
}  // namespace bough::solver::testing
