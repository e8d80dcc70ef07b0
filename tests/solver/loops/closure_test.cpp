// ConstraintState hinges: the coordinates found are those of the pose, W is what the hinge does not do.
#include <gtest/gtest.h>

#include "solver/loops/closure.hpp"
#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

TEST(Closure, FindsTheHingeInItsOwnPose) {
  std::vector<records::HingeRecord> hinges;
  for (const HingeType type : kAllHinges) {
    if (type != HingeType::Free) hinges.push_back(make_hinge_record("h", type, "ground", "b"));
  }
  hinges.push_back(make_hinge_record("h", HingeType::Screw, "ground", "b"));
  for (const std::string rotations : {"xy", "zxz", "q"}) {
    hinges.push_back(make_hinge_record("h", HingeType::General, "ground", "b"));
    hinges.back().rotations = rotations;
    hinges.back().translations = rotations == "q" ? "x" : "xz";
  }
  Random random(8);
  for (auto& record : hinges) {
    for (int trial = 0; trial < 5; ++trial) {
      record.axis = random.vector();
      record.axis2 = random.vector();
      record.pitch = 0.4;
      Diagnostics diagnostics;
      const auto hinge = make_hinge(record, diagnostics);
      const auto closure = make_hinge_closure(make_hinge(record, diagnostics));
      VectorXd q = random.vector_n(hinge->num_q(), 1.2), found(hinge->num_q());
      if (!hinge->has_independent_coordinates()) q.head<4>().normalize();
      HingeMotion X;
      hinge->calc_position(q.data(), X);
      hinge->set_neutral(found.data());
      closure->find_start(X.R_HpHc, X.p_HpHc, found.data());
      ClosureMotion m;
      closure->calc_position(X.R_HpHc, X.p_HpHc, found.data(), m);
      const int rows = closure->num_rows();
      ASSERT_EQ(rows, 6 - hinge->num_u());
      EXPECT_LT(m.gap.norm(), 1e-12) << static_cast<int>(record.type) << record.rotations;
      EXPECT_LT((m.hinge.R_HpHc - X.R_HpHc).norm() + (m.hinge.p_HpHc - X.p_HpHc).norm(), 1e-12);
      const MatrixXd W = m.W.leftCols(rows);
      EXPECT_LT((W.transpose() * W - MatrixXd::Identity(rows, rows)).norm(), 1e-14);
      EXPECT_LT((W.transpose() * m.hinge.H.leftCols(hinge->num_u())).norm(), 1e-14);
      // Whatever the hinge does satisfies velocity and acceleration.
      const VectorXd u = random.vector_n(hinge->num_u()), u_dot = random.vector_n(hinge->num_u());
      HingeMotion moving = m.hinge;
      hinge->calc_bias(u.data(), moving);
      const Vector6d V = m.hinge.H.leftCols(u.size()) * u;
      const Vector6d A = m.hinge.H.leftCols(u.size()) * u_dot + moving.bias;
      closure->calc_velocity(X.R_HpHc, X.p_HpHc, V, found.data(), m);
      EXPECT_LT((W.transpose() * A - m.bias.head(rows)).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace bough::solver::testing
